#pragma once
// How each instance of the simulation is built; makeSimulation chooses among them.
#include "scene/particles.h"
#include "sim/simulation.h"

namespace spindrift {

std::unique_ptr<Simulation> makeSimdSimulation(const Scene&, const Placement&, int threads);
std::unique_ptr<Simulation> makeDoubleSimulation(const Scene&, const Placement&, int threads);

}  // namespace spindrift
