#pragma once
// Going on from a checkpoint: what of the run that wrote it holds for the next part of it.
#include "app/scene_choice.h"

namespace spindrift {

// The physics is the checkpoint's, and the choices can't change what it was built from. Nothing is
// written that the choices don't name again, and the looks are the scene's own. The end is the one
// chosen, in time or in steps of the whole run, else that of the run before if that is still ahead.
// Throws Error: Usage for a choice's mistake, and for an end that lies behind; Scene for a file
// that can't be read.
Start goOn(const std::string& file, const std::vector<KnobChoice>&);

}  // namespace spindrift
