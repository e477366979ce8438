#pragma once
// Solids of triangles: read from a file, checked to be closed, weighed, and asked how far away they are.
#include "core/vec.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace spindrift {

// Distances from a surface at the nodes of a lattice around it, x first, in the units of its file; from the middle of its bounding box on.
struct DistanceField { Vec3d low; double spacing; Int3 nodes; std::vector<float> distances; };

// A closed surface, in the units of its file.
class Mesh {
public:
    using Triangle = std::array<int, 3>;   // corners, against the clock seen from outside

    // Corners at one place become one; triangles without area go, and if all face inward they are turned round. Throws Error (Scene), one
    // line that begins with `name`, unless each edge belongs to two triangles, which use it in opposite directions.
    Mesh(const std::string& name, std::vector<Vec3d> vertices, std::vector<Triangle> triangles);

    // How far outside p is (inside: minus the depth), and the outward normal there: exact. Queries of points that lie near each other hand on the triangle
    // that was nearest, -1 at first.
    struct Nearest { double distance; Vec3d normal; };
    Nearest nearest(Vec3d p, int& triangle) const;
    Nearest nearest(Vec3d p) const;

    // Where opposite sides face each other nearer than `most`, how near that is, and where; otherwise `most`.
    struct Thinnest { double thickness; Vec3d at; };
    Thinnest thinnest(double most) const;

    // For those who ask often, and elsewhere than here. How fine it must be where particles are `apart`: half of that, or less where the surface is thin. Throws
    // Error (Scene) when it would be too large.
    double fieldSpacing(double apart) const;
    DistanceField field(double spacing) const;

    const std::vector<Vec3d>& vertices() const { return vertices_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    Vec3d low() const { return low_; }
    Vec3d high() const { return high_; }
    double area() const { return area_; }

    // Of a body of density 1: volume, centroid, and the moments of inertia about it.
    struct Weight { double volume; Vec3d centroid; double inertia[3][3]; };
    Weight weigh() const;

private:
    // The nearest point of a triangle, and on which part of it that lies: a corner 0, 1, 2, the edge from there on 3, 4, 5, inside 6.
    struct Touch { double distance2; Vec3d point; int part; };
    struct Box { Vec3d low, high; int first, count, right; };   // of triangles; without any there is a left box, the next one, and a right one

    void join(const std::string& name);
    void findNormals();
    int divide(int first, int count);
    Touch touch(int triangle, Vec3d p) const;
    Vec3d corner(int triangle, int k) const { return vertices_[size_t(triangles_[size_t(triangle)][size_t(k % 3)])]; }

    std::vector<Vec3d> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<Vec3d> vertexNormals_, edgeNormals_, faceNormals_;   // edges: three a triangle
    std::vector<Box> boxes_;
    Vec3d low_, high_;
    double area_ = 0;
};

// Wavefront OBJ: the lines v and f, whose polygons become fans; all else is passed over. Remembers the files it has read until they
// change. Throws Error (Scene), one line that begins with the path and says which line or edge is wrong.
std::shared_ptr<const Mesh> readMesh(const std::string& path);

}  // namespace spindrift
