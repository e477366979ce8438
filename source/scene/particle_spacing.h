#pragma once
// What particles of a file say of themselves: how far apart they are, and which are there twice.
#include "core/vec.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace spindrift {

// Particles that have an earlier one nearer than `distance`, m, and that one. Along an axis with a
// period above 0 the last is a neighbour of the first.
std::vector<std::pair<size_t, size_t>> doubledParticles(const std::vector<Vec3d>&, double distance,
                                                        Vec3d periods);

// The side of the cube, in two dimensions the square, that is a particle's where others surround
// it, m; 0 where too few are surrounded to say.
double spacingBetween(const std::vector<Vec3d>&, int dimensions);

}  // namespace spindrift
