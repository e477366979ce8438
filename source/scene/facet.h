#pragma once
// Triangles in space one by one: where two of them meet, and into what parts one falls along such
// lines.
#include "scene/box_tree.h"

#include <vector>

namespace spindrift {

struct Facet {
    Vec3d corner[3], normal;  // of length 1, or 0 where it has no area

    explicit Facet(Vec3d a, Vec3d b, Vec3d c);
    Box box() const;
    double area() const {
        return 0.5 * length(cross(corner[1] - corner[0], corner[2] - corner[0]));
    }
    double height(Vec3d p) const { return dot(normal, p - corner[0]); }
    // Whether p, a point of its plane, lies in it or no further than the tolerance beside it.
    bool covers(Vec3d p, double tolerance) const;
    // The nearest of its points.
    Vec3d nearest(Vec3d p) const;
};

struct Segment {
    Vec3d from, to;
};
enum class Meeting { None, Touch, Cross, Cover };  // Cover: in one plane, with an area in common

// How u meets t; what is nearer than the tolerance touches. Appends the lines along which u cuts t.
Meeting meet(const Facet& t, const Facet& u, double tolerance, std::vector<Segment>& cuts);

// Convex polygons that together are t, none of which has a part of a cut inside.
std::vector<std::vector<Vec3d>> cutUp(const Facet& t, const std::vector<Segment>& cuts,
                                      double tolerance);

}  // namespace spindrift
