#pragma once
// Which formulations, kernels, integrators, pressure forms, walls and time modes go together.
#include "scene/scene.h"

namespace spindrift {

// Throws Error (Scene) where two of them do not: one line that names the knob and the way out.
void checkMethods(const Scene&);

}  // namespace spindrift
