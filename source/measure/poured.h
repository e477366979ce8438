#pragma once
// How much fluid there is in the meshes that it was to fill.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <vector>

namespace spindrift {

// A body of fluid that is a mesh: what its particles weigh, and what the mesh's volume of that fluid
// does. Lattices don't end at a mesh's surface, and obstacles and other bodies take room.
struct Poured {
    size_t body;           // in fluid.bodies
    double mass, volume;   // kg, m³
    double wanted;         // kg
};

// Of the particles of a run that has not begun.
std::vector<Poured> pouredIntoMeshes(const Scene&, const std::vector<Particle>&);

}  // namespace spindrift
