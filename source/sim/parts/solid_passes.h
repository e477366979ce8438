// The passes of solids: where they are, what their particles know of them, and what fluid does to
// them.
#pragma once

#include "scene/motion.h"
#include "sim/neighbours/neighbours.h"
#include "sim/parts/rigid.h"

namespace spindrift::LANES {

// As the last one of keys [first, end) before `time` says. m and radians, and those per second and
// per second squared.
struct KeyedMotion {
    Vec3d offset, velocity, acceleration;
    double turn, spin, spinRate;
};
HD inline KeyedMotion motionAt(const MotionKey* keys, int first, int end, double time) {
    int next = first;
    for (int after = end; next < after;) {
        const int middle = (next + after) / 2;
        keys[middle].time <= time ? next = middle + 1 : after = middle;
    }
    if (next == first) return {keys[first].offset, {}, {}, keys[first].turn, 0, 0};
    const MotionKey& k = keys[next - 1];
    const double s = time - k.time, half = s / 2, third = s / 3;
    return {k.offset + s * (k.velocity + half * (k.acceleration + third * k.jerk)),
            k.velocity + s * (k.acceleration + half * k.jerk),
            k.acceleration + s * k.jerk,
            k.turn + s * (k.spin + half * (k.spinRate + third * k.spinJerk)),
            k.spin + s * (k.spinRate + half * k.spinJerk),
            k.spinRate + s * k.spinJerk};
}

// Where a solid is now and how it moves, by its keys. What floats or was dragged is where its
// motion says.
struct MoveSolids {
    using Index = int;
    SolidState* solids;
    const MotionKey* keys;
    const StepState* state;
    double stepsBack;  // from the clock's time
    double ahead;      // steps, from the motions
    const RigidBody* bodies;
    const SolidMotion* motions;
    HD void operator()(int i) const {
        SolidState& s = solids[i];
        if (bodies[i].mass > 0) return placeFloating(s, bodies[i], motions[i], ahead * state->dt);
        const double left = motions[i].left, now = state->time - stepsBack * state->dt;
        KeyedMotion m = motionAt(keys, s.firstKey, s.endKey, left >= 0 && left < now ? left : now);
        if (left >= 0) m.velocity = m.acceleration = {0, 0, 0}, m.spin = m.spinRate = 0;
        s.middle = s.home + Vector<real>{real(m.offset.x), real(m.offset.y), real(m.offset.z)};
        s.velocity = Vector<real>{real(m.velocity.x), real(m.velocity.y), real(m.velocity.z)};
        s.acceleration =
            Vector<real>{real(m.acceleration.x), real(m.acceleration.y), real(m.acceleration.z)};
        turn(s, m);
        addDragged(s, motions[i], ahead * state->dt);
    }
    HD static void addDragged(SolidState& s, const SolidMotion& m, double ahead) {
        const Vec3d away = m.dragged + ahead * m.velocity;
        s.middle = s.middle + Vector<real>{real(away.x), real(away.y), real(away.z)};
        s.velocity =
            s.velocity + Vector<real>{real(m.velocity.x), real(m.velocity.y), real(m.velocity.z)};
        s.acceleration =
            s.acceleration +
            Vector<real>{real(m.acceleration.x), real(m.acceleration.y), real(m.acceleration.z)};
        s.speed = real(sqrt(dot(m.velocity, m.velocity)));
    }
    HD static void turn(SolidState& s, const KeyedMotion& m) {
        const int k = s.spinAxis, y = (k + 1) % 3, z = (k + 2) % 3;
        const real cosine = real(cos(m.turn)), sine = real(sin(m.turn));
        auto set = [](Vector<real>& v, int component, real value) {
            (component == 0 ? v.x : component == 1 ? v.y : v.z) = value;
        };
        for (int a = 0; a < 3; ++a) s.axis[a] = {0, 0, 0};
        s.spin = s.spinRate = {0, 0, 0};
        set(s.axis[k], k, 1), set(s.spin, k, real(m.spin)), set(s.spinRate, k, real(m.spinRate));
        set(s.axis[y], y, cosine), set(s.axis[y], z, sine);
        set(s.axis[z], y, -sine), set(s.axis[z], z, cosine);
    }
};

// A solid's pose becomes the one from which the step's way is seen.
struct RememberPose {
    using Index = int;
    SolidState* solids;
    HD void operator()(int i) const {
        SolidState& s = solids[i];
        s.middleBefore = s.middle;
        for (int k = 0; k < 3; ++k) s.axisBefore[k] = s.axis[k];
    }
};
// What lies between that and its pose now is a rotation; whole turns are known by its spin alone.
struct MeasureTurn {
    using Index = int;
    SolidState* solids;
    const StepState* state;
    HD void operator()(int i) const {
        SolidState& s = solids[i];
        auto m = [&](int row, int column)
                     LANE_CALL { return double(dot(s.axisBefore[row], s.axis[column])); };
        double axis[3] = {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
        double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        const double angle = atan2(length, m(0, 0) + m(1, 1) + m(2, 2) - 1),
                     pi = 3.14159265358979323846;
        const double asked[3] = {state->dt * double(dot(s.spin, s.axis[0])),
                                 state->dt * double(dot(s.spin, s.axis[1])),
                                 state->dt * double(dot(s.spin, s.axis[2]))};
        if (length < 1e-5) {  // by nearly nothing, or by half a turn
            for (int k = 0; k < 3; ++k) axis[k] = asked[k];
            length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        }
        s.turn = {0, 0, 0};
        if (!(length > 0)) return;
        const double along =
            (asked[0] * axis[0] + asked[1] * axis[1] + asked[2] * axis[2]) / length;
        const double all = (angle + 2 * pi * floor((along - angle) / (2 * pi) + 0.5)) / length;
        s.turn = {real(all * axis[0]), real(all * axis[1]), real(all * axis[2])};
    }
};

// What boundary particles have from the start, in the order of their ids. With solids only: the
// domain's walls are where they are.
struct WallsAtHome {
    int firstId;
    const int* solid;      // -1: of the domain's walls
    VectorField position;  // m
    ScalarField mass;      // 0: follows from neighbours
    VectorField area;      // m^2 / kg of a fluid particle, of the surface of what floats
    Vector<real> size;     // m, the domain's
    VectorField face;      // m, of thin solids: from a particle's face to it, in their own axes
    HD int solidOf(int id) const { return solid ? solid[id - firstId] : -1; }
};

// Boundary particles go with their solids. Their order is that of the last sort.
struct PlaceWalls {
    using Index = int;
    View v;
    WallsAtHome home;
    HD void operator()(int i) const {
        if (v.walls.id[i] < 0) return;
        const int k = v.walls.id[i] - home.firstId, solid = home.solidOf(v.walls.id[i]);
        if (home.mass.data)
            if (const real mass = load(home.mass, k); mass > 0) store(v.walls.mass, i, mass);
        solid < 0 ? placeOfDomain(i) : placeOfSolid(i, k, v.solids[solid]);
    }
    HD void placeOfDomain(int i) const {
        const Vector<real> x = load(v.walls.position, i);
        auto beyond = [](real at, real end) LANE_CALL { return at - max(min(at, end), real(0)); };
        const Vector<real> out{beyond(x.x, home.size.x), beyond(x.y, home.size.y),
                               beyond(x.z, home.size.z)};
        // In an edge, of the face that lets fluid slip the least.
        real slip = real(1e9);
        auto take = [&](real out, real below, real above) LANE_CALL {
            if (out != 0) slip = min(slip, out < 0 ? below : above);
        };
        take(out.x, v.c.slipBelow.x, v.c.slipAbove.x);
        take(out.y, v.c.slipBelow.y, v.c.slipAbove.y);
        take(out.z, v.c.slipBelow.z, v.c.slipAbove.z);
        finish(i, out, wallVelocity(v.c, x), {0, 0, 0}, real(-1e-30) - slip);
    }
    HD void placeOfSolid(int i, int k, const SolidState& s) const {
        const Vector<real> own = load(home.position, k) - s.home, arm = turned(s, own);
        Vector<real> normal{0, 0, 0};
        const real distance = surface(s, own, normal);
        store(v.walls.position, i, intoDomain(v.c, s.middle + arm));
        finish(i, distance * turned(s, normal), s.velocity + cross(s.spin, arm),
               accelerationAt(s, arm), s.slip);
        if (s.grace > 0 && v.walls.outward.data)
            store(v.walls.outward, i, turned(s, load(home.face, k)));
    }
    // Fluid that sticks to the surface turns with it; other fluid lets it slide past.
    HD Vector<real> accelerationAt(const SolidState& s, Vector<real> arm) const {
        const Vector<real> a = s.acceleration + cross(s.spinRate, arm);
        const bool sticks = s.slip == 0 && v.c.isViscous;
        return sticks ? a + cross(s.spin, cross(s.spin, arm)) : a;
    }
    HD void finish(int i, Vector<real> outward, Vector<real> velocity, Vector<real> acceleration,
                   real slip) const {
        if (v.walls.slip.data) store(v.walls.slip, i, slip);
        if (v.walls.outward.data) store(v.walls.outward, i, outward);
        if (v.walls.ownVelocity.data) store(v.walls.ownVelocity, i, velocity);
        if (v.walls.ownAcceleration.data) store(v.walls.ownAcceleration, i, acceleration);
    }
};

// The velocity of what floats is its particles' as soon as it changes.
struct TellVelocity {
    using Index = int;
    View v;
    WallsAtHome home;
    const RigidBody* bodies;
    const SolidMotion* motions;
    HD void operator()(int i) const {
        if (v.walls.id[i] < 0) return;
        const int k = v.walls.id[i] - home.firstId, solid = home.solidOf(v.walls.id[i]);
        if (solid < 0 || bodies[solid].mass <= 0) return;
        const SolidState& s = v.solids[solid];
        const Vector<real> arm =
            turned(s, load(home.position, k) - s.home) + (s.middle - s.centreOfMass);
        const Vec3d velocity =
            motions[solid].velocity + cross(spinOf(bodies[solid], motions[solid]),
                                            Vec3d{double(arm.x), double(arm.y), double(arm.z)});
        store(v.walls.ownVelocity, i,
              Vector<real>{real(velocity.x), real(velocity.y), real(velocity.z)});
    }
};

// Masses that follow from neighbours do so at the start; a solid that comes near a wall later
// doesn't change them.
struct KeepWallMass {
    using Index = int;
    Particles walls;
    WallsAtHome home;
    HD void operator()(int i) const {
        if (walls.id[i] < 0) return;
        const int k = walls.id[i] - home.firstId;
        if (load(home.mass, k) == 0) store(home.mass, k, load(walls.mass, i));
    }
};

}  // namespace spindrift::LANES
