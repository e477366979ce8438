// Particles that come and leave: held before a mouth, let go in it, new ones behind them, and what
// is in a sink taken out.
#pragma once

#include "scene/sources.h"
#include "sim/neighbours/neighbours.h"
#include "sim/particles/sort_passes.h"
#include "sim/physics/kernels.h"

namespace spindrift::LANES {

// A source: its mouth's middle and axes (m, along the normal, across it and up); half the width and
// height that others keep out of, or the radius where it is a disc, and how far behind the mouth;
// the distance between particles, how far behind it they begin, and its keys (scene/sources.h).
struct SourceFace {
    Vector<real> middle, normal, across, up;
    real halfWidth, halfHeight, radius;
    double apart;
    real behind, depth;
    int firstKey, endKey;
};
struct SourcePoint {
    Vector<real> at;  // m, in the mouth
    double share;     // of the mean velocity
    int face;
};
struct SinkBox {
    Vector<real> low, high;  // m
};

// Of a run: how many have come and left, how many there are, how many could not come; and the time
// until which all that is due has come. Ids go on from that of the run's first particle to come.
struct Tally {
    double time = 0;  // s
    int64_t came = 0, left = 0, missed = 0;
    int there = 0, firstId = 0;
};

// What all these passes know.
struct SourceView {
    const SourceFace* faces;
    const SourcePoint* points;
    const SourceKey* keys;
    const SinkBox* sinks;
    int faceCount, pointCount, sinkCount;
    const Tally* tally;

    // Of fluid from a point at a time: m, that it has gone on by, and m/s.
    struct Motion {
        double way, speed;
    };
    HD Motion at(const SourceFace& face, double time) const {
        Motion m{0, 0};
        for (int k = face.firstKey; k < face.endKey && keys[k].time <= time; ++k) {
            const double s = time - keys[k].time;
            m = {keys[k].way + (keys[k].speed + keys[k].slope * s / 2) * s,
                 keys[k].speed + keys[k].slope * s};
        }
        return m;
    }
    HD Motion at(const SourcePoint& p, double time) const {
        const Motion m = at(faces[p.face], time);
        return {p.share * m.way, p.share * m.speed};
    }
    // How many of its particles have come by a time.
    HD int64_t comeBy(const SourcePoint& p, double time) const {
        return int64_t(at(p, time).way / faces[p.face].apart);
    }
    HD bool isDue(const SourcePoint& p, double now) const {
        return comeBy(p, now) > comeBy(p, tally->time);
    }
};

struct Count {
    int64_t number = 0;
    float farthest = 0;  // m, that any was moved
    HD_OUT void add(const Count& o) {
        number += o.number;
        farthest = o.farthest > farthest ? o.farthest : farthest;
    }
};

// The shortest way out of what is held behind a mouth that stays in the domain.
struct WayOut {
    Vector<real> place, low, high;
    real distance = real(1e30);
    Vector<real> direction{0, 0, 0};
    HD void consider(real far, Vector<real> to) {
        const Vector<real> end = addScaled(place, far, to);
        const bool inside = end.x >= low.x && end.x <= high.x && end.y >= low.y &&
                            end.y <= high.y && end.z >= low.z && end.z <= high.z;
        if (inside && far < distance) distance = far, direction = to;
    }
};

// Of particles that are held: the velocity of now, until they are in the mouth. Of others: they are
// kept out of that stretch, where new ones would come upon them. Of all: those in a sink leave, and
// are counted. Their slots are then as those that never held any.
struct HoldAndDrain {
    View v;
    SourceView sources;
    HD void addTo(Count& left, int i) const {
        if (v.fluid.id[i] < 0) return;
        const Vector<real> x = load(v.fluid.position, i);
        if (const int point = int(load(v.fluid.heldBy, i)); point > 0)
            hold(i, sources.points[point - 1], x);
        else
            for (int f = 0; f < sources.faceCount; ++f) keepOut(left, i, x, sources.faces[f]);
        if (!inSink(x)) return;
        left.add({1});
        v.fluid.id[i] = -1;
        makeEmpty(v, i);
    }
    HD void hold(int i, const SourcePoint& p, Vector<real> x) const {
        const Vector<real> normal = sources.faces[p.face].normal;
        if (dot(x - p.at, normal) >= 0) return store(v.fluid.heldBy, i, real(0));
        const Vector<real> u = real(sources.at(p, v.state->time).speed) * normal;
        store(v.fluid.velocity, i, u);
        if (v.fluid.keptVelocity.data) store(v.fluid.keptVelocity, i, u);
    }
    HD void keepOut(Count& moved, int i, Vector<real> x, const SourceFace& f) const {
        const Vector<real> arm = x - f.middle;
        const real n = dot(arm, f.normal), a = dot(arm, f.across), b = dot(arm, f.up);
        if (n >= 0 || n <= -f.depth) return;
        WayOut out{x, v.c.low, v.c.high};
        const Vector<real> none{0, 0, 0};
        if (f.radius > 0) {
            const real r = squareRoot(a * a + b * b);
            if (r >= f.radius) return;
            const real inverse = 1 / max(r, real(1e-9));
            out.consider(f.radius - r, (inverse * a) * f.across + (inverse * b) * f.up);
        } else {
            const real across = f.halfWidth - max(a, -a), up = f.halfHeight - max(b, -b);
            if (across <= 0 || up <= 0) return;
            out.consider(across, a > 0 ? f.across : none - f.across);
            out.consider(up, b > 0 ? f.up : none - f.up);
        }
        out.consider(n + f.depth, none - f.normal);
        const bool forwards = !(out.distance < -n);
        if (forwards) out.distance = -n, out.direction = f.normal;
        const real least = forwards ? real(sources.at(f, v.state->time).speed) : real(0);
        const Vector<real> u = load(v.fluid.velocity, i);
        const real more = max(least - dot(u, out.direction), real(0));
        store(v.fluid.position, i, addScaled(x, out.distance, out.direction));
        store(v.fluid.velocity, i, addScaled(u, more, out.direction));
        moved.add({0, float(out.distance)});
    }
    HD bool inSink(Vector<real> x) const {
        for (int k = 0; k < sources.sinkCount; ++k) {
            const SinkBox& s = sources.sinks[k];
            if (x.x >= s.low.x && x.x <= s.high.x && x.y >= s.low.y && x.y <= s.high.y &&
                x.z >= s.low.z && x.z <= s.high.z)
                return true;
        }
        return false;
    }
    HD static void makeEmpty(const View& v, int i) {
        const real far = 2 * farAway * real(1 + i % 4);
        const Vector<real> none{0, 0, 0}, there{far, far, far};
        store(v.fluid.position, i, there);
        store(v.fluid.velocity, i, none);
        store(v.fluid.heldBy, i, real(0));
        const Particles& p = v.fluid;
        if (p.density.data) store(p.density, i, v.c.restDensity);
        if (p.densityRate.data) store(p.densityRate, i, real(0));
        if (p.keptPosition.data) store(p.keptPosition, i, there);
        if (p.keptVelocity.data) store(p.keptVelocity, i, none);
        if (p.keptDensity.data) store(p.keptDensity, i, v.c.restDensity);
        store(p.pressureOverRho2, i, real(0));
        if (p.shiftVelocity.data)
            store(p.shiftVelocity, i, none), store(p.shiftAcceleration, i, none);
        store(p.acceleration, i, none);
    }
};

// Slots that hold no particle, before any has come there.
struct ClearSlots {
    using Index = int;
    View v;
    int first;
    HD void operator()(int i) const {
        if (i < first) return;
        v.fluid.id[i] = -1;
        HoldAndDrain::makeEmpty(v, i);
    }
};

// How many particles are due.
struct CountDue {
    SourceView sources;
    const StepState* state;
    HD void addTo(Count& due, int point) const {
        if (sources.isDue(sources.points[point], state->time)) due.add({1});
    }
};

// A new particle for each point where one is due, in a slot of its own behind the others; none as
// long as not all would have room. `free`: the first such slot.
struct Come {
    static constexpr int64_t mostId = 0x7fffffff;
    View v;
    SourceView sources;
    const int* free;
    int most;
    HD void addTo(Count& came, int point) const {
        const SourcePoint& p = sources.points[point];
        const double now = v.state->time;
        if (!sources.isDue(p, now) || !hasRoom()) return;
        const SourceFace& face = sources.faces[p.face];
        const SourceView::Motion m = sources.at(p, now);
        const int64_t number = sources.comeBy(p, now), id = idOf(number, point);
        if (id > mostId) return;
        const real ahead = real(m.way - double(number) * face.apart);
        const Vector<real> x = addScaled(p.at, ahead - face.behind, face.normal),
                           u = real(m.speed) * face.normal;
        const int i = *free + point;
        HoldAndDrain::makeEmpty(v, i);
        v.fluid.id[i] = int(id);
        store(v.fluid.position, i, x);
        store(v.fluid.velocity, i, u);
        store(v.fluid.heldBy, i, real(point + 1));
        if (v.fluid.keptPosition.data) store(v.fluid.keptPosition, i, x);
        if (v.fluid.keptVelocity.data) store(v.fluid.keptVelocity, i, u);
        came.add({1});
    }
    HD int64_t idOf(int64_t number, int point) const {
        return sources.tally->firstId + (number - 1) * sources.pointCount + point;
    }
    HD bool hasRoom() const { return sources.tally->there + sources.pointCount <= most; }
};

// Ends what the others have begun.
struct KeepTally {
    using Index = int;
    const StepState* state;
    const Count *left, *due, *came;
    Tally* tally;
    HD void operator()(int) const {
        Tally& t = *tally;
        t.time = state->time;
        t.came += came->number, t.left += left->number;
        t.missed += due->number - came->number;
        t.there += int(came->number - left->number);
    }
};

// What a mouth's fluid would have of pressure in the flow that it comes into (Tafuni 2018
// extrapolate linearly, too): the mean of the free particles around, and where there are none of
// the held ones ahead, which have had it since the last step. With a pressure of its own, and none
// behind it, fluid that is pressed on would go back into the mouth. Where density is carried it is
// that which is averaged, otherwise p / rho^2. As sums that are the same for both of a pair, for
// lists that hold each pair once.
template <class Kernel, Lists which, bool carried> struct BorrowPressure {
    using Index = ICluster;
    using R = Real<ICluster>;
    static constexpr double ofHeld = 1e-3;  // their weight
    View v;
    HD void operator()(ICluster i) const {
        const Vector<R> x = load(v.fluid.position, i);
        const Share<R> own = input(i);
        Vector<R> sum{R(0), R(0), R(0)};
        forNeighbours<lists>(v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            sum = sum + of(p, own, input(j));
        });
        finish(i, total(sum));
    }
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Active;
    static constexpr bool opposite = false;
    template <class Number> struct Share { Number value, weight; };
    HD ScalarField source() const { return carried ? v.fluid.density : v.fluid.pressureOverRho2; }
    HD VectorField field() const { return v.fluid.acceleration; }  // forces come later
    template <class I> HD Share<Real<I>> input(I i) const {
        using Number = Real<I>;
        const Number weight =
            select(load(v.fluid.heldBy, i) > Number(0), Number(real(ofHeld)), Number(1));
        return {weight * load(source(), i), weight};
    }
    HD Vector<R> of(const Pair<R>& p, Share<R> own, Share<R> other) const {
        const R w = valueOf<Kernel>(v.c, p.q);
        return {w * (own.value + other.value), w * (own.weight + other.weight), w};
    }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
    HD void finish(ICluster i, Vector<R> sum) const {
        const Share<R> own = input(i);
        const R values = sum.x - own.value * sum.z, weights = sum.y - own.weight * sum.z,
                least = real(1e-6), zero = 0;
        const R mean = select(weights > least, values / max(weights, least), load(source(), i));
        store(field(), i, {mean, zero, zero});
    }
};
template <bool carried> struct TakePressure {
    using Index = int;
    View v;
    HD void operator()(int i) const {
        if (!(load(v.fluid.heldBy, i) > 0)) return;
        store(carried ? v.fluid.density : v.fluid.pressureOverRho2, i,
              load(v.fluid.acceleration, i).x);
    }
};

// What is held feels no forces, and is not shifted.
struct HoldBack {
    using Index = int;
    View v;
    HD void operator()(int i) const {
        const Particles& p = v.fluid;
        if (!(load(p.heldBy, i) > 0)) return;
        const Vector<real> none{0, 0, 0};
        store(p.acceleration, i, none);
        if (p.pressureAcceleration.data) store(p.pressureAcceleration, i, none);
        if (p.shiftVelocity.data)
            store(p.shiftVelocity, i, none), store(p.shiftAcceleration, i, none);
    }
};

}  // namespace spindrift::LANES
