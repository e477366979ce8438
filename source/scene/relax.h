#pragma once
// Particles that fill a region evenly and in no order.
#include "core/vec.h"

#include <functional>
#include <memory>
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
    // Where only a part of the region is to be packed: whether a point may be seen from there.
    std::function<bool(Vec3d)> isNear{};
    // A point, or where it gets out of what it must not be in.
    std::function<Vec3d(Vec3d)> out{};
};

double volumeOf(const Region&, double spacing);  // m^3, in two dimensions m^2

// sum V W at a point, of places with those volumes: 1 on a lattice, a half at its end.
std::function<double(Vec3d)> densityAround(const std::vector<Vec3d>& places,
                                           const std::vector<double>& volumes, const Region&,
                                           double spacing);
// 1/m, how steeply that falls where a lattice ends.
double steepnessAtEnds(double spacing);

// Moves particles until they are pushed equally from all sides by each other and by what surrounds
// the region: packing after Colagrossi, Bouscasse, Antuono & Marrone 2012 (Computer Physics
// Communications 183, 1641), here as steps down the gradient of sum V W over the particles over
// those of the boundary, and over a fine lattice in what else is outside. Each particle has the
// volume spacing^d. The same bits for any number of threads; 0 of them: all.
class Packing {
public:
    // Enough from a random start; with boundary particles a step takes along some of the last one.
    static constexpr int Steps = 100, StepsWithMomentum = 75;
    Packing(const Region&, double spacing, int threads);
    ~Packing();
    void relax(std::vector<Vec3d>& positions, int steps);
    // sum V W at each, 1 on a lattice.
    std::vector<double> densities(const std::vector<Vec3d>& positions);

private:
    struct Crowds;
    Vec3d into(Vec3d x) const;
    void fill(const std::vector<Vec3d>& positions);
    const Region& region_;
    double spacing_;
    int team_;
    std::unique_ptr<Crowds> crowds_;
};
void relax(std::vector<Vec3d>& positions, const Region&, double spacing, int threads);

}  // namespace spindrift
