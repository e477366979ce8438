// Solids in the fluid: where they are, what their particles know of them, and what fluid does to
// them.
#pragma once

#include "core/error.h"
#include "scene/convex.h"
#include "scene/lattice.h"
#include "scene/mass.h"
#include "scene/motion.h"
#include "scene/sample_solid.h"
#include "scene/thin_solid.h"
#include "sim/step_parameters.h"
#include "sim/neighbours.h"
#include "sim/rigid.h"
#include "sim/terms.h"

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
        const Wall<R> wall = loadWall<needs>(v.walls, b);
        Acceleration<R> a{};
        const Vector<R> x = load(v.walls.position, b);
        const Vector<R> pull = R(1 / v.c.restDensity) *
                               (bodyForce(v.c, gravityNow(v), x) - ownAcceleration(v.walls, b));
        Vector<R> seen{0, 0, 0}, atRest{0, 0, 0};
        forNeighbours<Lists::All>(v, v.fluidNearWalls, b, x, [&](auto p, JCluster j) LANE_CALL {
            p.r = R(-1) * p.r;
            const Vector<R> slope = Kernel::g(p.q) * p.r;
            seen = seen + slope, atRest = addScaled(atRest, dot(pull, p.r), slope);
            const PairInput<R> fluid = loadPairInput<needs>(v.fluid, j);
            (Terms::addWall(v.c, p, weights<Kernel>(p.q), fluid, wall, a), ...);
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

inline Vector<real> toReal(Vec3d a) { return {real(a.x), real(a.y), real(a.z)}; }

// A solid at its place in the scene, before it has moved.
inline SolidState solidAtHome(const Scene& scene, const Solid& solid) {
    const Convex shape = convexOf(solid, scene.simulation.dimensions);
    Vec3d middle = shape.middle - toDouble(scene.domain.min);
    if (scene.simulation.dimensions == 2)
        middle.z = 0.5 * double(scene.domain.max.z - scene.domain.min.z);
    SolidState s{};
    s.grace = real(std::min(thinness(scene, solid) / 8, 0.05 * double(scene.simulation.spacing)));
    s.home = s.middle = s.middleBefore = toReal(middle);
    s.axis[0] = {1, 0, 0}, s.axis[1] = {0, 1, 0}, s.axis[2] = {0, 0, 1};
    for (int k = 0; k < 3; ++k) s.axisBefore[k] = s.axis[k];
    s.spinAxis = int(solid.spinAxis);
    s.planes = shape.planes;
    for (int k = 0; k < shape.planes; ++k)
        s.normal[k] = toReal(shape.normal[k]), s.offset[k] = real(shape.offset[k]);
    s.slip = slipLength(solid.slip);
    s.radius = real(shape.radius), s.across = toReal(shape.across);
    s.reach = solid.shape == Shape::Plane ? real(1e9) : real(reachOf(solid));
    return s;
}

// Owns the solids and what their particles and those of the domain's walls have from the start.
template <class Device> class Solids {
public:
    explicit Solids(Device& device) : device_(device) {}

    // `walls` as in Placement, ids from firstId on.
    void place(const Scene& scene, const std::vector<Vec3>& walls, const std::vector<int>& sizes,
               int firstId) {
        std::vector<SolidState> states;
        std::vector<MotionKey> keys;
        for (const Solid& solid : scene.solids) {
            states.push_back(solidAtHome(scene, solid));
            states.back().firstKey = int(keys.size());
            for (const MotionKey& key : motionOf(solid)) keys.push_back(key);
            states.back().endKey = int(keys.size());
            states.back().steady = solid.keyframes.empty();
            speed_ = std::max(speed_, spindrift::largestSpeed(solid));
        }
        count_ = int(states.size()), firstId_ = firstId;
        moves_ = std::any_of(scene.solids.begin(), scene.solids.end(),
                             [](const Solid& s) { return s.moves(); });
        floats_ = std::any_of(scene.solids.begin(), scene.solids.end(),
                              [](const Solid& s) { return s.floats(); });
        std::vector<int> thin;
        for (int s = 0; s < count_; ++s)
            if (states[size_t(s)].grace > 0) thin.push_back(s);
        fill(thin_, thin);
        spacing_ = scene.simulation.spacing;
        fillFields(scene, states);
        fill(states_, states), fill(keys_, keys);
        const Vec3 size = scene.domain.max - scene.domain.min;
        size_ = {real(size.x), real(size.y), real(size.z)};
        if (count_ > 0) placeParticles(scene, walls, sizes);
    }
    int count() const { return count_; }
    bool moves() const { return moves_; }
    bool floats() const { return floats_; }
    bool anyThin() const { return thin_.size() > 0; }
    void letMove() { moves_ = true; }  // from now on the mouse may drag them
    // Of the host's solids, m/s.
    double largestSpeed() const {
        double most = speed_;
        for (int s = 0; s < count_; ++s) most = std::max(most, double(states_.data()[s].speed));
        return most;
    }
    SolidState* data() { return states_.data(); }

    void move(const StepState* state, double stepsBack, double ahead, const RigidBody* bodies,
              const SolidMotion* motions) {
        device_.forEach(count_, MoveSolids{states_.data(), keys_.data(), state, stepsBack, ahead,
                                           bodies, motions});
    }
    // To the end of a step, which the solids remember to have begun where they were then.
    void sweep(const StepState* state, const RigidBody* bodies, const SolidMotion* motions) {
        move(state, 1, -1, bodies, motions);
        device_.forEach(count_, RememberPose{states_.data()});
        move(state, 0, 0, bodies, motions);
        device_.forEach(count_, MeasureTurn{states_.data(), state});
    }
    // As thin ones separate fluid and walls.
    void screen(const StepParameters& c) {
        const Screens screens{states_.data(), thin_.data(),    int(thin_.size()), c,
                              firstId_,       solidOf_.data(), {face_.data()},    {least_.data()}};
        screens_.resize(1);
        device_.upload(screens_.data(), &screens, 1);
    }
    const Screens* screens() const { return screens_.size() > 0 ? screens_.data() : nullptr; }
    void meetWalls(const StepParameters& c) {
        device_.forEach(count_, MeetWalls{states_.data(), c, size_, spacing_});
    }
    void placeWalls(const View& v) { device_.forEach(v.walls.slots, PlaceWalls{v, home()}); }
    void tellVelocity(const View& v, const RigidBody* bodies, const SolidMotion* motions) {
        device_.forEach(v.walls.slots, TellVelocity{v, home(), bodies, motions});
    }
    void keepMasses(const Particles& walls) {
        device_.forEach(walls.slots, KeepWallMass{walls, home()});
    }

    // What fluid does to each of their particles, and the sum over those of one solid.
    template <class Pass> void findLoads(const View& v) {
        reserveLoads(v.walls.slots);
        device_.forEach(v.walls.slots, Pass{v,
                                            {pressureLoad_.data()},
                                            {otherLoad_.data()},
                                            {seen_.data()},
                                            {seenAtRest_.data()},
                                            home()});
    }
    void pressFromGaps(const View& v, const RigidBody* bodies, int solid) {
        const BesideGround beside{
            v, home(), bodies, solid, {pressureLoad_.data()}, {seen_.data()}, {seenAtRest_.data()}};
        device_.reduce(v.walls.slots, FindGap{beside}, gap_.data());
        device_.reduce(v.walls.slots, FindPressureAround{beside, gap_.data()}, around_.data());
        device_.forEach(v.walls.slots, PressFromGaps{beside, gap_.data(), around_.data()});
    }
    SumSolidLoad sumOf(const View& v, int solid) {
        return {v, {pressureLoad_.data()}, {otherLoad_.data()}, home(), solid};
    }
    // A recorded step can't make room.
    void reserveLoads(int slots) {
        for (auto* field : {&pressureLoad_, &otherLoad_, &seen_, &seenAtRest_})
            field->resize(vectorSize(slots));
        gap_.resize(1), around_.resize(1);
    }
    std::vector<SolidState> download() {
        std::vector<SolidState> host(count_);
        device_.download(host.data(), states_.data(), host.size());
        return host;
    }

    WallsAtHome home() {
        return {firstId_,       solidOf_.data(), {position_.data()}, {mass_.data()},
                {area_.data()}, size_,           {face_.data()}};
    }

private:
    template <class T> void fill(Buffer<T, Device>& buffer, const std::vector<T>& host) {
        buffer.resize(host.size());
        device_.upload(buffer.data(), host.data(), host.size());
    }
    void fillFields(const Scene& scene, std::vector<SolidState>& states) {
        std::vector<real> all;
        std::vector<size_t> begin;
        for (size_t k = 0; k < states.size(); ++k) {
            begin.push_back(all.size());
            const Convex shape = convexOf(scene.solids[k], scene.simulation.dimensions);
            if (!shape.mesh) continue;
            const DistanceField field =
                shape.mesh->field(shape.mesh->fieldSpacing(scene.simulation.spacing / shape.scale));
            for (float distance : field.distances)
                all.push_back(real(shape.scale * double(distance)));
            states[k].nodes = field.nodes;
            states[k].fieldLow = toReal(shape.scale * field.low),
            states[k].nodesPerMetre = real(1 / (shape.scale * field.spacing));
        }
        fill(fields_, all);
        for (size_t k = 0; k < states.size(); ++k)
            if (states[k].nodes.x > 0) states[k].field = fields_.data() + begin[k];
    }
    void placeParticles(const Scene& scene, const std::vector<Vec3>& walls,
                        const std::vector<int>& sizes) {
        const size_t slots = (walls.size() + clusterSize - 1) / clusterSize * clusterSize;
        std::vector<int> solidOf(slots, -1);
        std::vector<real> mass(slots), area(floats_ ? size_t(vectorSize(int(slots))) : 0);
        std::vector<real> face(anyThin() ? size_t(vectorSize(int(slots))) : 0),
            least(anyThin() ? slots : 0);
        // Volumes are of cells a spacing wide, masses of the fluid's particles.
        const double dx = scene.simulation.spacing,
                     cell = std::pow(dx, scene.simulation.dimensions);
        const float share = hasOwnVolume(scene) ? float(cell / particleVolume(scene)) : 1;
        size_t end = 0;
        for (size_t s = 0; s < scene.solids.size(); ++s) {
            const SolidSample sample = boundaryOf(scene, scene.solids[s]);
            const std::vector<float>& volumes = sample.volumes;
            if (sizes.size() <= s || volumes.size() != size_t(sizes[s]))
                throw Error(Exit::Scene,
                            "solids: the particles of this run are of another version of the "
                            "program; start the scene again");
            std::transform(volumes.begin(), volumes.end(), mass.begin() + long(end),
                           [&](float v) { return real(v * share); });
            std::fill_n(solidOf.begin() + long(end), sizes[s], int(s));
            if (scene.solids[s].floats()) fillAreas(scene, scene.solids[s], sample, int(end), area);
            fillFaces(sample, scene.solids[s].shape == Shape::Block, int(end), face, least);
            end += volumes.size();
        }
        std::vector<real> x(vectorSize(int(slots)));
        for (size_t i = 0; i < walls.size(); ++i)
            for (int k = 0; k < 3; ++k) x[vectorOffset(int(i), k)] = walls[i][k];
        fill(solidOf_, solidOf), fill(position_, x), fill(mass_, mass), fill(area_, area);
        fill(face_, face), fill(least_, least);
    }
    // A plate's are seen from any place that is nearer to their face than they are, or for one of
    // the faces as near; other solids' that are beyond them from anywhere through them.
    static void fillFaces(const SolidSample& sample, bool isPlate, int first,
                          std::vector<real>& face, std::vector<real>& least) {
        for (size_t i = 0; i < sample.faces.size(); ++i, ++first) {
            const Vec3 f = sample.faces[i];
            for (int k = 0; k < 3; ++k) face[size_t(vectorOffset(first, k))] = real(f[k]);
            const bool asNear = f.x != 0 ? f.x < 0 : f.y != 0 ? f.y < 0 : f.z < 0;
            least[size_t(first)] =
                isPlate || !sample.beyond[i] ? real(asNear ? -1e-30 : 0) : real(-1e30);
        }
    }
    static void fillAreas(const Scene& scene, const Solid& solid, const SolidSample& sample,
                          int first, std::vector<real>& out) {
        const double perMass = 1 / particleMass(scene);
        for (const Vec3d& area : surfaceAreas(scene, solid, sample)) {
            for (int k = 0; k < 3; ++k)
                out[size_t(vectorOffset(first, k))] = real(perMass * area[k]);
            ++first;
        }
    }

    Device& device_;
    int count_ = 0, firstId_ = 0;
    bool moves_ = false, floats_ = false;
    double speed_ = 0;  // m/s
    Vector<real> size_{};
    Buffer<SolidState, Device> states_{device_};
    Buffer<MotionKey, Device> keys_{device_};
    Buffer<real, Device> fields_{device_};  // of meshes, one after the other
    Buffer<int, Device> solidOf_{device_};
    Buffer<real, Device> position_{device_}, mass_{device_}, area_{device_}, pressureLoad_{device_},
        otherLoad_{device_}, seen_{device_}, seenAtRest_{device_};
    Buffer<int, Device> thin_{device_};
    Buffer<real, Device> face_{device_}, least_{device_};
    Buffer<Screens, Device> screens_{device_};
    real spacing_ = 0;  // m
    Buffer<Gap, Device> gap_{device_};
    Buffer<PressureAround, Device> around_{device_};
};

}  // namespace spindrift::LANES
