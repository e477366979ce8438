// Particles that come and leave: held before a mouth, let go in it, new ones behind them, and what
// is in a sink taken out.
#pragma once

#include "scene/sources.h"
#include "sim/particles/sort_passes.h"

namespace spindrift::LANES {

// What a source's points have in common: its normal, the distance between particles and how far
// behind the mouth the last one begins (m), and its keys (scene/sources.h).
struct SourceFace {
    Vector<real> normal;
    double apart;
    real behind;
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
    int pointCount, sinkCount;
    const Tally* tally;

    // Of fluid from a point at a time: m, that it has gone on by, and m/s.
    struct Motion {
        double way, speed;
    };
    HD Motion at(const SourcePoint& p, double time) const {
        const SourceFace& face = faces[p.face];
        Motion m{0, 0};
        for (int k = face.firstKey; k < face.endKey && keys[k].time <= time; ++k) {
            const double s = time - keys[k].time;
            m = {keys[k].way + (keys[k].speed + keys[k].slope * s / 2) * s,
                 keys[k].speed + keys[k].slope * s};
        }
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
    HD_OUT void add(const Count& o) { number += o.number; }
};

// Of particles that are held: the velocity of now, until they are in the mouth. Of all: those in a
// sink leave, and are counted. Their slots are then as those that never held any.
struct HoldAndDrain {
    View v;
    SourceView sources;
    HD void addTo(Count& left, int i) const {
        if (v.fluid.id[i] < 0) return;
        const Vector<real> x = load(v.fluid.position, i);
        if (const int point = int(load(v.fluid.heldBy, i)); point > 0)
            hold(i, sources.points[point - 1], x);
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
