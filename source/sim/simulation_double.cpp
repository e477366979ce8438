// The yardstick: the same source in double precision, one particle at a time.
#define SPINDRIFT_REAL double
#define LANES doubles
#include "core/error.h"
#include "device/omp.h"
#include "sim/simulation_on.h"
#include "sim/make_simulation.h"

namespace spindrift {

std::unique_ptr<Simulation> makeDoubleSimulation(const Scene& scene, const RunState& state,
                                                 int threads) {
    return std::make_unique<doubles::SimulationOn<Omp>>(
        scene, state, Omp(threads, scene.compute.threads == 0), cpuName(threads, "double"));
}

}  // namespace spindrift
