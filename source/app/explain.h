#pragma once
#include "scene/scene.h"
#include "sim/simulation.h"

#include <string>

namespace spindrift {

// Writes to standard output which passes and terms a step of this scene runs, which it skips and
// why, what memory the run takes, and, when compute.steps is set, the time of each pass over so
// many steps. Returns Exit::Ok. Throws Error.
int explain(const Scene&);

// "5520 fluid, 5316 boundary, 3040 of objects"
std::string particlesOf(Simulation&);

}  // namespace spindrift
