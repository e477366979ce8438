#pragma once
#include "app/scene_choice.h"

namespace spindrift {

// Runs a scene without a window until compute.steps or output.time (600 steps when neither is set)
// and writes what scene.output asks for. Data goes to standard output, progress to standard error.
// Trouble is met as HealthGuard does it, and said on standard error.
// Returns Exit::Ok, or Exit::Diverged when shorter steps have not helped; then the outputs show the
// run up to there and the checkpoint is the last good state before. SIGINT and SIGTERM end the run
// after the step at hand, outputs and checkpoint written, and return 128 + the signal. Throws
// Error: Output before the run when a file can't be written, NoDisplay, NoDevice, Memory.
int runHeadless(const Start&, bool quiet);

}  // namespace spindrift
