#define SPINDRIFT_TARGET HWY_AVX3
#include "sim/simulation_simd.h"

namespace spindrift {

std::unique_ptr<Simulation> makeAvx512Simulation(const Scene& scene, const RunState& state,
                                                 int threads) {
    return LANES::makeSimulationOn(scene, state, threads, "AVX-512");
}

}  // namespace spindrift
