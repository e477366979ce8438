#include "sim/make_simulation.h"

#include "core/error.h"

#include <algorithm>
#include <new>
#include <thread>

namespace spindrift {

static int threadCount(const Scene& scene) {
    const int cores = int(std::max(1u, std::thread::hardware_concurrency()));
    return scene.compute.threads > 0 ? scene.compute.threads : cores;
}

std::unique_ptr<Simulation> makeSimulation(const Scene& scene) {
    if (scene.compute.backend == Backend::Cuda)
        throw Error(Exit::NoDevice, "compute.backend: cuda was asked for, but this build runs on the CPU only; use auto or cpu");
    try {
        const Placement placement = placeParticles(scene);
        return scene.compute.precision == Precision::Double ? makeDoubleSimulation(scene, placement, threadCount(scene))
                                                            : makeSimdSimulation(scene, placement, threadCount(scene));
    } catch (const std::bad_alloc&) {
        throw Error(Exit::Memory, "out of memory while building the particles; use a larger simulation.spacing");
    }
}

}  // namespace spindrift
