#pragma once
#include "scene/scene.h"

namespace spindrift {

// Shows the scene in a window until it's closed; returns what the process returns.
// Throws Error: NoDisplay where there's no screen, and what makeSimulation throws.
int runWindow(Scene);

}  // namespace spindrift
