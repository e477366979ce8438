#pragma once
// The lattice on which fluid begins, and what room a particle of it has.
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace spindrift {

// How far apart particles are along each axis, m: simulation.spacing where all bodies are whole
// multiples of it, else what lets whole layers fit between a body's ends, beside solids and other
// bodies too. One lattice for all bodies, so that it goes on where one ends and another begins. In
// two dimensions z is the spacing.
Vec3d latticeStep(const Scene&);

// Whether all sides of bodies, and what solids leave of them, are whole multiples of the spacing.
bool areSidesWhole(const Scene&);

// Counts of planes beyond this stay here, so that a product of three fits in 64 bits.
inline constexpr double MaxPlanes = 2e6;

// Cells of the domain's walls along an axis, from `low` on, m from the domain's lower corner.
struct WallCells {
    double low;
    int64_t count;
    double step;
};
// Whole cells between two opposite faces, as near to the fluid's step as can be; those between the
// faces of blocks that stand on a wall meet these, as the fluid's layers beside them do. There may
// be none under a thin one.
std::vector<WallCells> wallCells(const Scene&, int axis);
// How far apart these are in the mean, m.
Vec3d wallStep(const Scene&);

// Whether a particle's volume, a cell of the lattice or what the particles of a file say, is
// another one than spacing^dimensions.
bool hasOwnVolume(const Scene&);

}  // namespace spindrift
