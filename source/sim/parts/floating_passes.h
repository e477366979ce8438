// The passes of what floats: where solids touch each other and the domain's box, and how they
// move.
#pragma once

#include "sim/parts/collisions.h"
#include "sim/parts/solid_load_passes.h"

namespace spindrift::LANES {

// Where a solid touches, it is made of balls: its outermost boundary particles, as large as they
// are deep in it. They press like damped springs and rub (Cundall & Strack 1979); a face full of
// them is as stiff as the step can bear, and overlaps by about a thousandth of a spacing under its
// weight.
struct Wrench {
    Vec3d force, torque;
    HD_OUT void add(const Wrench& o) { force = force + o.force, torque = torque + o.torque; }
};

// What presses: a mass m on such a spring, k = m rate^2, swings at `rate` rad/s and is damped by
// that share of the critical.
struct Springs {
    real rate, damping;
};

// m, of a ball in a solid; with the direction out of it and the solid's own velocity there.
HD inline real depthIn(const View& v, const SolidState& s, Vector<real> x, real radius,
                       Vector<real>& n, Vector<real>& velocity) {
    const Vector<real> arm = imageOf(v.c, x - s.middle);
    if (dot(arm, arm) > (s.reach + radius) * (s.reach + radius)) return real(-1);
    const real depth =
        radius -
        surface(s, Vector<real>{dot(arm, s.axis[0]), dot(arm, s.axis[1]), dot(arm, s.axis[2])}, n);
    n = turned(s, n), velocity = s.velocity + cross(s.spin, arm);
    return depth;
}

// Sums what `solid` feels where its balls touch walls and other solids, and where other solids'
// balls touch it.
struct SumTouches {
    View v;
    WallsAtHome home;
    const RigidBody* bodies;
    int solid;
    struct Ball {
        Vector<real> position, velocity;
        real radius;
    };

    HD void addTo(Wrench& sum, int i) const {
        const int owner = v.walls.id[i] < 0 ? -1 : home.solidOf(v.walls.id[i]);
        if (owner < 0) return;
        const SolidState& own = v.solids[owner];
        const int k = v.walls.id[i] - home.firstId;
        Vector<real> at = load(home.position, k) - own.home, normal{0, 0, 0};
        real depth = -surface(own, at, normal);
        Vector<real> place = load(v.walls.position, i);
        if (own.grace > 0) {  // each face has its own, and has them on itself where it is too thin
            const Vector<real> face = load(home.face, k);
            if (dot(face, face) > bodies[owner].deepestBall * bodies[owner].deepestBall) return;
            if (depth < 0)
                depth = -surface(own, at - face, normal), place = place - turned(own, face);
            if (depth < real(-0.1) * bodies[owner].deepestBall) return;
            depth = max(depth, real(0));
        }
        if (depth > bodies[owner].deepestBall) return;
        const Ball ball{place, load(v.walls.ownVelocity, i), depth};
        Vector<real> force{0, 0, 0};
        if (owner != solid)
            force = real(-1) * pressOn(ball, owner, solid);
        else {
            touchBox(ball, force);
            for (int other = 0; other < v.solidCount; ++other)
                if (other != solid) force = force + pressOn(ball, solid, other);
        }
        const Vec3d f{force.x, force.y, force.z};
        const Vector<real> arm = imageOf(v.c, ball.position - v.solids[solid].centreOfMass);
        sum.add({f, cross(Vec3d{arm.x, arm.y, arm.z}, f)});
    }
    HD void touchBox(const Ball& b, Vector<real>& force) const {
        const RigidBody& body = bodies[solid];
        auto side = [&](real overlap, Vector<real> n) {
            force = force + press(body, overlap, n, b.velocity - wallVelocity(v.c, b.position));
        };
        const StepParameters& c = v.c;
        if (c.period.x <= 0)
            side(b.radius - (b.position.x - c.low.x), {1, 0, 0}),
                side(b.radius - (c.high.x - b.position.x), {-1, 0, 0});
        if (c.period.y <= 0)
            side(b.radius - (b.position.y - c.low.y), {0, 1, 0}),
                side(b.radius - (c.high.y - b.position.y), {0, -1, 0});
        if (c.period.z <= 0 && c.dimensions == 3)
            side(b.radius - (b.position.z - c.low.z), {0, 0, 1}),
                side(b.radius - (c.high.z - b.position.z), {0, 0, -1});
    }
    HD Vector<real> pressOn(const Ball& b, int owner, int other) const {
        const SolidState& s = v.solids[other];
        Vector<real> n{0, 0, 0}, own{0, 0, 0};
        const real depth = depthIn(v, s, b.position, b.radius, n, own);
        if (depth <= 0) return {0, 0, 0};
        const RigidBody &mine = bodies[owner], &theirs = bodies[other];
        const RigidBody& softer = mine.stiffness < theirs.stiffness ? mine : theirs;
        RigidBody both = softer;
        both.friction = min(mine.friction, theirs.friction);
        return press(both, depth, n, b.velocity - own);
    }
    HD static Vector<real> press(const RigidBody& b, real overlap, Vector<real> n,
                                 Vector<real> velocity) {
        if (overlap <= 0) return {0, 0, 0};
        const real apart = dot(velocity, n),
                   normal = max(b.stiffness * overlap - b.damping * apart, real(0));
        const Vector<real> along = velocity - apart * n;
        const real slip = squareRoot(dot(along, along));
        return addScaled(normal * n, -min(b.damping, b.friction * normal / max(slip, real(1e-12))),
                         along);
    }
};

struct AddTouch {
    using Index = int;
    const Wrench* one;
    Wrench* sum;
    HD void operator()(int) const { sum->add(*one); }
};

// The momentum that particles lost where a solid stopped them, kg m/s, and the angular momentum
// about its centre.
struct SumBounces {
    View v;
    Bounces bounces;
    real mass;  // kg, of a fluid particle
    int solid;
    HD void addTo(Wrench& sum, int i) const {
        if (v.fluid.id[i] < 0 || load(bounces.solid, i) != real(solid)) return;
        const Vector<real> change = load(bounces.change, i),
                           arm = imageOf(v.c,
                                         load(v.fluid.position, i) - v.solids[solid].centreOfMass);
        const Vec3d lost =
            -double(mass * massRatio(v.fluid, i)) * Vec3d{change.x, change.y, change.z};
        sum.add({lost, cross(Vec3d{arm.x, arm.y, arm.z}, lost)});
    }
};
struct TakeMomentum {
    using Index = int;
    const RigidBody* bodies;
    const Wrench* given;
    SolidMotion* motions;
    int dimensions;
    HD void operator()(int s) const {
        if (bodies[s].mass <= 0) return;
        Wrench t = given[s];
        if (dimensions == 2) t.force.z = t.torque.x = t.torque.y = 0;
        motions[s].velocity = motions[s].velocity + (1 / bodies[s].mass) * t.force;
        motions[s].angularMomentum = motions[s].angularMomentum + t.torque;
    }
};

// How much room a solid that the mouse drags has. The last layer of fluid at a wall has no way out
// between that and what comes nearer, and would be crushed.
struct FindRoom {
    View v;
    WallsAtHome home;
    const RigidBody* bodies;
    int solid;
    static constexpr real time = real(0.05);  // s, for the rest of the way
    HD void addTo(Room& sum, int i) const {
        if (v.walls.id[i] < 0 || home.solidOf(v.walls.id[i]) != solid) return;
        const SolidState& s = v.solids[solid];
        const real spacing = bodies[solid].deepestBall / real(0.75);
        Vector<real> own = load(home.position, v.walls.id[i] - home.firstId) - s.home, n{0, 0, 0};
        const real left = max(-surface(s, own, n), real(0)) + spacing;
        const Vector<real> arm = turned(s, own);
        Room room;
        const bool isPlane = s.planes == 1;  // which goes on behind the box
        if (!isPlane) besideBox(room, s, arm, left);
        for (int other = 0; other < v.solidCount; ++other)
            if (other != solid && bodies[other].mass <= 0)
                beside(room, v.solids[other], s, arm, left);
        sum.add(room);
    }
    // One that turns on and on has to have room for all of its circle.
    HD void besideBox(Room& room, const SolidState& s, Vector<real> arm, real left) const {
        const real spin = squareRoot(dot(s.spin, s.spin));
        const Vector<real> axis = spin > 0 ? (1 / spin) * s.spin : Vector<real>{0, 0, 0};
        const Vector<real> along = spin > 0 ? dot(arm, axis) * axis : arm, circle = arm - along;
        const real radius = squareRoot(dot(circle, circle));
        auto side = [&](int k, real middle, real a, real tilt, real low, real high, real period) {
            if (period > 0 || (k == 2 && v.c.dimensions == 2)) return;
            const real reach = radius * squareRoot(max(1 - tilt * tilt, real(0)));
            room.low[k] = middle + a - reach - low - left;
            room.high[k] = high - middle - a - reach - left;
        };
        const StepParameters& c = v.c;
        side(0, s.middle.x, along.x, axis.x, c.low.x, c.high.x, c.period.x);
        side(1, s.middle.y, along.y, axis.y, c.low.y, c.high.y, c.period.y);
        side(2, s.middle.z, along.z, axis.z, c.low.z, c.high.z, c.period.z);
    }
    HD void beside(Room& room, const SolidState& other, const SolidState& s, Vector<real> arm,
                   real left) const {
        Vector<real> n{0, 0, 0}, velocity{0, 0, 0};
        const real seen = left + real(0.1) * v.c.soundSpeed * time;
        const real depth = depthIn(v, other, s.middle + arm, seen, n, velocity);
        if (depth <= 0) return;
        const real free = max(seen - depth - left, real(0));
        const real least = dot(velocity - cross(s.spin, arm), n) - free / time;
        if (least > room.least)
            room.least = least, room.away[0] = n.x, room.away[1] = n.y, room.away[2] = n.z;
    }
};

// The mouse's hand on a solid that doesn't float: the mass of fluid in its place, kg, 0: nothing
// stops it; what it gave to objects in the last step; and how much room it has.
struct Hand {
    double mass;
    const Stops* stops;
    const Room* room;
};

// v += F / m dt, x += v dt; the same of angular momentum and turn. A solid that the mouse holds
// goes where it is wanted: one that floats by a damped spring, another one by itself, no faster
// than a tenth of the speed of sound. Both hands are as strong. What fluid presses with beyond that
// strength slows the solid, or fluid between it and a wall would be crushed until it bursts.
// Objects that the solid runs into slow it, as one body with those of their particles that it
// stops.
struct MoveFloating {
    using Index = int;
    View v;
    const RigidBody* bodies;
    SolidMotion* motions;
    const SolidLoad* loads;
    const Wrench* touches;
    double fluidMass;    // kg, of a particle
    int held;            // by the mouse; -1: none
    const Vec3* target;  // m, where it wants that, relative to the domain's lower corner
    Hand hand;
    double kick, drift;                      // shares of the step
    static constexpr double strongest = 60;  // m/s², of the solid that is held
    HD void operator()(int s) const { bodies[s].mass > 0 ? moveFloating(s) : drag(s); }
    HD void moveFloating(int s) const {
        const RigidBody& body = bodies[s];
        SolidMotion& m = motions[s];
        const double dt = v.state->dt;
        Wrench w = wrenchOn(s);
        if (held == s) pull(w, body, m, v.solids[s]);
        if (v.c.dimensions == 2) w.force.z = w.torque.x = w.torque.y = 0;
        const Vec3d spin = spinOf(body, m),
                    spinRate = turning(body, m, w.torque - cross(spin, m.angularMomentum));
        m.acceleration = m.acceleration + body.told * ((1 / body.mass) * w.force - m.acceleration);
        m.spinRate = m.spinRate + body.told * (spinRate - m.spinRate);
        m.velocity = m.velocity + (kick * dt / body.mass) * w.force;
        m.angularMomentum = m.angularMomentum + (kick * dt) * w.torque;
        m.centre = wrapped(m.centre + (drift * dt) * m.velocity);
        turnBy(m.turn, (drift * dt) * spinOf(body, m));
    }
    // N
    HD Vec3d fluidOn(int s) const {
        const SolidLoad& load = loads[s];
        auto sum = [&](int k) { return fluidMass * (load.pressure[k] + load.other[k]); };
        return {sum(0), sum(1), sum(2)};
    }
    HD Wrench wrenchOn(int s) const {
        const SolidLoad& load = loads[s];
        const SolidState& state = v.solids[s];
        const Vector<real> pull = bodyForce(v.c, gravityNow(v), state.centreOfMass),
                           out = state.middle - state.centreOfMass;
        const Vec3d fluid = fluidOn(s), torque{load.torque[0], load.torque[1], load.torque[2]};
        return {fluid + touches[s].force + bodies[s].mass * Vec3d{pull.x, pull.y, pull.z},
                fluidMass * torque + cross(Vec3d{out.x, out.y, out.z}, fluid) + touches[s].torque};
    }
    HD void pull(Wrench& w, const RigidBody& body, const SolidMotion& m,
                 const SolidState& s) const {
        const double rate = 15;  // 1/s
        const Vec3d there{target->x, target->y, target->z};
        const Vec3d wanted = (rate * rate) * (there - Vec3d{s.middle.x, s.middle.y, s.middle.z}) -
                             (2 * rate) * m.velocity;
        const double size = sqrt(dot(wanted, wanted));
        w.force = w.force + (body.mass * (size > strongest ? strongest / size : 1.0)) * wanted;
        w.torque = w.torque - rate * m.angularMomentum;
    }
    HD void drag(int s) const {
        const double time = double(FindRoom::time), fastest = 0.1 * double(v.c.soundSpeed),
                     dt = v.state->dt;  // s, m/s
        SolidMotion& m = motions[s];
        const Vec3d before = m.velocity;
        m.velocity = {0, 0, 0};
        if (held != s) {
            m.acceleration = {0, 0, 0};
            return;
        }
        if (m.left < 0 && !v.solids[s].steady) m.left = v.state->time - dt;
        const Vector<real> at = v.solids[s].middle;
        const Vec3d way = Vec3d{target->x, target->y, target->z} - Vec3d{at.x, at.y, at.z};
        const double far = sqrt(dot(way, way)), stops = sqrt(strongest * far);
        double speed = far / (dt > time ? dt : time);
        if (speed > fastest) speed = fastest;
        if (hand.mass > 0 && speed > stops) speed = stops;  // it has to be slowed down again
        m.velocity = (far > 0 ? speed / far : 0) * way;
        if (hand.mass > 0)
            m.velocity = hand.room->slowed(pushed(before, m.velocity, fluidOn(s)), time,
                                           double(bodies[s].deepestBall) / 0.75);
        if (v.c.dimensions == 2) m.velocity.z = 0;
        const Vec3d change = (1 / (kick * dt)) * (m.velocity - before);
        m.acceleration = m.acceleration + 0.25 * (change - m.acceleration);
        m.dragged = m.dragged + (drift * dt) * m.velocity;
    }
    // From one velocity towards another, against the fluid, N, and the objects in its way.
    HD Vec3d pushed(Vec3d before, Vec3d wanted, Vec3d fluid) const {
        const double* given = hand.stops->momentum;
        const double all = hand.mass + hand.stops->mass,
                     most = strongest * hand.mass / all * kick * v.state->dt;
        const Vec3d lost = Vec3d{given[0], given[1], given[2]} - v.state->dt * fluid,
                    slowed = before - (kick / all) * lost, change = wanted - slowed;
        const double size = sqrt(dot(change, change));
        return slowed + (size > most ? most / size : 1.0) * change;
    }
    HD Vec3d wrapped(Vec3d x) const {
        const StepParameters& c = v.c;
        return {x.x - c.period.x * floor(x.x * c.inversePeriod.x),
                x.y - c.period.y * floor(x.y * c.inversePeriod.y),
                x.z - c.period.z * floor(x.z * c.inversePeriod.z)};
    }
};

// What the mouse no longer holds stands still, but for what floats.
struct LetGo {
    using Index = int;
    const RigidBody* bodies;
    SolidMotion* motions;
    HD void operator()(int s) const {
        if (bodies[s].mass <= 0) motions[s].velocity = motions[s].acceleration = {0, 0, 0};
    }
};

}  // namespace spindrift::LANES
