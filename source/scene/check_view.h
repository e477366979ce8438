#pragma once
// What a scene's view asks for can be drawn.
#include "scene/scene.h"

namespace spindrift {

void checkView(const Scene&);

}  // namespace spindrift
