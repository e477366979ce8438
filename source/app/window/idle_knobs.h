#pragma once
// Knobs that change nothing in the scene as it is.
#include "scene/scene.h"

#include <string>

namespace spindrift {

// Why a live knob has no effect: what would have to be otherwise; "" when it has one.
std::string whyIdle(const Scene&, const std::string& path);

}  // namespace spindrift
