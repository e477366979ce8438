#pragma once
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

// Particles as a table that a body of shape file can be: HDF5 when the path ends in .h5, else CSV; world coordinates, all digits. Throws
// Error (Output).
void saveParticles(const std::string& path, const std::vector<Particle>&);

}  // namespace spindrift
