#pragma once
// Solids -> boundary particles.
#include "scene/scene.h"

#include <vector>

namespace spindrift {

// Layers of boundary particles behind a surface: all that fluid half a spacing in front of it can
// see.
int boundaryLayers(const Scene&);

// Layers of particles inside the solid's surface, the first one half a spacing deep and each
// parallel to it, about one spacing apart: places in m relative to domain.min, in two dimensions in
// the middle of z; and the volume that each stands for, in those of a fluid particle at rest, which
// add up to the layers' own.
struct SolidSample {
    std::vector<Vec3> positions;
    std::vector<float> volumes;
    // Of thin solids only (thin_solid.h).
    std::vector<Vec3> faces;
    std::vector<char> beyond;
};
SolidSample sampleSolid(const Scene&, const Solid&);

// No plane has more particles.
double mostOfPlane(const Scene&);

}  // namespace spindrift
