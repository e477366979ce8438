#pragma once
// Shapes as what their points have in common: below each of some planes, and within a radius of an
// axis or a point. All shapes of a scene but meshes are convex and are described so, which makes
// distances and collisions one formula. Of a mesh the planes are its bounding box; one that fills
// it is a block.
#include "core/vec.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace spindrift {

struct Convex {
    static constexpr int mostPlanes = 6;
    Vec3d middle;  // m, of the bounding box, as in the scene file; all below is relative to it,
                   // in the shape's own axes, which these are in space:
    Vec3d axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
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
    // The same of a point of the scene, and its normal in space.
    Nearest nearestInSpace(Vec3d point) const;
    // A direction in space as seen in the own axes, and the other way round.
    Vec3d into(Vec3d a) const { return {dot(a, axis[0]), dot(a, axis[1]), dot(a, axis[2])}; }
    Vec3d out(Vec3d a) const { return a.x * axis[0] + a.y * axis[1] + a.z * axis[2]; }
    // Where a point of the shape, as it is drawn, is where it begins turned.
    Vec3d turned(Vec3d point) const { return middle + out(point - middle); }
    // The same of a mesh, exact outside too; see Mesh::nearest.
    Nearest nearestOfMesh(Vec3d p, int& triangle) const;

private:
    friend Convex convexOf(const Form&, int dimensions);
    void add(Vec3d direction, Vec3d through);
};

// Whether it is a block, or a mesh that is one: that has all that blocks have, layers of fluid that
// meet its faces, and plates'.
bool isBlock(const Form&);

// In two dimensions shapes have no ends along z. Reads a mesh's file.
Convex convexOf(const Form&, int dimensions);
// As it begins: it may be turned.
Convex convexOf(const Solid&, int dimensions);

// From a shape's middle to its farthest point, m.
double reachOf(const Form&);

// m, of a shape's bounding box, as in the scene; of a plane the point that it goes through.
Vec3d middleOf(const Form&);
// Half the extent of a shape along each axis, m; of a plane 0.
Vec3d halfExtent(const Form&);
// The same of the box around it as it begins.
Vec3d halfSpan(const Solid&);

}  // namespace spindrift
