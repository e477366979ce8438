#pragma once
// What a solid weighs and how it resists being turned.
#include "scene/scene.h"

namespace spindrift {

// kg; m from the solid's middle to the centre of mass, in its own axes; the tensor of inertia about that centre, kg m^2, row by row. In two dimensions
// both per metre of depth.
struct Mass {
    double mass;
    Vec3d centre, inertia[3];
};
Mass massOf(const Scene&, const Solid&);

}  // namespace spindrift
