// The shapes of solids, as passes ask for them.
#pragma once

#include "sim/particles/view.h"

namespace spindrift::LANES {

// From a solid's own axes into space.
template <class R> HD inline Vector<R> turned(const SolidState& s, Vector<R> a) {
    auto wide = [](Vector<real> b) LANE_CALL { return Vector<R>{b.x, b.y, b.z}; };
    return a.x * wide(s.axis[0]) + a.y * wide(s.axis[1]) + a.z * wide(s.axis[2]);
}

// Convex::nearest, for lanes: signed distance of p from a solid's surface in its own axes, and the
// outward normal there.
template <class R> HD inline R nearest(const SolidState& s, Vector<R> p, Vector<R>& n) {
    R most = real(-1e30);
    auto take = [&](R distance, Vector<R> normal) LANE_CALL {
        const auto nearer = distance > most;
        n = {select(nearer, normal.x, n.x), select(nearer, normal.y, n.y),
             select(nearer, normal.z, n.z)};
        most = max(most, distance);
    };
    for (int k = 0; k < s.planes; ++k) {
        const Vector<R> normal{s.normal[k].x, s.normal[k].y, s.normal[k].z};
        take(dot(normal, p) - R(s.offset[k]), normal);
    }
    if (s.radius > 0) {
        const Vector<R> d{R(s.across.x) * p.x, R(s.across.y) * p.y, R(s.across.z) * p.z};
        const R far = squareRoot(max(dot(d, d), R(real(1e-30))));
        take(far - R(s.radius), (R(1) / far) * d);
    }
    return most;
}

// The same for one particle and any solid: of a mesh trilinear between the nodes of its field.
HD inline real surface(const SolidState& s, Vector<real> p, Vector<real>& n) {
    if (!s.field) return nearest(s, p, n);
    const Vector<real> at = s.nodesPerMetre * (p - s.fieldLow);
    auto cell = [](real a, int nodes) LANE_CALL { return Grid::clamped(a, nodes - 1); };
    auto share = [](real a, int cell)
                     LANE_CALL { return min(max(a - real(cell), real(0)), real(1)); };
    const int i = cell(at.x, s.nodes.x), j = cell(at.y, s.nodes.y), k = cell(at.z, s.nodes.z);
    const real x = share(at.x, i), y = share(at.y, j), z = share(at.z, k);
    const real* f =
        s.field + (size_t(k) * size_t(s.nodes.y) + size_t(j)) * size_t(s.nodes.x) + size_t(i);
    const size_t up = size_t(s.nodes.x), back = up * size_t(s.nodes.y);
    auto between = [](real a, real b, real share) LANE_CALL { return a + share * (b - a); };
    const real f00 = between(f[0], f[1], x), f10 = between(f[up], f[up + 1], x),
               f01 = between(f[back], f[back + 1], x),
               f11 = between(f[back + up], f[back + up + 1], x), low = between(f00, f10, y),
               high = between(f01, f11, y);
    const real alongX =
        between(between(f[1] - f[0], f[up + 1] - f[up], y),
                between(f[back + 1] - f[back], f[back + up + 1] - f[back + up], y), z);
    const Vector<real> slope{alongX, between(f10 - f00, f11 - f01, z), high - low};
    const real steepness = squareRoot(dot(slope, slope));
    n = steepness > 0 ? (1 / steepness) * slope : Vector<real>{0, 1, 0};
    return between(low, high, z);
}

// The image of x in the domain.
HD inline Vector<real> intoDomain(const StepParameters& c, Vector<real> x) {
    return {x.x - c.period.x * roundDown(x.x * c.inversePeriod.x),
            x.y - c.period.y * roundDown(x.y * c.inversePeriod.y),
            x.z - c.period.z * roundDown(x.z * c.inversePeriod.z)};
}

}  // namespace spindrift::LANES
