// What happens to an elastic object's particles in a step: bonds, grips, blades, what presses them,
// where they go.
#pragma once

#include "core/vertex.h"
#include "scene/motion.h"
#include "sim/parts/contact.h"
#include "sim/parts/floating_passes.h"
#include "sim/physics/time_step.h"
#include "sim/parts/solid_passes.h"

namespace spindrift::LANES {

// One end's view of a bond; m, N/m. Broken: without stiffness.
struct BondEnd {
    int other;
    real length, stiffness;
};
// What all particles of an object share.
struct Material {
    real damping, breakingStrain;
};
// A part of an object that is held; see MotionKey.
struct GripKeys {
    int first, end;
};

// Particles of all objects in the order of their ids, which are 0, 1, ...
struct ObjectParticles {
    int count;
    VectorField position, velocity, acceleration;  // m, m/s, m/s²
    VectorField home;                              // m, at the start
    ScalarField mass, radius;                      // kg, m
    ScalarField torn;                              // 1: a bond of it is broken
    const int *object, *grip,
        *firstBond;            // grip -1: none holds it; bonds [firstBond[i], firstBond[i + 1])
    const uint8_t* atSurface;  // before anything tore
    BondEnd* bonds;
    int* slot;  // where the surface has it, or -1
};

// Positions for the next sort.
struct FetchPlaces {
    using Index = int;
    ObjectParticles o;
    Particles sorted;
    HD void operator()(int i) const {
        if (sorted.id[i] >= 0) store(sorted.position, i, load(o.position, sorted.id[i]));
    }
};

// The surface as it is now, in the order of the last sort. What tears open is at the surface from
// then on.
struct PlaceSurface {
    using Index = int;
    ObjectParticles o;
    ObjectSurface s;
    HD void operator()(int i) const {
        const int id = s.id[i];
        if (id < 0) return storeEmpty(i);
        o.slot[id] = i;
        store(s.position, i, load(o.position, id)), store(s.velocity, i, load(o.velocity, id)),
            store(s.home, i, load(o.home, id));
        const real torn = load(o.torn, id);
        store(s.radius, i, o.atSurface[id] || torn > 0 ? load(o.radius, id) : outOfReach);
        store(s.torn, i, torn), store(s.object, i, real(o.object[id]));
    }
    // m: one whose reach is negative meets none.
    static constexpr real outOfReach = real(-1e3);
    // It meets none, but lanes compute with it.
    HD void storeEmpty(int i) const {
        const Vector<real> zero{0, 0, 0};
        store(s.velocity, i, zero), store(s.home, i, zero);
        store(s.radius, i, real(1e-6)), store(s.torn, i, real(0)), store(s.object, i, real(0));
    }
};

// On a particle of an object, N, by the floating solid that it is deepest in, -1: by none. That
// feels the opposite.
struct ContactForces {
    VectorField force;
    ScalarField solid;
};
struct SumPresses {
    View v;
    ObjectParticles o;
    ContactForces presses;
    int solid;
    HD void addTo(Wrench& sum, int i) const {
        if (load(presses.solid, i) != real(solid)) return;
        const Vector<real> f = load(presses.force, i),
                           arm = imageOf(v.c, load(o.position, i) - v.solids[solid].centreOfMass);
        const Vec3d force{-double(f.x), -double(f.y), -double(f.z)};
        sum.add({force, cross(Vec3d{arm.x, arm.y, arm.z}, force)});
    }
};

// Forces of bonds, damped springs, of contacts and of floating solids; what is stretched too far
// breaks, and what is cut. Both ends of a bond see the same.
struct StretchBonds {
    using Index = int;
    View v;
    ObjectParticles o;
    VectorField contact;
    const Material* materials;
    const Cut* cuts;
    int cutCount;
    const RigidBody* bodies;  // null: nothing floats
    Springs springs;
    ContactForces presses;
    HD void operator()(int i) const {
        const Vector<real> x = load(o.position, i), u = load(o.velocity, i);
        const Material material = materials[o.object[i]];
        const real mass = load(o.mass, i);
        Vector<real> force{0, 0, 0};
        if (o.slot[i] >= 0) force = load(contact, o.slot[i]);
        if (bodies) force = force + pressed(i, x, u, mass);
        for (int b = o.firstBond[i]; b < o.firstBond[i + 1]; ++b) {
            BondEnd& bond = o.bonds[b];
            if (bond.stiffness <= 0) continue;
            const Vector<real> other = load(o.position, bond.other), r = imageOf(v.c, other - x);
            const real length = squareRoot(dot(r, r)), strain = length / bond.length - 1;
            if ((material.breakingStrain > 0 && strain > material.breakingStrain) ||
                isCut(real(0.5) * (x + other))) {
                bond.stiffness = 0;
                store(o.torn, i, real(1));
                continue;
            }
            const Vector<real> n = (1 / max(length, real(1e-12))) * r;
            const real otherMass = load(o.mass, bond.other);
            const real damping = 2 * material.damping *
                                 squareRoot(bond.stiffness * mass * otherMass / (mass + otherMass));
            const real pull = bond.stiffness * (length - bond.length) +
                              damping * dot(load(o.velocity, bond.other) - u, n);
            force = addScaled(force, pull, n);
        }
        store(o.acceleration, i, addScaled(bodyForce(v.c, gravityNow(v), x), 1 / mass, force));
    }
    // As floating solids press each other.
    HD Vector<real> pressed(int i, Vector<real> x, Vector<real> u, real mass) const {
        const real radius = load(o.radius, i);
        real deepest = 0;
        int by = -1;
        Vector<real> normal{0, 0, 0}, velocity{0, 0, 0}, force{0, 0, 0};
        for (int s = 0; s < v.solidCount; ++s) {
            if (bodies[s].mass <= 0) continue;
            Vector<real> n{0, 0, 0}, own{0, 0, 0};
            const real depth = depthIn(v, v.solids[s], x, radius, n, own);
            if (depth > deepest) deepest = depth, by = s, normal = n, velocity = u - own;
        }
        if (by >= 0) {
            // One after the other: the particle's spring and the solid's, as one of a face full of
            // those that have room there. (A deepest ball is three quarters of a spacing.)
            auto series = [](real a, real b) { return a * b / max(a + b, real(1e-30)); };
            RigidBody both = bodies[by];
            const real across = radius / (both.deepestBall * real(2.0 / 3)),
                       share = min(across * across, real(1));
            both.stiffness = series(mass * springs.rate * springs.rate, share * both.stiffness);
            both.damping = series(2 * springs.damping * mass * springs.rate, share * both.damping);
            force = SumTouches::press(both, deepest, normal, velocity);
        }
        store(presses.force, i, force), store(presses.solid, i, real(by));
        return force;
    }
    // Since the last step began.
    HD bool isCut(Vector<real> middle) const {
        for (int k = 0; k < cutCount; ++k) {
            const Cut& cut = cuts[k];
            const bool now =
                v.state->time - v.state->dt <= cut.time && cut.time < v.state->time + 1e-9;
            if (now && middle.x >= cut.min.x && middle.x <= cut.max.x && middle.y >= cut.min.y &&
                middle.y <= cut.max.y && middle.z >= cut.min.z && middle.z <= cut.max.z)
                return true;
        }
        return false;
    }
};

// Over the particles of objects.
struct SumStops {
    ObjectParticles o;
    VectorField given;  // m/s
    HD void addTo(Stops& sum, int i) const {
        const Vector<real> u = load(given, i);
        if (dot(u, u) == 0) return;
        const double m = double(load(o.mass, i));
        sum.add({{m * u.x, m * u.y, m * u.z}, m});
    }
};

// v += a dt, x += v dt; what is held goes where its grip is. The box and solids that don't float
// keep them inside and out.
struct MoveObjects {
    using Index = int;
    View v;
    ObjectParticles o;
    const GripKeys* grips;
    const MotionKey* keys;
    const RigidBody* bodies;  // null: nothing floats
    int dragged;              // the solid that the mouse holds, -1: none
    VectorField given;        // m/s, by that; written while there is one
    HD void operator()(int i) const {
        if (dragged >= 0) store(given, i, Vector<real>{0, 0, 0});
        if (o.grip[i] >= 0) return follow(i, grips[o.grip[i]]);
        const real dt = real(v.state->dt), radius = load(o.radius, i);
        Vector<real> u = addScaled(load(o.velocity, i), dt, load(o.acceleration, i));
        Vector<real> x = addScaled(load(o.position, i), dt, u);
        const StepParameters& c = v.c;
        c.period.x > 0 ? wrap(x.x, c.period.x)
                       : stop(x.x, u.x, c.low.x + radius, c.high.x - radius);
        c.period.y > 0 ? wrap(x.y, c.period.y)
                       : stop(x.y, u.y, c.low.y + radius, c.high.y - radius);
        if (c.dimensions == 3)
            c.period.z > 0 ? wrap(x.z, c.period.z)
                           : stop(x.z, u.z, c.low.z + radius, c.high.z - radius);
        else
            u.z = 0, x.z = load(o.position, i).z;
        for (int s = 0; s < v.solidCount; ++s)
            if (!bodies || bodies[s].mass <= 0) {
                const Vector<real> before = u;
                leave(v.solids[s], radius, x, u);
                if (s == dragged) store(given, i, u - before);
            }
        store(o.velocity, i, u), store(o.position, i, x);
    }
    HD void follow(int i, GripKeys g) const {
        const KeyedMotion m = motionAt(keys, g.first, g.end, v.state->time);
        const Vector<real> home = load(o.home, i);
        store(o.velocity, i,
              Vector<real>{real(m.velocity.x), real(m.velocity.y), real(m.velocity.z)});
        store(o.position, i,
              Vector<real>{home.x + real(m.offset.x), home.y + real(m.offset.y),
                           home.z + real(m.offset.z)});
    }
    HD static void wrap(real& x, real period) { x -= period * roundDown(x / period); }
    HD static void stop(real& x, real& u, real low, real high) {
        if (x < low) x = low, u = max(u, real(0));
        if (x > high) x = high, u = min(u, real(0));
    }
    // Stays a radius away from a solid, and loses what speed it has towards it.
    HD void leave(const SolidState& s, real radius, Vector<real>& x, Vector<real>& u) const {
        Vector<real> n{0, 0, 0}, own{0, 0, 0};
        const real depth = depthIn(v, s, x, radius, n, own);
        if (depth <= 0) return;
        const real towards = min(dot(u - own, n), real(0));
        x = addScaled(x, depth, n);
        u = subtractScaled(u, towards, n);
    }
};

// What another engine wants of particles: until when, s, they are to be where it said, and how
// fast the fastest has to go for it, m/s; nothing where there is none. In memory of the device, so
// that recorded steps go on when it has spoken.
struct Drive {
    double arrival = -1;
    real speed = 0;
};

// Particles on their way to where that wants them, and what they feel until then, N s.
struct FollowDriver {
    using Index = int;
    const StepState* state;
    ObjectParticles o;
    VectorField contact, target, impulse;
    const Drive* drive;
    HD void operator()(int i) const {
        const double left =
            drive->arrival - (state->time - state->dt);  // the clock is at the step's end
        const real share = left > state->dt ? real(state->dt / left) : real(1);
        const Vector<real> x = load(o.position, i);
        store(o.position, i, addScaled(x, share, load(target, i) - x));
        if (o.slot[i] >= 0)
            store(impulse, i,
                  addScaled(load(impulse, i), real(state->dt), load(contact, o.slot[i])));
    }
};

// The fastest of them at the end of the next step, m/s squared.
struct FindObjectSpeed {
    ObjectParticles o;
    const StepState* state;
    const Drive* drive;  // has them go as fast, whatever velocities it says
    HD void addTo(Extremes& e, int i) const {
        const Vector<real> u = load(o.velocity, i), a = load(o.acceleration, i);
        const real speed = squareRoot(dot(u, u)) +
                           (o.grip[i] < 0 ? real(state->dt) * squareRoot(dot(a, a)) : real(0));
        e.add({float(max(speed * speed, drive->speed * drive->speed)), 0});
    }
};
struct TakeFaster {
    using Index = int;
    Extremes *fluid, *objects;
    HD void operator()(int) const { fluid->add(*objects); }
};

// After fluid and boundary particles: one value for all, by which they are told from those, and
// their size in the fluid's.
struct WriteObjectVertices {
    using Index = int;
    ObjectParticles o;
    Vertex* out;
    real fluidRadius;
    HD void operator()(int i) const {
        const Vector<real> x = load(o.position, i);
        out[i] = {float(x.x), float(x.y), float(x.z), 2 + float(load(o.radius, i) / fluidRadius)};
    }
};

}  // namespace spindrift::LANES
