// What keeps fluid out of solids, at any speed: boundary particles push it away, but not every
// drop, and not one that would be through a thin plate within a step. Where a particle's way meets
// a surface it stops, and slides along it for the rest of the step.
#pragma once

#include "sim/parts/solid_passes.h"

namespace spindrift::LANES {

// The way of a particle from the share `begin` of a step to its end, m. A straight line in space,
// it is a curved one as a solid sees it that turns; along the one that carries it, it is straight
// in that one's own axes.
struct Sweep {
    Vector<real> from, to;
    real begin;
    int carrier;                         // -1: none
    Vector<real> ownFrom, ownTo, stays;  // stays: in space, where it would be without sliding
};
// Where and when it meets a solid, and that one's normal there, both in its own axes.
struct Hit {
    real share;
    Vector<real> at, normal;
};

// A solid during a step.
struct SolidInStep {
    const SolidState& s;
    const StepParameters& c;

    HD static Vector<real> placeAt(const Sweep& way, real share) {
        const real along = way.begin < 1 ? (share - way.begin) / (1 - way.begin) : real(1);
        return addScaled(way.from, along, way.to - way.from);
    }
    // From the middle, in space, at that share of the step.
    HD Vector<real> armAt(Vector<real> x, real share) const {
        return x - addScaled(s.middleBefore, share, s.middle - s.middleBefore);
    }
    // To the solid's nearest image.
    HD Vector<real> shiftOf(Vector<real> arm) const {
        auto whole = [](real a, real period, real inverse)
                         LANE_CALL { return period * roundDown(a * inverse + real(0.5)); };
        return {whole(arm.x, c.period.x, c.inversePeriod.x),
                whole(arm.y, c.period.y, c.inversePeriod.y),
                whole(arm.z, c.period.z, c.inversePeriod.z)};
    }
    HD static Vector<real> components(const Vector<real> (&axis)[3], Vector<real> a) {
        return {dot(a, axis[0]), dot(a, axis[1]), dot(a, axis[2])};
    }
    // In its own axes, as they are then.
    HD Vector<real> own(Vector<real> arm, real share) const {
        return share < 1 ? rotated(components(s.axisBefore, arm), -share) : components(s.axis, arm);
    }
    HD Vector<real> inSpace(Vector<real> own, real share) const {
        if (share >= 1) return turned(s, own);
        const Vector<real> a = rotated(own, share);
        return a.x * s.axisBefore[0] + a.y * s.axisBefore[1] + a.z * s.axisBefore[2];
    }
    // By that share of its turn (Rodrigues).
    HD Vector<real> rotated(Vector<real> a, real share) const {
        const real angle = squareRoot(dot(s.turn, s.turn));
        if (angle * share == 0) return a;
        const Vector<real> k = (1 / angle) * s.turn;
        const real cosine = cos(angle * share), sine = sin(angle * share);
        return addScaled(addScaled(cosine * a, sine, cross(k, a)), (1 - cosine) * dot(k, a), k);
    }

    // In pieces that are nearly straight as the solid sees them, and short enough for one image of
    // it.
    HD bool meets(const Sweep& way, Hit& m) const {
        const Vector<real> line = way.to - way.from;
        real pieces = 1 + 4 * squareRoot(dot(s.turn, s.turn)) * (1 - way.begin);
        if (c.periodic) pieces = pieces + squareRoot(dot(line, line)) / c.support;
        const int count = int(min(pieces, real(1000)));
        for (int k = 0; k < count; ++k) {
            const real begin = way.begin + (1 - way.begin) * real(k) / real(count);
            const real end = k + 1 == count
                                 ? real(1)
                                 : way.begin + (1 - way.begin) * real(k + 1) / real(count),
                       half = (begin + end) / 2;
            const Vector<real> shift = shiftOf(armAt(placeAt(way, half), half));
            const Vector<real> p = own(armAt(placeAt(way, begin), begin) - shift, begin),
                               q = own(armAt(placeAt(way, end), end) - shift, end);
            if (!enters(p, q, m)) continue;
            m.share = begin + m.share * (end - begin);
            return true;
        }
        return false;
    }
    HD bool meetsCarried(const Sweep& way, Hit& m) const {
        if (!enters(way.ownFrom, way.ownTo, m)) return false;
        m.share = way.begin + m.share * (1 - way.begin);
        return true;
    }
    HD bool enters(Vector<real> p, Vector<real> q, Hit& m) const {
        return s.field ? entersMesh(p, q, m) : entersConvex(p, q, m);
    }
    // What is inside already and goes on inward is stopped where it is nearest to the surface.
    HD bool goesInward(Vector<real> p, Vector<real> q, real distance, Hit& m) const {
        m.share = 0, m.at = addScaled(p, c.gap - distance, m.normal);
        return dot(q - p, m.normal) < 0;
    }
    HD bool entersConvex(Vector<real> p, Vector<real> q, Hit& m) const {
        if (const real d = nearest(s, p, m.normal); d <= 0) return goesInward(p, q, d, m);
        const Vector<real> way = q - p;
        real in = -1, out = real(1e30);
        for (int k = 0; k < s.planes; ++k) {
            const real height = dot(s.normal[k], p) - s.offset[k], change = dot(s.normal[k], way);
            if (change < 0 && height > in * -change) in = height / -change, m.normal = s.normal[k];
            if (change > 0) out = min(out, height / -change);
            if (!(change != 0) && height > 0) return false;
        }
        if (s.radius > 0) {
            auto across = [&](Vector<real> a) LANE_CALL {
                return Vector<real>{s.across.x * a.x, s.across.y * a.y, s.across.z * a.z};
            };
            // From the point of the line that is nearest to the axis or centre.
            const Vector<real> a = across(p), w = across(way);
            const real w2 = dot(w, w), closest = w2 > 0 ? -dot(a, w) / w2 : real(0);
            const Vector<real> middle = addScaled(a, closest, w);
            const real chord2 = s.radius * s.radius - dot(middle, middle);
            if (chord2 < 0) return false;
            if (w2 > 0) {
                const real half = squareRoot(chord2 / w2);
                if (closest - half > in)
                    in = closest - half, m.normal = (1 / s.radius) * addScaled(a, in, w);
                out = min(out, closest + half);
            }
        }
        if (!(in >= 0 && in <= 1 && in <= out)) return false;
        const Vector<real> at = addScaled(p, in, way);
        Vector<real> unused{0, 0, 0};
        m.share = in, m.at = addScaled(at, c.gap - nearest(s, at, unused), m.normal);
        return true;
    }
    // From where the way enters the box of the mesh, as far each time as nothing is near, or a
    // small part of the field's cells.
    HD bool entersMesh(Vector<real> p, Vector<real> q, Hit& m) const {
        const Vector<real> way = q - p;
        real in = 0, out = 1;
        for (int k = 0; k < s.planes; ++k) {
            const real height = dot(s.normal[k], p) - s.offset[k], change = dot(s.normal[k], way);
            if (change < 0) in = max(in, height / -change);
            if (change > 0) out = min(out, height / -change);
            if (!(change != 0) && height > 0) return false;
        }
        const real length = squareRoot(dot(way, way));
        if (!(in <= out && length > 0)) return false;
        const Vector<real> from = addScaled(p, in, way), along = (1 / length) * way;
        const real shortest = real(0.25) / s.nodesPerMetre, end = (out - in) * length;
        bool outside = in > 0;  // what is inside the box at once came through a face of both
        real at = 0, before = 0, d = surface(s, from, m.normal);
        if (d > 2 * end) return false;
        if (!outside && d <= 0 && goesInward(p, q, d, m)) return true;
        while (true) {
            if (d > 0)
                outside = true, before = at;
            else if (outside)
                break;
            if (!(at < end)) return false;
            at = min(end, at + max(real(0.8) * d, shortest));
            d = surface(s, addScaled(from, at, along), m.normal);
        }
        for (int k = 0; k < 8; ++k) {
            const real half = (before + at) / 2;
            (surface(s, addScaled(from, half, along), m.normal) > 0 ? before : at) = half;
        }
        const Vector<real> place = addScaled(from, before, along);
        d = surface(s, place, m.normal);
        m.share = in + before / length, m.at = addScaled(place, c.gap - d, m.normal);
        return true;
    }
};

// How a particle's velocity changed where it was stopped, m/s, and by which solid, -1: by none.
// Where solids float: they get the opposite.
struct Bounces {
    VectorField change;
    ScalarField solid;
};

struct KeepOutOfSolids {
    using Index = Lanes4;
    using R = Real<Lanes4>;
    View v;
    Bounces bounces;
    HD void operator()(Lanes4 i) const {
        const Vector<R> x = load(v.fluid.position, i), from = begin(i, x);
        R room = real(1e30);
        for (int s = 0; s < v.solidCount; ++s) room = min(room, roomTo(v.solids[s], from, x));
        if (bounces.solid.data) store(bounces.solid, i, R(real(-1)));
        real rooms[clusterSize];
        storeAt(rooms, origin(i), room);
        for (int k = 0; k < clusterSize; ++k)
            if (rooms[k] < v.c.gap && v.fluid.id[firstOf(i) + k] >= 0) stop(firstOf(i) + k);
    }
    // What rests did not drift.
    template <class I> HD Vector<Real<I>> begin(I i, Vector<Real<I>> x) const {
        return isActive<Inactive>(v.fluid, firstOf(i)) ? load(v.fluid.keptPosition, i) : x;
    }
    // No more than how much further the surface is from the end of the way than the way is long, as
    // the solid sees it.
    HD R roomTo(const SolidState& s, Vector<R> from, Vector<R> to) const {
        auto wide = [](Vector<real> b) LANE_CALL { return Vector<R>{b.x, b.y, b.z}; };
        Vector<R> arm = to - wide(intoDomain(v.c, s.middle));
        if (v.c.periodic)
            arm = {nearestImage(arm.x, v.c.period.x, v.c.inversePeriod.x),
                   nearestImage(arm.y, v.c.period.y, v.c.inversePeriod.y),
                   nearestImage(arm.z, v.c.period.z, v.c.inversePeriod.z)};
        const Vector<R> armBefore = arm - (to - from) + wide(s.middle - s.middleBefore);
        const Vector<R> own{dot(arm, wide(s.axis[0])), dot(arm, wide(s.axis[1])),
                            dot(arm, wide(s.axis[2]))};
        const Vector<R> before{dot(armBefore, wide(s.axisBefore[0])),
                               dot(armBefore, wide(s.axisBefore[1])),
                               dot(armBefore, wide(s.axisBefore[2]))};
        const R turn = 2 * squareRoot(dot(s.turn, s.turn));
        const Vector<R> line = own - before;
        Vector<R> n{0, 0, 0};
        return nearest(s, own, n) - squareRoot(dot(line, line)) -
               turn * squareRoot(max(dot(arm, arm), dot(armBefore, armBefore)));
    }
    HD void stop(int i) const {
        const Vector<real> x = load(v.fluid.position, i);
        Sweep way{begin(i, x), x, 0, -1, {}, {}, {}};
        const Vector<real> before = load(v.fluid.velocity, i);
        Vector<real> u = before;
        int last = -1;
        bool free = false;
        for (int k = 0; k < mostMeetings && !free; ++k) {
            int first = -1;
            Hit soonest{2, {0, 0, 0}, {0, 0, 0}};
            for (int s = 0; s < v.solidCount; ++s) {
                const SolidInStep solid{v.solids[s], v.c};
                Hit m{2, {0, 0, 0}, {0, 0, 0}};
                if ((s == way.carrier ? solid.meetsCarried(way, m) : solid.meets(way, m)) &&
                    m.share < soonest.share)
                    soonest = m, first = s;
            }
            free = first < 0;
            if (!free) slide(last = first, soonest, way, u);
        }
        // Between solids it stays where it was stopped last.
        Vector<real> end = free ? way.to : way.stays;
        for (int s = 0; s < v.solidCount; ++s)
            if (leave(v.solids[s], end, u)) last = s;
        store(v.fluid.position, i,
              inBox(end));  // also where a solid that floats presses it against a wall
        store(v.fluid.velocity, i, u);
        if (bounces.solid.data)
            store(bounces.change, i, u - before), store(bounces.solid, i, real(last));
    }
    // It is carried along, and goes on in the plane that touches the solid there, in the box.
    HD void slide(int carrier, const Hit& m, Sweep& way, Vector<real>& u) const {
        const SolidState& s = v.solids[carrier];
        const SolidInStep solid{s, v.c};
        const Vector<real> place = SolidInStep::placeAt(way, m.share),
                           arm = solid.armAt(place, m.share), at = solid.inSpace(m.at, m.share);
        const Vector<real> shift = solid.shiftOf(arm - at), endArm = solid.armAt(way.to, 1) - shift,
                           end = solid.own(endArm, 1);
        const Vector<real> slid =
            turned(s, subtractScaled(end, dot(end - m.at, m.normal), m.normal));
        way.from = place - arm + shift + at;
        way.to = inBox(s.middle + shift + slid);
        way.begin = m.share, way.carrier = carrier;
        way.ownFrom = m.at, way.ownTo = solid.own(way.to - s.middle - shift, 1);
        way.stays = inBox(s.middle + shift + turned(s, m.at));
        bounce(s, slid, turned(s, m.normal), u);
    }
    HD Vector<real> inBox(Vector<real> x) const {
        auto within = [](real a, real low, real high, real period)
                          LANE_CALL { return period > 0 ? a : min(max(a, low), high); };
        return {within(x.x, v.c.low.x, v.c.high.x, v.c.period.x),
                within(x.y, v.c.low.y, v.c.high.y, v.c.period.y),
                within(x.z, v.c.low.z, v.c.high.z, v.c.period.z)};
    }
    // As from the domain's box, relative to the solid.
    HD void bounce(const SolidState& s, Vector<real> arm, Vector<real> n, Vector<real>& u) const {
        const Vector<real> relative = u - s.velocity - cross(s.spin, arm);
        const real into = dot(relative, n);
        if (!(into < 0)) return;
        const Vector<real> along = relative - into * n;
        u = addScaled(u, (-1 - v.c.restitution) * into, n);
        u = subtractScaled(u, real(v.c.friction), along);
    }
    // What is inside all the same, for it began there or was squeezed, is put on the surface.
    HD bool leave(const SolidState& s, Vector<real>& x, Vector<real>& u) const {
        const SolidInStep solid{s, v.c};
        Vector<real> arm = x - s.middle, n{0, 0, 0};
        arm = arm - solid.shiftOf(arm);
        const real depth = -surface(s, SolidInStep::components(s.axis, arm), n);
        if (!(depth > 0)) return false;
        n = turned(s, n);
        x = addScaled(x, depth, n);
        bounce(s, arm, n, u);
        return true;
    }
    static constexpr int mostMeetings = 8;
};

}  // namespace spindrift::LANES
