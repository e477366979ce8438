#pragma once
// Places of fluid that are packed: all of them, or those beside solids that no lattice fits to.
#include "scene/body_lattice.h"
#include "scene/convex.h"
#include "scene/relax.h"

#include <random>
#include <vector>

namespace spindrift {

bool relaxed(const Scene&);  // all are packed

// Where a particle begins, relative to domain.min, and of which body it has the rest.
struct Place {
    Vec3d at;
    size_t body;
};

// Uniform in [-reach, reach] along each axis that the scene has. The same numbers from every
// standard library.
class Jitter {
public:
    Jitter(const Scene& scene, double reach)  // in spacings
        : random_(unsigned(scene.simulation.seed)),
          dimensions_(scene.simulation.dimensions),
          reach_(reach * double(scene.simulation.spacing)) {}
    Vec3d next() {
        Vec3d d{0, 0, 0};
        if (reach_ == 0) return d;
        for (int k = 0; k < dimensions_; ++k)
            d[k] = reach_ * (2 * (random_() + 0.5) / 4294967296.0 - 1);
        return d;
    }
    size_t oneOf(size_t count) { return random_() % count; }

private:
    std::mt19937 random_;
    int dimensions_;
    double reach_;  // m
};

// Signed distance from a shape's surface at p, relative to domain.min, m: positive outside.
double distanceFrom(const Scene&, const Convex&, Vec3d p);
std::vector<Convex> solidsOf(const Scene&);

struct CellLeft {
    Vec3d middle;
    double share;
};

// Solids whose surface is across the lattice. Layers of fluid don't fit to it: particles at some
// part of a spacing from it were pushed off at 1 to 3 m/s in the first hundredths of a second. So
// the fluid near it is packed (packBeside), as many particles as its cells have room for.
class Slants {
public:
    Slants(const Scene&, const std::vector<Lattice>&);
    // m, how far from such a solid fluid is packed.
    double reach() const { return 2.6 * double(scene_.simulation.spacing); }
    // m, from the nearest surface.
    double distance(Vec3d p) const;
    // What they leave of a lattice's cell around p, which is so far from them.
    CellLeft leftOf(const Lattice&, Vec3d p, double distance) const;
    const std::vector<Convex>& solids() const { return solids_; }

private:
    const Scene& scene_;
    std::vector<Convex> solids_;
};

// A point of a lattice near such a solid, and how much of its cell is left.
struct Candidate {
    Place place;
    double distance, share;
};

// Whether all cells are either left or not: the lattice fits to these solids.
bool areWhole(const std::vector<Candidate>&);

// As many of one body's as there is room for, those first that are farthest from solids; in their
// order.
void choose(const std::vector<Candidate>&, const Slants&, std::vector<Place>& out);

// Moves the places from `first` on, which are near slants, until they and the others are evenly
// spread; a particle without room there is left out.
void packBeside(const Scene&, const std::vector<Lattice>&, const Slants&, size_t first,
                std::vector<Place>&);

// Some forms together, without the solids.
Region regionOf(const Scene&, const std::vector<Form>&);
// Bodies with their flat sides where their lattices end, or at a side of the domain that is nearer
// than half a spacing from there, and far beyond that where the domain is periodic: the fluid goes
// on there.
std::vector<Form> fittedBodies(const Scene&, const std::vector<Lattice>&);

// From a random start: up to a spacing away from the lattice along each axis (half a spacing leaves
// its rows to be seen), but in the region. As many as fit: a lattice in a round body has a few too
// many or too few.
void relaxPlaces(const Scene&, const std::vector<Lattice>&, bool isCut, std::vector<Place>&);

// The places of a file's particles, from `first` on, until they lie evenly between the others,
// walls and solids, where they are: in the open they end where their density is a half. Relative to
// domain.min.
void relaxFrom(const Scene&, size_t first, std::vector<Vec3>&);

}  // namespace spindrift
