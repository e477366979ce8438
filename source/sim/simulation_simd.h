// The simulation on the host's SIMD lanes. Included by simulation_avx512.cpp and its like, each for
// the instruction set that it calls SPINDRIFT_TARGET, and by nothing else.
#pragma once
#define HWY_BASELINE_TARGETS SPINDRIFT_TARGET
#include <hwy/highway.h>

// Everything that is not lanes is included before the instruction set is switched on.
#include "core/error.h"
#include "device/omp.h"
#include "scene/particles.h"
#include "sim/make_simulation.h"
#include "sim/step/plan.h"
#include "sim/simulation.h"
#include "sim/step_state.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <numeric>
#include <string>
#include <tuple>
#include <type_traits>

#define SPINDRIFT_SIMD
HWY_BEFORE_NAMESPACE();
#include "sim/simulation_on.h"
namespace spindrift::LANES {

std::unique_ptr<Simulation> makeSimulationOn(const Scene& scene, const RunState& state, int threads,
                                             const std::string& instructionSet) {
    return std::make_unique<SimulationOn<Omp>>(scene, state,
                                               Omp(threads, scene.compute.threads == 0),
                                               cpuName(threads, instructionSet + ", float"));
}

}  // namespace spindrift::LANES
HWY_AFTER_NAMESPACE();
