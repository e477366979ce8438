// The simulation on an NVIDIA GPU: the same source, one particle a thread.
#define SPINDRIFT_REAL float
#define LANES cudaLanes
#include "device/cuda.h"
#include "sim/make_simulation.h"
#include "sim/simulation_on.h"

namespace spindrift {

std::unique_ptr<Simulation> makeCudaSimulation(const Scene& scene, const RunState& state,
                                               int device) {
    return std::make_unique<cudaLanes::SimulationOn<Cuda>>(
        scene, state, Cuda(device), cudaDeviceName(device) + ", CUDA, float");
}

}  // namespace spindrift
