#define SPINDRIFT_TARGET HWY_SSSE3
#include "sim/simulation_simd.h"

namespace spindrift {

std::unique_ptr<Simulation> makeSseSimulation(const Scene& scene, const RunState& state,
                                              int threads) {
    return LANES::makeSimulationOn(scene, state, threads, "SSE");
}

}  // namespace spindrift
