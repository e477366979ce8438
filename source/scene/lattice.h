#pragma once
// The lattice on which fluid begins, and what room a particle of it has.
#include "scene/scene.h"

namespace spindrift {

// How far apart particles are along each axis, m: simulation.spacing where all bodies are whole
// multiples of it, else what lets whole layers fit between a body's ends, beside solids and other
// bodies too. One lattice for all bodies, so that it goes on where one ends and another begins. In
// two dimensions z is the spacing.
Vec3d latticeStep(const Scene&);

// Whether all sides of bodies, and what solids leave of them, are whole multiples of the spacing.
bool areSidesWhole(const Scene&);

// The step of the domain's walls: whole layers between two opposite faces, as near to the fluid's
// as can be.
Vec3d wallStep(const Scene&);

// Whether a particle's volume, a cell of the lattice or what the particles of a file say, is
// another one than spacing^dimensions.
bool hasOwnVolume(const Scene&);

}  // namespace spindrift
