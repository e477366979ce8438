#pragma once
#include "app/scene_choice.h"

namespace spindrift {

// Shows the scene in a window until it's closed; returns what the process returns.
// Throws Error: NoDisplay where there's no screen, and what makeSimulation throws.
int runWindow(Start);

}  // namespace spindrift
