#pragma once
// Where a solid is that moves otherwise than prescribed, and how it moves: one that floats, or
// that the mouse has dragged.
#include "core/vec.h"

namespace spindrift {

// Of one that floats: its centre of mass, m from the domain's lower corner, its velocity, its turn
// from its place in the scene, and its angular momentum, kg m^2/s. Of another one: how far it has
// been dragged away from where its motion has it, or had it when the mouse took it, and how fast it
// is being dragged. Of both, its acceleration and that of its turn, as the fluid at its surface
// feels them.
struct SolidMotion {
    Vec3d place, velocity;
    double turn[4] = {1, 0, 0, 0};  // quaternion, real part first
    Vec3d angularMomentum;
    Vec3d acceleration, spinRate;  // m/s², rad/s^2
    double left =
        -1;  // s, when the mouse took it from its keyframes, for good; -1: it follows them
};

// A solid held by the mouse, which wants its middle at `target`, m, world coordinates.
struct Hold {
    int solid = -1;
    Vec3 target;
};

}  // namespace spindrift
