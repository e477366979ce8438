#pragma once
// Shapes as what their points have in common: below each of some planes, and within a radius of an
// axis or a point. All shapes of a scene but meshes are convex and are described so, which makes
// distances and collisions one formula. Of a mesh the planes are its bounding box.
#include "core/vec.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace spindrift {

struct Convex {
    static constexpr int mostPlanes = 6;
    Vec3d middle;  // m, of the bounding box, as in the scene file; all below is relative to it
    int planes = 0;
    Vec3d normal[mostPlanes];            // unit length, outward
    double offset[mostPlanes];           // m: inside where normal.x < offset
    double radius = 0;                   // m, of the round side, 0 = none
    Vec3d across{0, 0, 0};               // 1 for each axis that the radius is measured along
    std::shared_ptr<const Mesh> mesh{};  // null: there is none
    double scale = 1;                    // m per unit of the mesh

    // How far outside p is, m (inside: minus the depth, exact; outside, beside edges, no more than
    // the distance), and the outward normal there.
    struct Nearest {
        double distance;
        Vec3d normal;
    };
    Nearest nearest(Vec3d p) const;
    // The same of a mesh, exact outside too; see Mesh::nearest.
    Nearest nearestOfMesh(Vec3d p, int& triangle) const;

private:
    friend Convex convexOf(const Form&, int dimensions);
    void add(Vec3d direction, Vec3d through);
};

// In two dimensions shapes have no ends along z. Reads a mesh's file.
Convex convexOf(const Form&, int dimensions);

// From a shape's middle to its farthest point, m.
double reachOf(const Form&);

// Half the extent of a shape along each axis, m; of a plane 0.
Vec3d halfExtent(const Form&);

}  // namespace spindrift
