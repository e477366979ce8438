#pragma once
// Fields between the particles.
#include "sim/simulation.h"

#include <vector>

namespace spindrift {

struct Fields { Vec3d velocity; double pressure = 0; int neighbours = 0; };   // m/s, Pa

// At each point (world coordinates), by moving least squares of first order over the fluid particles nearer than `radius` (m):
// exact for linear fields. With too few neighbours for a slope their weighted mean (Shepard), with none zeros. Nothing is
// mirrored at walls or wrapped at periodic sides.
std::vector<Fields> interpolate(const std::vector<Particle>&, const std::vector<Vec3d>& points, double radius);

}  // namespace spindrift
