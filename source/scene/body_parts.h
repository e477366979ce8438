#pragma once
// Bodies and what bounds them, axis by axis: where layers of a lattice have to begin and end.
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace spindrift {

struct Interval {
    double low, high;  // m from the domain's lower corner
    double length() const { return high - low; }
};
Interval extentAlong(const Scene&, const Form&, int axis);

// Nearly a whole number of layers is meant to be one: scenes are written in decimals.
bool isWhole(double layers);
// What a length has over of whole layers, as many as have room in it.
double overFull(double layers);

// Whether layers are to meet a solid's faces: those of a block that stays where it is.
bool isFace(const Solid&);
bool isBox(const Form&);  // a block or a wedge
// Whether a shape ends in planes across this axis: boxes, and cylinders along their own.
bool hasFlatEnds(const Form&, int axis);

// Whether two shapes' boxes come nearer than half a spacing along all axes but `except`.
bool meet(const Scene&, const Form&, const Form&, int except = -1);
// Whether a solid takes all of a body's cross-section where it stands.
bool coversAcross(const Scene&, const Form& solid, const Form& body, int axis);

// Whether the lattice is fitted to the bodies: neither in the classic formulation, which has walls
// of its own, nor where particles have a mass that the scene says.
bool isFitted(const Scene&);

// What solids that stand across all of a body leave of it: bodies that end at their faces.
struct BodyPart {
    Body body;
    size_t of;  // which of the scene's
};
std::vector<BodyPart> partsOf(const Scene&);

// Along an axis, of a box: where its first cell begins, m as in the scene, how many it has, and how
// long they are, m: a step of the lattice, but where a body between two ends has no use for that.
// Bodies that touch share the lattice's planes.
struct Layers {
    double low = 0;
    int64_t count = 0;
    double step = 0;
};
Layers layersOf(const Scene&, const Body&, int axis, double step);

}  // namespace spindrift
