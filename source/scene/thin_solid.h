#pragma once
// Solids so thin that fluid on one side would feel the fluid on the other through them.
#include "scene/sample_solid.h"

namespace spindrift {

// m, of a solid of which both faces' fluid would press the same particles, or feel each other
// through it, and that is too wide for fluid to feel its way around; otherwise 0.
double thinness(const Scene&, const Solid&);

// Whether fluid on its sides would feel each other.
bool needsScreen(const Scene&, const Solid&);

// Of a thin block, a plate: which of its shape's planes is one of its faces; of all else -1. The
// opposite one follows it.
int faceOfPlate(const Scene&, const Solid&);

// The particles of a thin solid, once for each of its sides. `faces` say from where each
// particle's face is to the particle, m, in the solid's own axes; `beyond` that it lies outside of
// the solid: what fluid of that side needs for a wall that is thick enough, in the room of the
// fluid that the solid hides from it, and beside the solid, where its shadow falls.
SolidSample sampleSides(const Scene&, const Solid&);

// The boundary particles that a run has of a solid, be it thin or not.
SolidSample boundaryOf(const Scene&, const Solid&);

}  // namespace spindrift
