#pragma once
// Particles as a table: the end of one run, or any other program's particles, as the start of
// another run.
#include "core/vec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace spindrift {

// One entry a particle, SI units, world coordinates. Densities, pressures, masses and fluids (the
// entry of fluid.bodies whose fluid it is of, from 0 on) are empty where the table has none, a
// density of 0 is unknown.
struct ParticleTable {
    std::vector<Vec3d> positions, velocities;
    std::vector<double> densities, pressures, masses, fluids;
    std::vector<int> lines;  // of a CSV file, from 1 on; empty for HDF5
    // "line 7", or "particle 7" of an HDF5 file.
    std::string nameOf(size_t particle) const;
};

// CSV: a header line names the columns x, y, z, vx, vy, vz, rho, p, mass, fluid in any order, the
// last four may be missing, and the velocities all three, which are 0 then (core/table.h). HDF5:
// datasets of one dimension with these names, others are none of our business. Throws Error
// (Scene), one line that names the file and its first bad lines: what is no finite number, too many
// or too few values, a density below 0, a mass that is not above it.
ParticleTable readParticles(const std::string& path);

// How many there are, without reading them all. Throws Error (Scene) when the file can't be read.
int64_t countParticlesIn(const std::string& path);

// The mass that the file's particles have, kg (2D: kg/m), the mean of its column; 0 where it has
// none. A file is read once, and again when it has changed. Throws Error (Scene) when it can't be
// read.
double massInFile(const std::string& path);

// False when not all of it was written. Numbers have all their digits.
bool writeParticles(const std::string& path, bool hdf5, const ParticleTable&);

}  // namespace spindrift
