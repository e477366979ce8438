// Thin solids as screens: fluid that one of them separates does not feel each other, and each side
// has boundary particles of its own.
#pragma once

#include "sim/neighbours/solid_shape.h"

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

// At which share of the way from p to q, in the solid's own axes, it enters a solid that is no
// plate deeper than its grace; 2 where it does not.
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

// What a thin solid leaves of what p and q, in its own axes, see of each other, and at which share
// of the way it stands.
struct Hiding {
    real at, left;
};

// A plate hides by its middle. Around its ends fluid feels fluid as if it were as far away as the
// shortest way around is long: so what is hidden fades out, and no sum jumps when something moves
// in or out of sight. There is no way around where the plate goes on in a wall or another solid.
HD inline Hiding hidingOfPlate(const StepParameters& c, const SolidState& s, Vector<real> p,
                               Vector<real> q) {
    const real a = dot(s.normal[s.plate], p), b = dot(s.normal[s.plate], q);
    if (!(a * b < 0)) return {2, 1};
    const Vector<real> r = q - p, through = addScaled(p, a / (a - b), r);
    const real length2 = dot(r, r);
    real around = c.support;
    for (int k = 0; k < s.planes; ++k) {
        if (k / 2 == s.plate / 2) continue;
        const real depth = s.offset[k] - dot(s.normal[k], through);
        if (depth + s.beyond[k] <= 0) return {2, 1};
        if (s.beyond[k] > 0 || s.joined[k]) continue;
        // Unfolded along the end's edge, the way over it is straight.
        const real below = s.offset[k] - dot(s.normal[k], p),
                   after = s.offset[k] - dot(s.normal[k], q), rise = after - below,
                   over = squareRoot(a * a + below * below) + squareRoot(b * b + after * after),
                   along2 = max(length2 - (b - a) * (b - a) - rise * rise, real(0));
        around = min(around, squareRoot(over * over + along2));
    }
    const real longer = 1 - around / c.support, straight = 1 - squareRoot(length2) / c.support;
    const real share = longer > 0 ? min(longer / straight, real(1)) : real(0);
    return {a / (a - b), share * share * share * share};  // as Wendland's kernels, nearly
}

HD inline Hiding hiding(const StepParameters& c, const SolidState& s, Vector<real> p,
                        Vector<real> q) {
    if (s.plate >= 0) return hidingOfPlate(c, s, p, q);
    const real at = s.hides ? crossing(s, p, q) : real(2);
    return {at, at < 2 ? real(0) : real(1)};
}

// The way from x to x - r in a solid's own axes.
struct Way {
    Vector<real> from, to;
    HD Way(const StepParameters& c, const SolidState& s, Vector<real> x, Vector<real> r) {
        auto own = [&](Vector<real> a) LANE_CALL {
            return Vector<real>{dot(a, s.axis[0]), dot(a, s.axis[1]), dot(a, s.axis[2])};
        };
        const Vector<real> half = real(0.5) * r,
                           arm = imageOf(c, x - half - intoDomain(c, s.middle));
        from = own(arm + half), to = own(arm - half);
    }
};

// Whether p is where a plate goes on in the domain's wall, or beside its faces there.
HD inline bool isInWall(const SolidState& s, Vector<real> p) {
    bool isIn = false;
    for (int k = 0; k < s.planes; ++k) {
        if (k / 2 == s.plate / 2) continue;
        const real above = dot(s.normal[k], p) - s.offset[k];
        if (above >= s.beyond[k]) return false;
        isIn = isIn || above > 0;
    }
    return isIn;
}

// Of boundary particles that are not a thin solid's. Those beside a plate's foot count as far as
// their cells are in front of its face: behind it the plate has its own.
HD inline real leftOfWall(const Screens& screens, const SolidState& s, const Way& way) {
    const real left = hiding(screens.c, s, way.from, way.to).left;
    if (s.plate < 0) return left;
    const Vector<real> n = s.normal[s.plate];
    const real side = dot(n, way.from) < 0 ? real(-1) : real(1),
               before = side * dot(n, way.to) - s.offset[s.plate],
               front = min(max(real(0.5) + before / screens.spacing, real(0)), real(1));
    return isInWall(s, way.to) ? front : max(left, front);
}

// Of a thin solid's own particle k: those of a plate from their face's side; what is beyond it as
// far as it hides the fluid there.
HD inline Hiding leftOfOwn(const Screens& screens, const SolidState& s, int k, const Way& way) {
    const Vector<real> face = load(screens.face, k);
    const real least = load(screens.least, k);
    if (s.plate < 0) {
        const real at = s.hides ? crossing(s, way.from, way.to) : real(1);
        return {at, at < 2 && dot(way.to - way.from, face) > least ? real(1) : real(0)};
    }
    const Vector<real> n = s.normal[s.plate];
    if ((dot(n, way.from) >= 0) != (dot(n, face) < 0)) return {2, 0};
    const bool isInside = least > -1;
    if (isInside || isInWall(s, way.to)) return {1, 1};
    const Hiding h = hidingOfPlate(screens.c, s, way.from, way.to);
    return {h.at, 1 - h.left};
}

// How much a particle at x sees of one at x - r; `wall` says which boundary particle that is, or
// -1.
HD inline real sightOf(const Screens& screens, Vector<real> x, Vector<real> r, int wall) {
    const int solid = wall < 0 ? -1 : screens.solidOf[wall],
              owner = solid >= 0 && screens.solids[solid].grace > 0 ? solid : -1;
    Hiding own{2, 1};
    if (owner >= 0) {
        const SolidState& s = screens.solids[owner];
        own = leftOfOwn(screens, s, wall, Way(screens.c, s, x, r));
    }
    real left = own.left;
    for (int k = 0; k < screens.count && left > 0; ++k) {
        if (screens.thin[k] == owner) continue;
        const SolidState& s = screens.solids[screens.thin[k]];
        const Way way(screens.c, s, x, r);
        if (wall >= 0 && owner < 0) {
            left = left * leftOfWall(screens, s, way);
        } else {
            const Hiding h = hiding(screens.c, s, way.from, way.to);
            if (h.at < own.at) left = left * h.left;
        }
    }
    return left;
}

inline constexpr real hidden = 4;

// What a pair's squared distance in support radii grows by, so that each feels of the other what
// it sees: particle i of one set, at x, and j of the other, at x - r. It is the same for both: the
// way between two fluid particles is walked from the same end. Not a part of the passes' loops,
// whose registers it would need.
SCREEN_CALL inline real apartOf(const Screens& screens, const int* wallId, Between between, int i,
                                int j, Vector<real> x, Vector<real> r) {
    const bool fromOther =
        between == Between::WallsAndFluid || (between == Between::Fluid && j < i);
    if (fromOther) x = x - r, r = real(-1) * r;
    const int wall = between == Between::Fluid
                         ? -1
                         : wallId[between == Between::WallsAndFluid ? i : j] - screens.firstId;
    const real left = sightOf(screens, x, r, wall), q = squareRoot(dot(r, r)) / screens.c.support;
    if (!(left > 0)) return hidden;
    if (left >= 1 || q >= 1) return 0;
    const real far = 1 - (1 - q) * squareRoot(squareRoot(left));
    return far * far - q * q;
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

// A thin solid that stands on a wall of the domain separates in that wall as well. Where another
// solid touches the middle of an end, or across a periodic axis it touches itself, there is no way
// around it.
struct MeetWalls {
    using Index = int;
    SolidState* solids;
    int count;
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
            s.joined[k] = !touches && (meetsItself(n, s.offset[k]) || meetsSolid(i, at));
        }
    }
    HD bool meetsItself(Vector<real> normal, real offset) const {
        auto spans = [&](real normal, real period) {
            return period > 0 && normal * normal > real(0.98) &&
                   2 * offset > period - real(0.25) * spacing;
        };
        return spans(normal.x, c.period.x) || spans(normal.y, c.period.y) ||
               spans(normal.z, c.period.z);
    }
    HD bool meetsSolid(int i, Vector<real> at) const {
        for (int other = 0; other < count; ++other) {
            const SolidState& s = solids[other];
            if (other == i) continue;
            const Vector<real> arm = imageOf(c, at - s.middle),
                               own{dot(arm, s.axis[0]), dot(arm, s.axis[1]), dot(arm, s.axis[2])};
            Vector<real> normal{0, 0, 0};
            if (surface(s, own, normal) < real(0.25) * spacing) return true;
        }
        return false;
    }
    HD bool touchesWall(real normal, real at, real size, real period) const {
        const real near = real(0.25) * spacing;
        return period <= 0 &&
               ((normal > real(0.99) && at > size - near) || (normal < real(-0.99) && at < near));
    }
};

}  // namespace spindrift::LANES
