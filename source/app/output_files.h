#pragma once
// Where a run without a window writes: tried before its first step.
#include "app/scene_choice.h"

namespace spindrift {

// An hour of computing must not end at a missing folder. The file that the run is read from is no
// place for outputs, but for a checkpoint that is named again. Throws Error (Output).
void requireOutputs(const Output&, const Start&);

// Whether one of them is standard output.
bool takesStandardOutput(const Output&);

}  // namespace spindrift
