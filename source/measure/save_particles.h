#pragma once
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

// Particles as a table that a body of shape file can be: HDF5 when the path ends in .h5, else CSV;
// world coordinates, all digits, and their masses, kg, in two dimensions kg/m, where they are
// given, and so the entries of fluid.bodies whose fluids they are of. Throws Error (Output).
void saveParticles(const std::string& path, const std::vector<Particle>&,
                   const std::vector<double>& masses = {}, const std::vector<double>& fluids = {});

// Of each particle in the order of their ids; none where a particle's volume is spacing^3, which is
// what a reader of the file takes it for.
std::vector<double> massesToSave(const Scene&, Simulation&);
// The same; none where there is one fluid, or masses say which it is.
std::vector<double> fluidsToSave(const Scene&, Simulation&);

}  // namespace spindrift
