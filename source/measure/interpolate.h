#pragma once
// Fields between the particles.
#include "sim/simulation.h"

#include <vector>

namespace spindrift {

struct Fields { Vec3d velocity; double pressure = 0; int neighbours = 0; };   // m/s, Pa

enum class Order { Mean, Linear };

// At each point (world coordinates), from the fluid particles nearer than `radius` (m). Linear: moving least squares of first order, exact for
// linear fields; with too few neighbours for a slope as Mean. Mean: their weighted mean (Shepard), never beyond their values: for
// spray. Without neighbours zeros. Nothing is mirrored at walls or wrapped at periodic sides.
std::vector<Fields> interpolate(const std::vector<Particle>&, const std::vector<Vec3d>& points, double radius, Order = Order::Linear);

}  // namespace spindrift
