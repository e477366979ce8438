// Thin solids as screens: fluid that one of them separates does not see each other, and each side
// has boundary particles of its own, which it sees through the solid.
#pragma once

#include "sim/solid_shape.h"

#ifdef __CUDACC__
#define SCREEN_CALL HD __noinline__
#elif defined(SPINDRIFT_SIMD)
#define SCREEN_CALL HWY_ATTR
#else
#define SCREEN_CALL
#endif

namespace spindrift::LANES {

// Of all images of a neighbour the nearest one. Empty slots, which lie many periods away, stay far.
template <class R> HD inline R nearestImage(R r, real period, real inversePeriod) {
    const R periods = min(max(r * R(inversePeriod), R(-1)), R(1));
    return negMulAdd(nearestInteger(periods), R(period), r);
}

template <class R> HD inline Vector<R> imageOf(const StepParameters& c, Vector<R> r) {
    if (c.periodic)
        r = {nearestImage(r.x, c.period.x, c.inversePeriod.x),
             nearestImage(r.y, c.period.y, c.inversePeriod.y),
             nearestImage(r.z, c.period.z, c.inversePeriod.z)};
    return r;
}

// Distance from a mesh, which goes on as it ends where it stands on the domain's wall.
HD inline real surfaceBeyond(const SolidState& s, Vector<real> p) {
    for (int k = 0; k < s.planes; ++k)
        if (s.beyond[k] > 0) {
            const real above = dot(s.normal[k], p) - (s.offset[k] - 8 * s.grace);
            p = subtractScaled(p, max(above, real(0)), s.normal[k]);
        }
    Vector<real> n{0, 0, 0};
    return surface(s, p, n);
}

// Walks through the field of a mesh, between these shares of the way.
HD inline real crossingOfMesh(const SolidState& s, Vector<real> p, Vector<real> q, real in,
                              real out) {
    const Vector<real> way = q - p;
    const real length = squareRoot(dot(way, way));
    if (!(length > 0) || surfaceBeyond(s, p) + surfaceBeyond(s, q) > length) return 2;
    const real shortest = real(0.25) / s.nodesPerMetre, end = out * length;
    for (real at = in * length;;) {
        const real d = surfaceBeyond(s, addScaled(p, at / length, way));
        if (d < -s.grace) return at / length;
        if (!(at < end)) return 2;
        at = min(end, at + max(real(0.8) * d, shortest));
    }
}

// At which share of the way from p to q, in the solid's own axes, it enters the solid deeper than
// its grace; 2 where it does not.
HD inline real crossing(const SolidState& s, Vector<real> p, Vector<real> q) {
    real in = 0, out = 1;
    for (int k = 0; k < s.planes; ++k) {
        const real offset = s.offset[k] + s.beyond[k] - s.grace;
        const real a = dot(s.normal[k], p) - offset, b = dot(s.normal[k], q) - offset;
        if (a > 0 && b > 0) return 2;
        if (a > 0) in = max(in, a / (a - b));
        if (b > 0) out = min(out, a / (a - b));
    }
    if (s.radius > 0) {
        auto across = [&](Vector<real> a) LANE_CALL {
            return Vector<real>{s.across.x * a.x, s.across.y * a.y, s.across.z * a.z};
        };
        const Vector<real> a = across(p), w = across(q - p);
        const real w2 = max(dot(w, w), real(1e-30)), closest = -dot(a, w) / w2;
        const Vector<real> middle = addScaled(a, closest, w);
        const real radius = s.radius - s.grace, chord2 = radius * radius - dot(middle, middle);
        if (chord2 < 0) return 2;
        const real half = squareRoot(chord2 / w2);
        in = max(in, closest - half), out = min(out, closest + half);
    }
    if (in > out) return 2;
    return s.field ? crossingOfMesh(s, p, q, in, out) : in;
}

// The first solid on the way from x to x - r, or -1.
HD inline int firstCrossed(const Screens& screens, Vector<real> x, Vector<real> r) {
    const StepParameters& c = screens.c;
    real soonest = 2;
    int first = -1;
    for (int k = 0; k < screens.count; ++k) {
        const SolidState& s = screens.solids[screens.thin[k]];
        auto own = [&](Vector<real> a) LANE_CALL {
            return Vector<real>{dot(a, s.axis[0]), dot(a, s.axis[1]), dot(a, s.axis[2])};
        };
        const Vector<real> half = real(0.5) * r,
                           arm = imageOf(c, x - half - intoDomain(c, s.middle));
        const real share = crossing(s, own(arm + half), own(arm - half));
        if (share < soonest) soonest = share, first = screens.thin[k];
    }
    return first;
}

// Whether fluid at x sees the boundary particle at x - r: one of a thin solid through that one
// only, and from in front of its face.
HD inline bool seesWall(const Screens& screens, Vector<real> x, Vector<real> r, int id) {
    const int k = id - screens.firstId, solid = screens.solidOf[k],
              owner = solid >= 0 && screens.solids[solid].grace > 0 ? solid : -1;
    if (firstCrossed(screens, x, r) != owner) return false;
    if (owner < 0) return true;
    const Vector<real> face = turned(screens.solids[owner], load(screens.face, k));
    return -dot(r, face) > load(screens.least, k);
}

// Whether particle i of one set, at x, sees particle j of the other, at x - r. Both see each other
// or neither does: the way between two fluid particles is walked from the same end. Not a part of
// the passes' loops, whose registers it would need.
SCREEN_CALL inline bool sees(const Screens& screens, const int* wallId, Between between, int i,
                             int j, Vector<real> x, Vector<real> r) {
    if (between == Between::FluidAndWalls) return seesWall(screens, x, r, wallId[j]);
    const bool fromOther = between == Between::WallsAndFluid || j < i;
    if (fromOther) x = x - r, r = real(-1) * r;
    if (between == Between::WallsAndFluid) return seesWall(screens, x, r, wallId[i]);
    return firstCrossed(screens, x, r) < 0;
}

// Whether a thin solid may be on any way as long as the support radius that ends at x, or its
// particles be at the other end.
SCREEN_CALL inline bool isBesideScreen(const Screens& screens, Vector<real> x) {
    const StepParameters& c = screens.c;
    for (int k = 0; k < screens.count; ++k) {
        const SolidState& s = screens.solids[screens.thin[k]];
        const Vector<real> arm = imageOf(c, x - intoDomain(c, s.middle));
        bool far = false;
        for (int p = 0; p < s.planes; ++p)
            far =
                far || dot(arm, turned(s, s.normal[p])) - s.offset[p] - s.beyond[p] > 2 * c.support;
        if (!far) return true;
    }
    return false;
}

// A thin solid that stands on a wall of the domain separates in that wall as well.
struct MeetWalls {
    using Index = int;
    SolidState* solids;
    StepParameters c;
    Vector<real> size;  // m, the domain's
    real spacing;
    HD void operator()(int i) const {
        SolidState& s = solids[i];
        if (!(s.grace > 0)) return;
        for (int k = 0; k < s.planes; ++k) {
            const Vector<real> n = turned(s, s.normal[k]), at = addScaled(s.middle, s.offset[k], n);
            const bool touches = touchesWall(n.x, at.x, size.x, c.period.x) ||
                                 touchesWall(n.y, at.y, size.y, c.period.y) ||
                                 touchesWall(n.z, at.z, size.z, c.period.z);
            s.beyond[k] = touches ? 2 * c.support : real(0);
        }
    }
    HD bool touchesWall(real normal, real at, real size, real period) const {
        const real near = real(0.25) * spacing;
        return period <= 0 &&
               ((normal > real(0.99) && at > size - near) || (normal < real(-0.99) && at < near));
    }
};

}  // namespace spindrift::LANES
