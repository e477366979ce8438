#pragma once
// Elastic objects -> particles and the bonds between them.
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace spindrift {

// Of particles `a` < `b`: m at rest, N/m, in two dimensions N/m per metre of depth.
struct Bond {
    int a, b;
    float length, stiffness;
};

// All objects of a scene, one after the other: m from domain.min, kg (in two dimensions kg/m), m;
// the object that each particle is of, the first grip that holds it or -1, and whether it is at the
// surface. Lattices of springs along the edges and the diagonals of faces of their cells are
// isotropic, with Poisson's ratio 1/4 in three dimensions and 1/3 in a layer (Hrennikoff 1941);
// bonds that several cells share are as stiff as all their shares.
struct ObjectSample {
    std::vector<Vec3> positions;
    std::vector<float> masses, radii;
    std::vector<int> objects, grips;
    std::vector<uint8_t> atSurface;
    std::vector<Bond> bonds;
    size_t size() const { return positions.size(); }
};
ObjectSample sampleObjects(const Scene&);

// m between an object's particles, as asked for.
float spacingOf(const Scene&, const Object&);

// How many particles sampleObjects makes, of shells nearly, without making any.
double countObjectParticles(const Scene&);

// About where an object is, m, world coordinates.
Vec3d middleOf(const Object&);

// Where objects are: their particles in cells as wide as the longest contact, within which no fluid
// starts.
class ObjectRoom {
public:
    explicit ObjectRoom(const Scene&);
    bool takes(Vec3d) const;  // m from domain.min

private:
    using Cell = std::array<int64_t, 3>;
    Cell cellOf(Vec3d) const;
    ObjectSample sample_;
    double fluidRadius_, influence_, cell_ = 0;  // m
    std::map<Cell, std::vector<int>> cells_;
};

}  // namespace spindrift
