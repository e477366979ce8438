#pragma once
#include "scene/scene.h"

#include <nlohmann/json.hpp>

namespace spindrift {

// The cost of a frame (map the vertex buffer, write it, unmap) and of handing the run over to the
// CPU and back: a line each on standard output, and as JSON.
nlohmann::json benchFrameAndSwitch(const Scene&);

// What a picture of dam breaks of 20 to 200 thousand particles costs: the median ms of 20 for
// vertices, drawing and reading back, after 0.1 s of flow. Returns Exit::Ok.
int benchFrames();

}  // namespace spindrift
