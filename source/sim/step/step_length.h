// How long a step is, and how far particles move in it at most.
#pragma once

#include "sim/step/flow.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

template <bool volume, class Device> void findExtremes(Flow<Device>& flow) {
    flow.device.reduce(flow.fluid.slots(),
                       FindExtremes<volume>{flow.fluid.view(), flow.model.shared.restDensity},
                       flow.extremes.data());
}

// m/s, of any particle at the end of a step of length dt (s), stirring included.
template <class Device> double largestSpeed(const Flow<Device>& flow, double dt) {
    const Extremes& e = *flow.extremes.data();
    const double most = std::max<double>(std::sqrt(e.speed2), flow.stir.speed());
    const double own = most + dt * std::sqrt(e.acceleration2);
    return std::max(shiftsParticles(flow.scene) ? 1.5 * own : own,  // shifts are half as fast
                    flow.fastestPart());
}

template <class Device> void chooseTimeStep(Flow<Device>& flow) {
    flow.device.forEach(1, ChooseTimeStep{flow.view(), flow.extremes.data()});
    if constexpr (NeighbourSearch<Device>::keepsLists) {
        const Integrator integrator = flow.scene.time.integrator;
        const double share = integrator == Integrator::PredictorCorrector ? 0.5
                             : integrator == Integrator::Split            ? 0
                             : factsOf(flow.scene).solvesPressure         ? 0
                                                                          : 1;
        const double dt = flow.clock.data()->dt;
        flow.search.movedAtMost(share * dt * largestSpeed(flow, dt));
    }
}

// Where velocities are already those that the step ends with.
template <class Device> void boundMove(Flow<Device>& flow) {
    findExtremes<false>(flow);
    if constexpr (NeighbourSearch<Device>::keepsLists) {
        const double speed = std::sqrt(flow.extremes.data()->speed2);
        flow.search.movedAtMost(flow.clock.data()->dt * std::max(speed, flow.fastestPart()));
    }
}

// Split integration knows of the pressure only now, and has moved nothing yet.
template <class Device> void boundSplitMove(Flow<Device>& flow) {
    findExtremes<false>(flow);
    if constexpr (NeighbourSearch<Device>::keepsLists) {
        const double dt = flow.clock.data()->dt;
        flow.search.movedAtMost(dt * largestSpeed(flow, dt));
    }
}

// From the middle of the step to its end, where the middle's accelerations lead: dt/2 v + dt^2/2 a,
// and a shift that may turn round.
template <class Device> void boundCorrection(Flow<Device>& flow) {
    findExtremes<false>(flow);
    if constexpr (NeighbourSearch<Device>::keepsLists) {
        const StepState& clock = *flow.clock.data();
        const double start = std::max<double>(clock.speed, flow.stir.speed());
        const double pull = std::sqrt(flow.extremes.data()->acceleration2);
        const double own = 0.5 * (start + clock.dt * pull) +
                           (shiftsParticles(flow.scene) ? 0.75 * clock.speed : 0);
        flow.search.movedAtMost(clock.dt * std::max(own, 0.5 * flow.fastestPart()));
    }
}

}  // namespace spindrift::LANES
