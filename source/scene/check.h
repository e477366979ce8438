#pragma once
#include "scene/scene.h"

#include "scene/particles.h"

#include <cstdint>
#include <optional>
#include <string>

namespace spindrift {

// Bytes that a run of this scene with so many particles needs, at most: particles and grid.
// Computed without allocating.
int64_t estimateMemory(const Scene&, ParticleCount);
// The same on a GPU.
int64_t estimateGpuMemory(const Scene&, ParticleCount);

// Refuses a scene that can't run or makes no sense: values out of range, bodies outside the domain,
// no fluid, more particles than fit. Throws Error: Exit::Memory when the machine is too small, else
// Exit::Scene; one line with `place` (the file), path and remedy.
// `begun`: the particles of a run that goes on; where its bodies had theirs from no longer matters.
void checkScene(const Scene&, const std::string& place = "scene",
                std::optional<ParticleCount> begun = {});

}  // namespace spindrift
