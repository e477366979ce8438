#pragma once
// For a physics engine of one's own that is to own the elastic objects: Simulation::drive hands
// them over.
//
//     class Flap final : public ObjectDriver {
//         double interval() const override { return 0.001; }
//         void exchange(double time, const std::vector<Vec3d>& forces, std::vector<Vec3d>&
//         positions,
//                       std::vector<Vec3d>& velocities) override { ... }
//     };
//     Flap flap;
//     simulation->drive(&flap);
//
// Fluid steps as it likes. Each interval the engine is told what its particles felt and says where
// they are to be an interval later. Two buffers: while one is where particles are on their way to,
// on straight lines, the other is the engine's. Bonds, grips, cuts, gravity and contact with the
// box and with solids are then the engine's own affair. examples/flap.cpp is a whole program.
#include "core/vec.h"

#include <vector>

namespace spindrift {

class ObjectDriver {
public:
    virtual ~ObjectDriver() = default;
    // Simulated time between exchanges, s; above 0. An exchange is made at the end of the step that
    // reaches its time.
    virtual double interval() const = 0;
    // `forces`: on each particle of all objects, in the order of sampleObjects()
    // (scene/sample_object.h): means since the last exchange, N, in two dimensions N/m, of contacts
    // with fluid and objects. `positions` (m, world coordinates) and `velocities` (m/s): come as
    // they are, go as they shall be at time + interval(). Sizes must stay. Called by the thread
    // that steps.
    virtual void exchange(double time, const std::vector<Vec3d>& forces,
                          std::vector<Vec3d>& positions, std::vector<Vec3d>& velocities) = 0;
};

}  // namespace spindrift
