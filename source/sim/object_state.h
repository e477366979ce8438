#pragma once
// What a run carries of elastic objects from step to step.
#include "core/vec.h"

#include <cstdint>
#include <vector>

namespace spindrift {

// Particles of all objects in the order of sampleObjects(): m from the domain's lower corner, m/s.
// Of each end of a bond whether it is broken. All empty: as at the start.
struct ObjectState {
    std::vector<Vec3> positions, velocities;
    std::vector<uint8_t> broken;
};

}  // namespace spindrift
