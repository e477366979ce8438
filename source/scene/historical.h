#pragma once
// The historical layout of scene files: no "version", SI-less tuned values, one centred block in a
// cube.
#include "scene/read_knobs.h"

namespace spindrift {

// Translates a historical file into a Scene of the classic formulation. Every key is optional.
// Throws Error(Failure::Scene).
Scene readHistorical(const Json& root, const std::string& file);

}  // namespace spindrift
