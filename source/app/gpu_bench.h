#pragma once
#include "scene/scene.h"

#include <nlohmann/json.hpp>

namespace spindrift {

// The cost of a frame (map the vertex buffer, write it, unmap) and of handing the run over to the CPU and back: a line each
// on standard output, and as JSON.
nlohmann::json benchFrameAndSwitch(const Scene&);

}  // namespace spindrift
