#pragma once
// The fields that fluid begins with.
#include "scene/scene.h"

namespace spindrift {

// What the fluid does at the start at one point: m/s, Pa.
struct Start {
    Vec3d velocity;
    double pressure = 0;
};

// Of this body at p, relative to domain.min.
Start startOf(const Scene&, const Body&, Vec3d p);

}  // namespace spindrift
