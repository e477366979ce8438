#pragma once
// The points of the lattices on which bodies of fluid and the domain's walls begin.
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace spindrift {

// A lattice in doubles: point (i, j, k) is at first + i * step, per axis.
struct Lattice {
    int64_t n[3];
    Vec3d first, step;
    Vec3d at(int64_t i, int64_t j, int64_t k) const {
        return {first.x + i * step.x, first.y + j * step.y, first.z + k * step.z};
    }
};

// In two dimensions z has one layer.
bool flat(const Scene&, int axis);
// In two dimensions there is none along z.
double leastStep(const Lattice&);

// Each body's, cell-centred, relative to domain.min.
Lattice bodyLattice(const Scene&, const Body&);
std::vector<Lattice> latticesOf(const Scene&);
// Number of lattice planes of a body along an axis (0 x, 1 y, 2 z); 0 means that the body is too
// thin for a particle.
int64_t latticePlanes(const Scene&, const Body&, int axis);

// Whether p, relative to domain.min, lies in the body. Flat sides are taken where the lattice ends,
// half a spacing beyond its last plane.
bool contains(const Body&, const Lattice&, Vec3d origin, Vec3d p);
// Whether a particle of this body lies nearer to p than 0.98 spacings. Lattices that don't match
// and come nearer squeeze particles (0.95 spacings: 6 %, 0.78: 12 %), and their fluid bursts apart
// in the first steps, faster than a first-order integrator follows.
bool crowds(const Body&, const Lattice&, Vec3d origin, Vec3d p);

// The points between planes across each axis that are not in their inside.
struct Shell {
    std::vector<double> planes[3];  // m, relative to domain.min
    int64_t layers[3];
    int64_t count() const;
    int64_t size(int axis) const { return int64_t(planes[axis].size()); }
    bool contains(int64_t i, int axis) const {
        return i < layers[axis] || i >= size(axis) - layers[axis];
    }
};
// The boundary particles of the domain's walls.
Shell wallShell(const Scene&);
void placeShell(const Shell&, std::vector<Vec3>& out);

}  // namespace spindrift
