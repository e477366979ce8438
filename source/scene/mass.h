#pragma once
// What a solid weighs and how it resists being turned.
#include "scene/scene.h"

namespace spindrift {

// kg; m from the solid's middle to the centre of mass, in its own axes; kg m^2 about that centre: xx, yy, zz. The axes of every shape are its
// principal ones. In two dimensions of a slab one spacing thick.
struct Mass {
    double mass;
    Vec3d centre, inertia;
};
Mass massOf(const Scene&, const Solid&);

}  // namespace spindrift
