#pragma once
// What is seen inside the fluid: a quantity on a plane, and arrows of its velocity.
#include "core/vertex.h"
#include "measure/interpolate.h"
#include "render/lines.h"
#include "render/slice.h"
#include "scene/scene.h"

#include <vector>

namespace spindrift {

// The plane of a scene's view.slice, with what `fluid` has there: the weighted mean of the values
// of particles within the support radius, which walls mirror, and the share of what is around that
// particles fill. `sees`: past thin solids; places as those of vertices.
SliceField sliceOf(const Scene&, const std::vector<Vertex>& fluid, const Sees& sees = {});

// The same plane's place along its axis, m in world coordinates.
float slicePlace(const Scene&);

// In cells of a grid, or of one on the slice's plane, of which enough is filled: the mean velocity
// of the fluid there, m/s, seen from the cell's middle. What is clipped is left out.
struct CellVelocity {
    Vec3 middle, velocity;
};
std::vector<CellVelocity> velocitiesOf(const Scene&, const std::vector<Particle>&);
// m, a cell's side.
float arrowStep(const Scene&);

// The box of a scene's view.clip, m; sides at 0 or 1 are beyond all places.
struct ClipBox {
    Vec3 low, high;
    bool holds(Vec3) const;
};
ClipBox clipBox(const Scene&);

}  // namespace spindrift
