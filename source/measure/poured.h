#pragma once
// How much fluid there is in the bodies that it was to fill.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

// A body of fluid that is a mesh: what its particles weigh, and what the mesh's volume of that
// fluid does. Lattices don't end at a mesh's surface, and obstacles and other bodies take room.
struct Poured {
    size_t body;          // in fluid.bodies
    double mass, volume;  // kg, m³
    double wanted;        // kg
};

// Of the particles of a run that has not begun.
std::vector<Poured> pouredIntoMeshes(const Scene&, const std::vector<Particle>&);

// A line for each fluid whose particles have more than 1 % more or less mass than the bodies that
// they fill hold beside solids: round ones and those that no lattice fits. None where files say
// which particles there are, nor of meshes.
std::vector<std::string> pouredAmiss(const Scene&, Simulation&);

}  // namespace spindrift
