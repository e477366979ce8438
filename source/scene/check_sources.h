#pragma once
// What checkScene asks of sources and sinks, as check_bodies.h of solids.
#include "scene/scene.h"

namespace spindrift {

// Throws Error (Scene).
void checkSources(const Scene&);

}  // namespace spindrift
