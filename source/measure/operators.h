#pragma once
// How wrong gradients and Laplacians are on lattices and off them: no step in time, or one.
#include "measure/validation.h"

namespace spindrift {

// In the scene of a Taylor-Green flow, whose formulation, jitter and state at the start are chosen
// here.
void runOperators(const Scene&, ValidationRun&);

}  // namespace spindrift
