#pragma once
// What a run will take, before anything is allocated.
#include "scene/particles.h"
#include "scene/scene.h"

#include <cstdint>

namespace spindrift {

// Bytes that a run of this scene with so many particles needs, at most: particles and grid.
int64_t estimateMemory(const Scene&, ParticleCount);
// The same on a GPU.
int64_t estimateGpuMemory(const Scene&, ParticleCount);

}  // namespace spindrift
