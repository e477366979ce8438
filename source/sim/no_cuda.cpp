// What a build without CUDA says when it is asked for a GPU.
#include "core/error.h"
#include "device/cuda_devices.h"
#include "sim/make_simulation.h"

namespace spindrift {

std::string cudaProblem(int) {
    return "this build has no CUDA in it; install the CUDA toolkit and build again";
}
std::string cudaDeviceName(int) { return ""; }
int64_t cudaFreeMemory(int) { return 0; }

std::unique_ptr<Simulation> makeCudaSimulation(const Scene&, const RunState&, int device) {
    throw Error(Failure::NoDevice, "--backend cuda: " + cudaProblem(device));
}

}  // namespace spindrift
