#pragma once
#include "scene/scene.h"

namespace spindrift {

// Runs a scene without a window until compute.steps or output.time (600 steps when neither is set)
// and writes what scene.output asks for. Data goes to standard output, progress to standard error.
// Returns Exit::Ok, or Exit::Diverged when the physics blew up; then the outputs show the run up to
// there. Throws Error: Output before the run when a file can't be written, NoDisplay, NoDevice,
// Memory.
int runHeadless(const Scene&, bool quiet);

}  // namespace spindrift
