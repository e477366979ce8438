#pragma once
// Particles that fill a region evenly and in no order.
#include "core/vec.h"

#include <functional>
#include <vector>

namespace spindrift {

// What lies in a box from low to high, m; along a periodic axis that is a period. In two dimensions
// z is that of the particles.
struct Region {
    int dimensions = 3;
    Vec3d low, high;
    bool periodic[3] = {false, false, false};
    // The share of a cell around a point, so many metres wide, that lies in the region.
    std::function<double(Vec3d, double)> inside;
    // What stands for walls and solids where they have particles: those, with their volumes (in two
    // dimensions areas), and the share of a cell that is neither theirs nor the region's. None: all
    // that is not inside is alike.
    std::vector<Vec3d> boundary{};
    std::vector<double> boundaryVolumes{};
    std::function<double(Vec3d, double)> air{};
};

double volumeOf(const Region&, double spacing);  // m^3, in two dimensions m^2

// Moves particles until they are pushed equally from all sides by each other and by what surrounds
// the region: packing after Colagrossi, Bouscasse, Antuono & Marrone 2012 (Computer Physics
// Communications 183, 1641), here as 75 to 100 steps down the gradient of sum V W over the
// particles over those of the boundary, and over a fine lattice in what else is outside. Each
// particle has the volume spacing^d. The same bits for any number of threads; 0 of them: all.
void relax(std::vector<Vec3d>& positions, const Region&, double spacing, int threads);

}  // namespace spindrift
