#pragma once
// Solids so thin that fluid on one side would feel the fluid on the other through them.
#include "scene/convex.h"
#include "scene/sample_solid.h"

namespace spindrift {

// m, of a solid through which fluid on its two sides would feel each other, and that is too wide
// for fluid to feel its way around; otherwise 0.
double thinness(const Scene&, const Solid&);

// Whether the way from p to q, in the axes of the shape and from its middle, leads through it,
// which is so thick.
bool separates(const Convex& shape, double thickness, Vec3d p, Vec3d q);

// What each side of a thin solid needs is a wall as thick as if there were no other side: layers
// behind its own face, in the solid and beyond it, where fluid of the other side passes through
// them. `faces` say from where each particle's face is to the particle, m, in the solid's own axes;
// `beyond` that it lies outside of the solid, so that it is seen through the solid only. They also
// continue beside the solid, where its shadow falls.
SolidSample sampleSides(const Scene&, const Solid&);

// The boundary particles that a run has of a solid, be it thin or not.
SolidSample boundaryOf(const Scene&, const Solid&);

}  // namespace spindrift
