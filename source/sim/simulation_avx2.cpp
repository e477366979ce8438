#define SPINDRIFT_TARGET HWY_AVX2
#include "sim/simulation_simd.h"

namespace spindrift {

std::unique_ptr<Simulation> makeAvx2Simulation(const Scene& scene, const RunState& state,
                                               int threads) {
    return LANES::makeSimulationOn(scene, state, threads, "AVX2");
}

}  // namespace spindrift
