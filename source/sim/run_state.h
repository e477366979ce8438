#pragma once
// What a run carries from step to step, and what its constants were derived from: another device that starts from it
// goes on exactly.
#include "scene/particles.h"
#include "sim/step_state.h"

#include <algorithm>

namespace spindrift {

// Where the fluid was at the start, m from the domain's corner, and how fast, m/s.
struct FluidExtent { Vec3d low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30}; double speed = 0; };

inline FluidExtent extentOf(const Placement& p) {
    FluidExtent e;
    for (size_t i = 0; i < p.positions.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            e.low[k] = std::min<double>(e.low[k], p.positions[i][k]);
            e.high[k] = std::max<double>(e.high[k], p.positions[i][k]);
        }
        e.speed = std::max<double>(e.speed, length(p.velocities[i]));
    }
    return e;
}

struct RunState {
    Placement particles;   // in the order of their ids
    StepState clock;
    FluidExtent start;

    RunState() = default;
    // The beginning of a run.
    RunState(Placement p) : particles(std::move(p)), start(extentOf(particles)) {}
};

}  // namespace spindrift
