#pragma once
// Where a solid is that moves otherwise than prescribed, and how it moves: one that floats, or
// that the mouse has dragged.
#include "core/vec.h"

namespace spindrift {

// A turn in space: of length 1.
struct Quaternion {
    double w = 1, x = 0, y = 0, z = 0;
    bool operator==(const Quaternion&) const = default;
};

// Of one that floats: its centre of mass, its velocity, its turn from how it is in the scene, and
// its angular momentum. Of another one: how far it has been dragged away from where its motion has
// it, or had it when the mouse took it, and how fast it is being dragged. Of both, its acceleration
// and that of its turn, as the fluid at its surface feels them.
struct SolidMotion {
    Vec3d centre;    // m from the domain's lower corner; not of one that was dragged
    Vec3d dragged;   // m; not of one that floats
    Vec3d velocity;  // m/s
    Quaternion turn;
    Vec3d angularMomentum;         // kg m²/s
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
