// The simulation on the host's SIMD lanes: this file is compiled once per instruction set by foreach_target.h,
// and the best that the machine has is picked at start.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/simulation_simd.cpp"
#define HWY_BASELINE_TARGETS HWY_SSSE3
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Everything that is not lanes is included before the instruction set is switched on.
#include "core/error.h"
#include "device/omp.h"
#include "scene/particles.h"
#include "sim/simulation.h"
#include "sim/step_state.h"
#include "sim/make_simulation.h"

#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <type_traits>

#define SPINDRIFT_SIMD
HWY_BEFORE_NAMESPACE();
#include "sim/simulation_on.h"
namespace spindrift::HWY_NAMESPACE {

std::unique_ptr<Simulation> makeOmp(const Scene& scene, const RunState& state, int threads,
                                    const std::string& name) {
    return std::make_unique<SimulationOn<Omp>>(scene, state, Omp(threads), name);
}

}  // namespace spindrift::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spindrift {

HWY_EXPORT(makeOmp);

struct SimdTarget { Simd simd; int64_t target; const char* name; };
static constexpr SimdTarget targets[] = {{Simd::Avx512, HWY_AVX3, "AVX-512"},
                                         {Simd::Avx2, HWY_AVX2, "AVX2"},
                                         {Simd::Sse, HWY_SSSE3, "SSE"}};

std::unique_ptr<Simulation> makeSimdSimulation(const Scene& scene, const RunState& state, int threads) {
    hwy::SetSupportedTargetsForTest(0);   // forgets an earlier choice
    const int64_t machine = hwy::SupportedTargets();
    for (const SimdTarget& t : targets) {
        const bool fits = scene.compute.simd == Simd::Auto || scene.compute.simd == t.simd;
        if (!fits || !(machine & t.target)) continue;
        hwy::SetSupportedTargetsForTest(t.target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        const std::string name = cpuName(threads, std::string(t.name) + ", float");
        return HWY_DYNAMIC_DISPATCH(makeOmp)(scene, state, threads, name);
    }
    throw Error(Exit::NoDevice, "compute.simd: this processor does not have that instruction set; use auto");
}

}  // namespace spindrift
#endif
