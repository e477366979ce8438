#pragma once
// Whether a run still makes physical sense.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <string>

namespace spindrift {

// One line that says how the run has diverged, when, and what to try; "" while it is sound.
// Diverged: a value is not finite, a particle passes a whole support radius in one step, or one is
// three times as fast as sound in the fluid.
std::string divergence(const Scene&, const Measurement&);

}  // namespace spindrift
