#pragma once
// Solids as triangles, for the eye.
#include "render/solids.h"
#include "scene/scene.h"

namespace spindrift {

// In its own axes, from its middle on. What has no end (planes, shapes in two dimensions) ends
// where the domain does.
SolidShape shapeOf(const Scene&, const Solid&);

}  // namespace spindrift
