#pragma once
// Solids of triangles: read from a file, checked to be closed, weighed, and asked how far away they
// are.
#include "core/vec.h"
#include "scene/facet.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace spindrift {

// Distances from a surface at the nodes of a lattice around it, x first, in the units of its file;
// from the middle of its bounding box on.
struct DistanceField {
    Vec3d low;
    double spacing;
    Int3 nodes;
    std::vector<float> distances;
};

// The surface of a solid, in the units of its file.
//
// A file has closed shells. Those that cross or touch each other are one body: what is in any of
// them. A body in another one is a hollow there, and one in the hollow is solid again. How a shell
// is wound does not matter.
class Mesh {
public:
    using Triangle = std::array<int, 3>;  // corners, against the clock seen from outside

    // roundOff: how wrong coordinates may be. Throws Error (Scene), one line that begins with
    // `name`, when the triangles enclose nothing or are open; see findShells.
    Mesh(const std::string& name, const std::vector<Vec3d>& vertices,
         const std::vector<Triangle>& triangles, double roundOff = 0);

    // How far outside p is (inside: minus the depth), and the outward normal there: exact. Queries
    // of points that lie near each other hand on the part of the surface that was nearest, -1 at
    // first.
    struct Nearest {
        double distance;
        Vec3d normal;
    };
    Nearest nearest(Vec3d p, int& facet) const;
    Nearest nearest(Vec3d p) const;

    // Where opposite sides face each other nearer than `most`, how near that is, and where;
    // otherwise `most`.
    struct Thinnest {
        double thickness;
        Vec3d at;
    };
    Thinnest thinnest(double most) const;

    // For code that asks often, and elsewhere than here. How fine it must be where particles are
    // `apart`: half of that, or less where the surface is thin. Throws Error (Scene) when it would
    // be too large.
    double fieldSpacing(double apart) const;
    DistanceField field(double spacing) const;

    // The shells, also where they are inside of each other.
    const std::vector<Vec3d>& vertices() const { return vertices_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    Vec3d low() const { return low_; }
    Vec3d high() const { return high_; }
    double area() const { return area_; }
    // Whether it fills its bounding box: a block.
    bool isBox() const { return isBox_; }

    // Of a body of density 1: volume, centroid, and the moments of inertia about it.
    struct Weight {
        double volume;
        Vec3d centroid;
        double inertia[3][3];
    };
    Weight weigh() const;

private:
    Facet facetOf(int triangle) const;
    double distance(Vec3d p, int& facet) const;
    std::vector<double> changesAlong(double y, double z) const;
    bool holds(Vec3d p) const;
    void findBox();
    bool liesOnBox(const Facet&) const;
    bool liesOn(int i, int j) const;
    void findSurface();
    void addSurface(const Facet&, const std::vector<Vec3d>& polygon, const std::vector<int>& covers,
                    std::vector<Facet>& out) const;
    std::array<int64_t, 2> gridPlace(double y, double z) const;
    bool isTip(Vec3d at, Vec3d normal, Vec3d opposite, Vec3d facing) const;

    std::vector<Vec3d> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<int> shells_, bodies_;  // of a triangle, of a shell
    std::vector<std::array<int64_t, 2>>
        onGrid_;  // y and z of the vertices, on a grid so fine that products of two are exact
    std::vector<Facet> surface_;  // parts of triangles
    BoxTree triangleTree_, surfaceTree_;
    Vec3d low_, high_;
    double area_ = 0, precision_ = 0;
    bool isBox_ = false;
};

// OBJ, in double precision; STL, PLY and glTF. Remembers the files it has read until they change.
// Throws Error (Scene), one line that begins with the path and says which line or edge is wrong.
std::shared_ptr<const Mesh> readMesh(const std::string& path);

}  // namespace spindrift
