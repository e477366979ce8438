#include "sim/make_simulation.h"

#include "core/error.h"
#include "device/cuda_devices.h"
#include "scene/memory.h"
#include "scene/sources.h"

#include <hwy/targets.h>

#include <algorithm>
#include <new>
#include <thread>

namespace spindrift {

static int threadCount(const Scene& scene) {
    const int cores = int(std::max(1u, std::thread::hardware_concurrency()));
    return scene.compute.threads > 0 ? scene.compute.threads : cores;
}

static int deviceOf(const Scene& scene) { return std::max(scene.compute.device, 0); }

std::string whyNotForGpus(const Scene& scene) {
    if (scene.compute.precision == Precision::Double)
        return "double precision is computed on the CPU only; use float";
    if (scene.time.mode == TimeMode::Local)
        return "local steps (time.mode) are computed on the CPU only; set time.mode to cfl";
    return "";
}

std::string whyNoGpu(const Scene& scene) {
    const std::string why = whyNotForGpus(scene);
    return why.empty() ? cudaProblem(deviceOf(scene)) : why;
}

// Asked before anything is taken: a GPU's memory is not swapped, and a half-built run would be of
// no use.
static std::string whyTooLargeForGpu(const Scene& scene, ParticleCount count) {
    const double GiB = 1 << 30, needed = double(estimateGpuMemory(scene, count)),
                 free = double(cudaFreeMemory(deviceOf(scene)));
    if (needed <= free) return "";
    auto inGiB = [&](double bytes) { return std::to_string(bytes / GiB).substr(0, 5) + " GiB"; };
    return "simulation.spacing: the particles need about " + inGiB(needed) + " of GPU memory, " +
           inGiB(free) + " are free";
}

// Asked for CUDA it is CUDA or an error; `auto` takes the GPU when there is one that can do what
// the scene asks for.
static bool runsOnGpu(const Scene& scene, ParticleCount count) {
    if (scene.compute.backend == Backend::Cpu) return false;
    const bool asked = scene.compute.backend == Backend::Cuda;
    if (const std::string why = whyNoGpu(scene); !why.empty()) {
        if (asked)
            throw Error(Failure::NoDevice, "--backend cuda: " + why + "; or use --backend cpu");
        return false;
    }
    if (const std::string why = whyTooLargeForGpu(scene, count); !why.empty()) {
        if (asked) throw Error(Failure::Memory, why + "; raise it, or use --backend cpu");
        return false;
    }
    return true;
}

std::unique_ptr<Simulation> makeSimdSimulation(const Scene& scene, const RunState& state,
                                               int threads) {
    struct InstructionSet {
        Simd name;
        int64_t target;
        decltype(&makeSseSimulation) make;
    };
    static constexpr InstructionSet sets[] = {
#ifndef SPINDRIFT_WITHOUT_AVX512
        {Simd::Avx512, HWY_AVX3, makeAvx512Simulation},
#endif
#ifndef SPINDRIFT_WITHOUT_AVX2
        {Simd::Avx2, HWY_AVX2, makeAvx2Simulation},
#endif
#ifndef SPINDRIFT_WITHOUT_SSE
        {Simd::Sse, HWY_SSSE3, makeSseSimulation},
#endif
    };
    const int64_t machine = hwy::SupportedTargets();
    for (const InstructionSet& set : sets)
        if ((scene.compute.simd == Simd::Auto || scene.compute.simd == set.name) &&
            (machine & set.target))
            return set.make(scene, state, threads);
    throw Error(Failure::NoDevice,
                "compute.simd: this processor does not have that instruction set; use auto");
}

static std::unique_ptr<Simulation> build(const Scene& scene, const RunState* state) {
    ParticleCount count = state ? countOf(state->particles) : countParticles(scene);
    count.fluid = mostFluid(scene, count.fluid);
    const bool gpu = runsOnGpu(scene, count);
    try {
        const RunState start = state ? RunState() : RunState(placeParticles(scene));
        const RunState& from = state ? *state : start;
        if (from.particles.positions.empty() && !comesAndGoes(scene))
            throw Error(
                Failure::Scene,
                "fluid.bodies: not one particle fits into them beside the solids and objects; "
                "move or shrink those, a mesh whose file is in millimetres by its scale");
        if (gpu) return makeCudaSimulation(scene, from, deviceOf(scene));
        return scene.compute.precision == Precision::Double
                   ? makeDoubleSimulation(scene, from, threadCount(scene))
                   : makeSimdSimulation(scene, from, threadCount(scene));
    } catch (const std::bad_alloc&) {
        throw Error(Failure::Memory,
                    "out of memory while building the particles; use a larger simulation.spacing");
    }
}

std::unique_ptr<Simulation> makeSimulation(const Scene& scene) { return build(scene, nullptr); }
std::unique_ptr<Simulation> makeSimulation(const Scene& scene, const RunState& state) {
    return build(scene, &state);
}

}  // namespace spindrift
