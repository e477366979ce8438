// The passes that find what fluid does to solids, and what of it gaps at the ground keep away.
#pragma once

#include "sim/parts/rigid.h"
#include "sim/parts/solid_passes.h"
#include "sim/physics/terms.h"

namespace spindrift::LANES {

// Where a solid stands on the domain's wall it goes on in it: which one a boundary particle of the
// wall is behind, seen from inside, or -1. What fluid beside the foot does to these along the wall
// it does to the solid; without them a dam ten spacings wide bears 6 % too little. Not of what
// floats: that momentum is the wall's.
struct FindFeet {
    using Index = int;
    View v;
    WallsAtHome home;
    const RigidBody* bodies;
    real spacing;
    int* foot;
    HD void operator()(int i) const {
        foot[i] = -1;
        if (v.walls.id[i] < 0 || home.solidOf(v.walls.id[i]) >= 0) return;
        auto inside = [this](real at, real size) {
            return at < 0 ? real(0.5) * spacing : at > size ? size - real(0.5) * spacing : at;
        };
        const Vector<real> x = load(v.walls.position, i),
                           at{inside(x.x, home.size.x), inside(x.y, home.size.y),
                              inside(x.z, home.size.z)};
        for (int k = 0; k < v.solidCount && foot[i] < 0; ++k) {
            const SolidState& s = v.solids[k];
            const Vector<real> arm = imageOf(v.c, at - s.middle);
            if (bodies[k].mass > 0 || dot(arm, arm) > s.reach * s.reach) continue;
            Vector<real> normal{0, 0, 0};
            const Vector<real> own{dot(arm, s.axis[0]), dot(arm, s.axis[1]), dot(arm, s.axis[2])};
            if (surface(s, own, normal) < 0) foot[i] = k;
        }
    }
};

// Which solid bears what fluid does to a boundary particle.
struct Bearers {
    WallsAtHome home;
    const int* foot;  // as FindFeet found them; null: each solid bears its own alone
    bool all;         // what walls bear is asked for too
    HD int of(const Particles& walls, int i) const {
        if (walls.id[i] < 0) return -1;
        const int own = home.solidOf(walls.id[i]);
        return own >= 0 || !foot ? own : foot[i];
    }
    // What of a force at x is the solid's: beyond the domain's wall not what goes across the wall.
    HD Vector<real> shareOf(Vector<real> force, Vector<real> x) const {
        auto along = [](real f, real at, real size)
                         LANE_CALL { return at < 0 || at > size ? real(0) : f; };
        if (!foot) return force;
        return {along(force.x, x.x, home.size.x), along(force.y, x.y, home.size.y),
                along(force.z, x.z, home.size.z)};
    }
    HD bool any(const Particles& walls, int cluster) const {
        if (all) return true;
        for (int k = 0; k < clusterSize; ++k)
            if (of(walls, cluster * clusterSize + k) >= 0) return true;
        return false;
    }
};

// What fluid does to the particles of solids and walls: the terms of ComputeForces with their signs
// changed. m/s² per fluid particle's mass; of pressure, and of the others.
template <class Kernel, class Terms> struct ComputeWallLoads;
template <class Kernel, class... Terms> struct ComputeWallLoads<Kernel, TermList<Terms...>> {
    using Index = ICluster;
    using R = Real<ICluster>;
    using Parameters = TermList<Terms...>;
    static constexpr unsigned needs = Parameters::needs;
    View v;
    Parameters terms;
    VectorField pressure, other;
    // What pressure would be if p / rho^2 of both added up to 1, and to that of fluid at rest where
    // it is none at the boundary particle.
    VectorField seen, seenAtRest;
    Bearers bearers;
    HD void operator()(ICluster b) const {
        if (!bearers.any(v.walls, firstOf(b) / clusterSize)) return;
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
            (static_cast<const Terms&>(terms).addWall(v.c, p, weights<Kernel>(v.c, p.q), fluid,
                                                      wall, a),
             ...);
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
    Bearers bearers;
    int solid;
    HD void addTo(SolidLoad& sum, int i) const {
        if (bearers.of(v.walls, i) != solid) return;
        const Vector<real> x = load(v.walls.position, i), p = bearers.shareOf(load(pressure, i), x),
                           o = bearers.shareOf(load(other, i), x),
                           arm = imageOf(v.c, x - v.solids[solid].middle);
        const Vector<real> torque = cross(arm, p + o);
        sum.add({{p.x, p.y, p.z}, {o.x, o.y, o.z}, {torque.x, torque.y, torque.z}});
    }
};

// The same over the particles of the two faces across an axis.
struct FaceLoads {
    double pressure[2][3] = {}, other[2][3] = {};
    HD_OUT void add(const FaceLoads& o) {
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < 3; ++k)
                pressure[end][k] += o.pressure[end][k], other[end][k] += o.other[end][k];
    }
};
// A particle in an edge belongs to more than one face: what acts across one of them is that face's,
// what acts along all of them is shared, but for what a solid that goes on in the wall there bears.
struct SumFaceLoads {
    View v;
    VectorField pressure, other;
    Bearers bearers;
    int axis;
    HD void addTo(FaceLoads& sum, int i) const {
        if (v.walls.id[i] < 0) return;
        const Vector<real> size = bearers.home.size, x = load(v.walls.position, i),
                           p = load(pressure, i), o = load(other, i);
        const double of[3][2] = {{p.x, o.x}, {p.y, o.y}, {p.z, o.z}};
        const int end[3] = {endBeyond(x.x, size.x), endBeyond(x.y, size.y), endBeyond(x.z, size.z)};
        if (end[axis] < 0) return;
        const bool isBorne = bearers.of(v.walls, i) >= 0;
        const int faces = (end[0] >= 0) + (end[1] >= 0) + (end[2] >= 0);
        for (int k = 0; k < 3; ++k) {
            const double share = k == axis ? 1 : end[k] >= 0 || isBorne ? 0 : 1.0 / faces;
            sum.pressure[end[axis]][k] += share * of[k][0];
            sum.other[end[axis]][k] += share * of[k][1];
        }
    }
    HD static int endBeyond(real at, real size) { return at < 0 ? 0 : at > size ? 1 : -1; }
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
