#pragma once
#include "scene/scene.h"

#include <cstdint>
#include <string>

namespace spindrift {

// Bytes that a run of this scene needs, at most: particles and grid. Computed without allocating.
int64_t estimateMemory(const Scene&);
// The same on a GPU.
int64_t estimateGpuMemory(const Scene&);

// Refuses a scene that can't run or makes no sense: values out of range, bodies outside the domain,
// no fluid, more particles than fit. Throws Error: Exit::Memory when the machine is too small, else
// Exit::Scene; one line with `place` (the file), path and remedy.
void checkScene(const Scene&, const std::string& place = "scene");

}  // namespace spindrift
