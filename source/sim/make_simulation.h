#pragma once
// How each instance of the simulation is built; makeSimulation chooses among them.
#include "sim/simulation.h"

#include <string>

namespace spindrift {

// "CPU, 2 threads, AVX-512, float": how an instance names itself.
inline std::string cpuName(int threads, const std::string& lanes) {
    return "CPU, " + std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + lanes;
}

// They start from a state, or from the placement of a run that begins.
// On the instruction set asked for, or the best one that the processor has. Throws Error
// (NoDevice).
std::unique_ptr<Simulation> makeSimdSimulation(const Scene&, const RunState&, int threads);
// For processors that have it.
std::unique_ptr<Simulation> makeAvx512Simulation(const Scene&, const RunState&, int threads);
std::unique_ptr<Simulation> makeAvx2Simulation(const Scene&, const RunState&, int threads);
std::unique_ptr<Simulation> makeSseSimulation(const Scene&, const RunState&, int threads);
std::unique_ptr<Simulation> makeDoubleSimulation(const Scene&, const RunState&, int threads);
// Throws Error (NoDevice, Memory).
std::unique_ptr<Simulation> makeCudaSimulation(const Scene&, const RunState&, int device);

}  // namespace spindrift
