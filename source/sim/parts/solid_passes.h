// The passes of solids: where they are, what their particles know of them, and what fluid does to
// them.
#pragma once

#include "scene/motion.h"
#include "sim/physics/step_parameters.h"
#include "sim/neighbours/neighbours.h"
#include "sim/parts/rigid.h"
#include "sim/physics/terms.h"

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
        const Vec3d place = m.place + ahead * m.velocity;
        s.middle = s.middle + Vector<real>{real(place.x), real(place.y), real(place.z)};
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
    // Whether a cluster has any particle of a solid.
    HD bool hasSolid(const Particles& walls, int cluster) const {
        for (int k = 0; k < clusterSize; ++k)
            if (const int id = walls.id[cluster * clusterSize + k]; id >= 0 && solidOf(id) >= 0)
                return true;
        return false;
    }
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
        const bool sticks = s.slip == 0 && v.c.laminar > 0;
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

// What fluid does to solids' particles: the terms of ComputeForces with their signs changed. m/s²
// per fluid particle's mass; of pressure, and of the others.
template <class Kernel, class Terms> struct ComputeWallLoads;
template <class Kernel, class... Terms> struct ComputeWallLoads<Kernel, TermList<Terms...>> {
    using Index = ICluster;
    using R = Real<ICluster>;
    static constexpr unsigned needs = TermList<Terms...>::needs;
    View v;
    VectorField pressure, other;
    // What pressure would be if p / rho^2 of both added up to 1, and to that of fluid at rest where
    // it is none at the boundary particle.
    VectorField seen, seenAtRest;
    WallsAtHome home;
    HD void operator()(ICluster b) const {
        if (!home.hasSolid(v.walls, firstOf(b) / clusterSize)) return;
        Wall<R> wall = loadWall<needs>(v.walls, b);
        Acceleration<R> a{};
        const Vector<R> x = load(v.walls.position, b);
        const Vector<R> pull = R(1 / v.c.restDensity) *
                               (bodyForce(v.c, gravityNow(v), x) - ownAcceleration(v.walls, b));
        wall.pull = pull;
        Vector<R> seen{0, 0, 0}, atRest{0, 0, 0};
        forNeighbours<Lists::All>(v, v.fluidNearWalls, b, x, [&](auto p, JCluster j) LANE_CALL {
            p.r = R(-1) * p.r;
            const Vector<R> slope = slopeOf<Kernel>(v.c, p.q) * p.r;
            seen = seen + slope, atRest = addScaled(atRest, dot(pull, p.r), slope);
            const PairInput<R> fluid = loadPairInput<needs>(v.fluid, j);
            (Terms::addWall(v.c, p, weights<Kernel>(v.c, p.q), fluid, wall, a), ...);
        });
        const R scale = -v.c.gradientScale;
        store(pressure, b, scale * total(a.pressure));
        store(other, b, scale * total(a.other));
        const R area = R(v.c.gradientScale) * wall.mass;
        store(this->seen, b, area * total(seen));
        store(seenAtRest, b, area * total(atRest));
    }
};

// Sums over the particles of one solid; times a fluid particle's mass they are N and N m, about its
// middle.
struct SolidLoad {
    double pressure[3] = {0, 0, 0}, other[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
    HD_OUT void add(const SolidLoad& o) {
        for (int k = 0; k < 3; ++k)
            pressure[k] += o.pressure[k], other[k] += o.other[k], torque[k] += o.torque[k];
    }
};
struct SumSolidLoad {
    View v;
    VectorField pressure, other;
    WallsAtHome home;
    int solid;
    HD void addTo(SolidLoad& sum, int i) const {
        if (v.walls.id[i] < 0 || home.solidOf(v.walls.id[i]) != solid) return;
        const Vector<real> p = load(pressure, i), o = load(other, i);
        const Vector<real> arm = imageOf(v.c, load(v.walls.position, i) - v.solids[solid].middle);
        const Vector<real> torque = cross(arm, p + o);
        sum.add({{p.x, p.y, p.z}, {o.x, o.y, o.z}, {torque.x, torque.y, torque.z}});
    }
};

// Where what floats comes near the box and other solids are gaps that no particle of fluid fits
// into. Without the fluid's pressure there it would be pressed against them, the more the deeper it
// is. So near them the pressure that fluid at rest would have acts on its closed surface, and what
// particles of fluid press with counts from there: what they don't, the ground takes.
struct BesideGround {
    View v;
    WallsAtHome home;
    const RigidBody* bodies;
    int solid;
    VectorField pressure, seen, seenAtRest;  // as ComputeWallLoads found them

    HD bool has(int i) const { return v.walls.id[i] >= 0 && home.solidOf(v.walls.id[i]) == solid; }
    HD real spacing() const { return bodies[solid].deepestBall / real(0.75); }
    // The image next to the solid's middle.
    HD Vector<real> placeOf(int i) const {
        const Vector<real> middle = v.solids[solid].middle;
        return middle + imageOf(v.c, load(v.walls.position, i) - middle);
    }
    // Its share of the surface, in the solid's own axes; 0 but for the outermost.
    HD Vector<real> areaOf(int i) const { return load(home.area, v.walls.id[i] - home.firstId); }
    // m, from the surface.
    HD real gapAt(int i) const {
        const Vector<real> area = areaOf(i), x = placeOf(i);
        if (dot(area, area) == 0) return real(1e30);
        const SolidState& s = v.solids[solid];
        Vector<real> normal{0, 0, 0};
        const real depth =
            -surface(s, load(home.position, v.walls.id[i] - home.firstId) - s.home, normal);
        return min(toBox(x), toSolids(x)) - depth;
    }
    HD real toBox(Vector<real> x) const {
        const StepParameters& c = v.c;
        real nearest = 1e30;
        auto side = [&](real at, real low, real high)
                        LANE_CALL { nearest = min(nearest, min(at - low, high - at)); };
        if (c.period.x <= 0) side(x.x, c.low.x, c.high.x);
        if (c.period.y <= 0) side(x.y, c.low.y, c.high.y);
        if (c.period.z <= 0 && c.dimensions == 3) side(x.z, c.low.z, c.high.z);
        return nearest;
    }
    HD real toSolids(Vector<real> x) const {
        real nearest = 1e30;
        for (int other = 0; other < v.solidCount; ++other) {
            const SolidState& s = v.solids[other];
            const Vector<real> arm = imageOf(v.c, x - s.middle);
            const real far = s.reach + v.c.support;
            if (other == solid || dot(arm, arm) > far * far) continue;
            Vector<real> normal{0, 0, 0};
            const Vector<real> own{dot(arm, s.axis[0]), dot(arm, s.axis[1]), dot(arm, s.axis[2])};
            nearest = min(nearest, surface(s, own, normal));
        }
        return nearest;
    }
};
struct FindGap {
    BesideGround beside;
    HD void addTo(Gap& sum, int i) const {
        if (!beside.has(i)) return;
        const Vector<real> seen = load(beside.seen, i);
        sum.add({beside.gapAt(i), {seen.x, seen.y, seen.z}});
    }
};
struct FindPressureAround {
    BesideGround beside;
    const Gap* gap;
    HD void addTo(PressureAround& sum, int i) const {
        if (gap->narrowness(beside.spacing()) <= 0 || !beside.has(i)) return;
        const Vector<real> x = beside.placeOf(i), seen = load(beside.seen, i);
        const Vector<real> felt = load(beside.pressure, i) - load(beside.seenAtRest, i);
        const double(&pressed)[3] = gap->pressed;
        auto along = [&](Vector<real> a) LANE_CALL {
            return a.x * pressed[0] + a.y * pressed[1] + a.z * pressed[2];
        };
        const double w = along(seen);
        if (w > 0) sum.add({w, 0.5 * along(felt), {w * x.x, w * x.y, w * x.z}});
    }
};
struct PressFromGaps {
    using Index = int;
    BesideGround beside;
    const Gap* gap;
    const PressureAround* around;
    HD void operator()(int i) const {
        const real share = gap->narrowness(beside.spacing());
        if (share <= 0 || !beside.has(i)) return;
        const View& v = beside.v;
        const Vector<real> x = beside.placeOf(i), pull = bodyForce(v.c, gravityNow(v), x);
        const real rest = share * around->at(x, pull, v.c.restDensity);
        if (rest <= 0) return;
        const Vector<real> atRest = share * load(beside.seenAtRest, i);
        Vector<real> change = real(-2) * rest * load(beside.seen, i) - atRest;
        const Vector<real> area = turned(v.solids[beside.solid], beside.areaOf(i));
        change = subtractScaled(change, rest * v.c.restDensity * v.c.restDensity, area);
        store(beside.pressure, i, load(beside.pressure, i) + change);
    }
};

}  // namespace spindrift::LANES
