#pragma once
// What a solid weighs and how it resists being turned.
#include "scene/sample_solid.h"
#include "scene/scene.h"

namespace spindrift {

// kg; m from the solid's middle to the centre of mass, in its own axes; the tensor of inertia about
// that centre, kg m^2, row by row. In two dimensions both per metre of depth.
struct Mass {
    double mass;
    Vec3d centre, inertia[3];
};
Mass massOf(const Scene&, const Solid&);

// The solid's surface as shares of its outermost particles, those of `sample` nearer to it than
// 0.75 spacings: outward areas, m^2, 0 for the others. They close, sum A = 0, and of a pressure g.x
// they make the force of the displaced volume, -sum (g.x) A = -V g, whatever the shape and the
// resolution. All 0 of what is so thin that its particles don't tell one face from the other.
std::vector<Vec3d> surfaceAreas(const Scene&, const Solid&, const SolidSample& sample);

// The inverse of m's transpose, row by row, by cofactors; of a symmetric matrix its inverse.
void invertTransposed(const Vec3d (&m)[3], Vec3d (&inverse)[3]);

}  // namespace spindrift
