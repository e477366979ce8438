#pragma once
// How each instance of the simulation is built; makeSimulation chooses among them.
#include "scene/particles.h"
#include "sim/simulation.h"

#include <string>

namespace spindrift {

// "CPU, 2 threads, AVX-512, float": how an instance names itself.
inline std::string cpuName(int threads, const std::string& lanes) {
    return "CPU, " + std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + lanes;
}

std::unique_ptr<Simulation> makeSimdSimulation(const Scene&, const Placement&, int threads);
std::unique_ptr<Simulation> makeDoubleSimulation(const Scene&, const Placement&, int threads);

}  // namespace spindrift
