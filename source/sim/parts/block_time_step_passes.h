// Steps of their own for particles (time.mode local). A step of the whole is twice what cfl says;
// in it each particle takes one, two, four, ... steps, as its speed and acceleration ask for, and
// forces are evaluated only where a particle is active. A particle's velocity changes where its own
// step begins, so that in between it is where its straight line leads: neighbours see nothing
// extrapolated. Blocks of cells whose surroundings have been calm for long rest: they are neither
// evaluated nor moved until something comes near.
#pragma once

#include "sim/physics/density.h"
#include "sim/physics/time_step.h"

namespace spindrift::LANES {

// Parts of a step that particles' own steps are whole numbers of: 1/64 is the shortest.
inline constexpr int deepestTimeBin = 6, parts = 1 << deepestTimeBin;
// What rests is decided every few steps, in which nothing crosses a spacing. So many decisions a
// block's surroundings must have been calm for before it rests, and so many after which it wakes if
// any neighbour is awake: each time that nothing has come of it twice as many. (Always as many, and
// a still pool of 18,000 was not at rest after 16 s; so it is after 6.5.)
inline constexpr int stepsToDecide = 8, calmDecisions = 32, firstSleep = 96,
                     longestSleep = 64 * firstSleep;
HD inline bool decides(const StepState& s) {
    return s.substep == 0 && s.steps % stepsToDecide == 0;
}

HD inline bool isActive(real timeBin, const StepState& s) { return timeBin >= real(s.timeBin); }

// f(first, end) for the stretches of slots that block b is, of fluid or walls, by where particles
// were sorted in.
template <class F>
HD inline void forStretches(const View& v, const int* cellStart, int b, const F& f) {
    const Blocks& blocks = v.blocks;
    const Int3 at{b % blocks.count.x, b / blocks.count.x % blocks.count.y,
                  b / (blocks.count.x * blocks.count.y)};
    auto end = [](int k, int count, int size, int cells) {
        return k + 1 == count ? cells : (k + 1) * size;
    };
    const int lastX = end(at.x, blocks.count.x, blocks.size.x, v.grid.cells.x),
              lastY = end(at.y, blocks.count.y, blocks.size.y, v.grid.cells.y);
    const int lastZ = end(at.z, blocks.count.z, blocks.size.z, v.grid.cells.z);
    for (int z = at.z * blocks.size.z; z < lastZ; ++z)
        for (int y = at.y * blocks.size.y; y < lastY; ++y) {
            const int* row = cellStart + v.grid.row(y, z);
            f(row[at.x * blocks.size.x], row[lastX]);
        }
}
// f(i) for its particles.
template <class F>
HD inline void forParticles(const View& v, const int* cellStart, int b, const F& f) {
    forStretches(v, cellStart, b, [&](int first, int end) {
        for (int i = first; i < end; ++i) f(i);
    });
}

// f(b) for block b and those around it.
template <class F> HD inline void forBlocksAround(const View& v, int b, const F& f) {
    const Int3 n = v.blocks.count;
    const int x = b % n.x, y = b / n.x % n.y, z = b / (n.x * n.y);
    auto first = [](int k, int wraps) { return wraps ? k - 1 : k > 0 ? k - 1 : 0; };
    auto last = [](int k, int count, int wraps) { return wraps || k + 1 < count ? k + 1 : k; };
    for (int c = first(z, v.grid.wraps.z); c <= last(z, n.z, v.grid.wraps.z); ++c)
        for (int r = first(y, v.grid.wraps.y); r <= last(y, n.y, v.grid.wraps.y); ++r)
            for (int a = first(x, v.grid.wraps.x); a <= last(x, n.x, v.grid.wraps.x); ++a)
                f((Grid::wrapped(c, n.z) * n.y + Grid::wrapped(r, n.y)) * n.x +
                  Grid::wrapped(a, n.x));
}

// At the beginning of a step: how long it is. It ends where the run is to be looked at.
struct BeginStep {
    using Index = int;
    View v;
    HD void operator()(int) const {
        StepState& s = *v.state;
        if (s.substep == 0)
            s.longest = untilStop(s, min(real(2) * acousticStep(v.c, real(s.speed)), v.c.maxStep));
    }
};

// Of each block its mean square speed, or that of moving walls in it; -1 where nothing moves.
struct MeasureBlocks {
    using Index = int;
    View v;
    HD void operator()(int b) const {
        if (!decides(*v.state)) return;
        real sum = 0, walls2 = 0;
        int count = 0;
        forParticles(v, v.fluidNearFluid.cellStart, b, [&](int i) {
            const Vector<real> u = load(v.fluid.velocity, i);
            if (v.fluid.id[i] >= 0) sum += dot(u, u), ++count;
        });
        if (v.walls.ownVelocity.data)
            forParticles(v, v.wallsNearFluid.cellStart, b, [&](int i) {
                const Vector<real> u = load(v.walls.ownVelocity, i);
                if (v.walls.id[i] >= 0) walls2 = max(walls2, dot(u, u));
            });
        const bool still = sum + walls2 == 0 && (count == 0 || v.blocks.calm[b] >= calmDecisions);
        v.blocks.speed2[b] = still ? real(-1) : max(sum / real(count > 0 ? count : 1), walls2);
    }
};

// What rests: blocks whose surroundings have long been slower than restSpeed c. They wake when
// something faster comes near, and after a while if any of their neighbours is awake, for these may
// have changed slowly. Fluid that rests doesn't move at all.
struct RestBlocks {
    using Index = int;
    View v;
    HD void operator()(int b) const {
        if (!decides(*v.state)) return;
        int &calm = v.blocks.calm[b], &sleepLength = v.blocks.sleepLength[b];
        const bool rested = calm >= calmDecisions;
        if (!rested && v.blocks.speed2[b] < 0) return;  // it is empty
        real speed2 = -1;
        forBlocksAround(v, b, [&](int other) { speed2 = max(speed2, v.blocks.speed2[other]); });
        const real rest = v.c.restSpeed * v.c.soundSpeed, limit = rested ? wake * rest : rest;
        const bool disturbed = speed2 >= limit * limit, slept = calm >= sleepLength && speed2 >= 0;
        if (rested && (disturbed || slept))
            sleepLength = disturbed ? firstSleep : min(2 * sleepLength, longestSleep);
        calm = disturbed || slept ? 0 : min(calm + 1, sleepLength);
        const bool rests = calm >= calmDecisions;
        forParticles(v, v.fluidNearFluid.cellStart, b, [&](int i) {
            if (v.fluid.id[i] < 0) return;
            store(v.fluid.timeBin, i, rests ? resting : real(0));
            if (!rests) return;
            store(v.fluid.velocity, i, Vector<real>{0, 0, 0});
            if (v.fluid.densityRate.data) store(v.fluid.densityRate, i, real(0));
        });
    }
    HD static int min(int a, int b) { return a < b ? a : b; }
    // Falling asleep disturbs the neighbours, by about the speed that was there.
    static constexpr real wake = 4;
};

// Clusters with an active particle.
struct FindActiveClusters {
    using Index = int;
    View v;
    HD void operator()(int cluster) const {
        real shortest = resting;
        for (int i = cluster * clusterSize; i < (cluster + 1) * clusterSize; ++i)
            shortest = max(shortest, load(v.fluid.timeBin, i));
        v.fluid.active[cluster] = isActive(shortest, *v.state) ? Active
                                  : shortest < 0               ? Sleeping
                                                               : Inactive;
    }
};
struct FindActiveBlocks {
    using Index = int;
    View v;
    HD void operator()(int b) const {
        bool active = false;
        forStretches(v, v.fluidNearFluid.cellStart, b, [&](int first, int end) {
            for (int c = first / clusterSize; c * clusterSize < end; ++c)
                active = active || v.fluid.active[c] == Active;
        });
        v.blocks.active[b] = active;
    }
};
// Blocks in touch with an active one, SleepingHalo those in which any particle rests.
struct FindNearBlocks {
    using Index = int;
    View v;
    HD void operator()(int b) const {
        bool near = false, rests = false;
        forBlocksAround(v, b, [&](int other) { near = near || v.blocks.active[other]; });
        if (near)
            forParticles(v, v.fluidNearFluid.cellStart, b, [&](int i) {
                rests = rests || (load(v.fluid.timeBin, i) < 0 && v.fluid.id[i] >= 0);
            });
        v.blocks.near[b] = rests ? SleepingHalo : near ? NearActive : Inactive;
    }
};
// Of these blocks the clusters of fluid and walls; and of those around watched ones, whose pairs
// with them count as well.
struct SpreadActive {
    using Index = int;
    View v;
    HD void operator()(int b) const {
        const uint8_t near = v.blocks.near[b];
        bool besideHalo = near != Inactive;
        forBlocksAround(v, b, [&](int other) {
            besideHalo = besideHalo || v.blocks.near[other] == SleepingHalo;
        });
        if (!besideHalo) return;
        forStretches(v, v.fluidNearFluid.cellStart, b, [&](int first, int end) {
            for (int c = first / clusterSize; c * clusterSize < end; ++c)
                raise(v.fluid.active[c], near == Inactive ? uint8_t(NearActive) : near);
        });
        if (near == Inactive) return;
        forStretches(v, v.wallsNearFluid.cellStart, b, [&](int first, int end) {
            for (int c = first / clusterSize; c * clusterSize < end; ++c)
                raise(v.walls.active[c], Active);
        });
    }
    // Blocks may share a cluster, which is then the most that any of them says. (One that is a
    // single particle has a single block.)
    HD static void raise(uint8_t& flag, uint8_t value) {
#ifdef __CUDA_ARCH__
        if (flag < value) flag = value;
#else
        uint8_t before = __atomic_load_n(&flag, __ATOMIC_RELAXED);
        while (before < value && !__atomic_compare_exchange_n(&flag, &before, value, true,
                                                              __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
        }
#endif
    }
};
struct ClearActive {
    using Index = int;
    Particles p;
    HD void operator()(int cluster) const { p.active[cluster] = Inactive; }
};

// Where a particle's own step begins: how long it is, and v += a dt. The longest is for calm fluid,
// dt <= 0.05 sqrt(h/(eps+|a|)) and 0.1 h/(eps+|u|) for cfl = 0.4, in the form of Reinhardt 2017
// (there 0.02 and 0.05, with which half of a dam break takes half the step and errors are the
// same); the rest takes what would be good for all if all were like it.
struct KickActive {
    using Index = Lanes4;
    using R = Real<Lanes4>;
    View v;
    HD void operator()(Lanes4 i) const {
        if (!isActive(v.fluid, i)) return;
        const R before = load(v.fluid.timeBin, i), one = 1, now = real(v.state->timeBin);
        const Vector<R> u = load(v.fluid.velocity, i), a = load(v.fluid.acceleration, i);
        const R pull = squareRoot(dot(a, a)) + R(little), speed = squareRoot(dot(u, u)) + R(little);
        const R h = v.c.support / 2, cfl = v.c.cfl, fall = squareRoot(h / pull);
        const R calm = cfl * min(R(real(0.125)) * fall, R(real(0.25)) * h / speed);
        const R wanted =
            max(calm, min(cfl * h / (R(v.c.soundSpeed) + speed), R(real(0.25)) * fall));
        R step = real(v.state->longest / (1 << v.state->timeBin)), timeBin = now;
        for (int k = v.state->timeBin; k < deepestTimeBin; ++k) {
            const auto tooLong = step > wanted;
            step = select(tooLong, R(real(0.5)) * step, step);
            timeBin = select(tooLong, timeBin + one, timeBin);
        }
        const auto isActive = before > now - R(real(0.5));
        store(v.fluid.timeBin, i, select(isActive, timeBin, before));
        store(v.fluid.velocity, i, addScaled(u, select(isActive, step, R(0)), a));
    }
    static constexpr real little = real(1e-3);  // m/s, m/s²
};

// The largest speed, the deepest time bin, and how many particles were awake and active.
struct Motion {
    float speed2 = 0;  // (m/s)^2
    int deepest = 0;
    double awake = 0, active = 0;
    HD_OUT void add(const Motion& o) {
        speed2 = o.speed2 > speed2 ? o.speed2 : speed2;
        deepest = o.deepest > deepest ? o.deepest : deepest;
        awake += o.awake, active += o.active;
    }
};
struct FindMotion {
    Particles p;
    const StepState* state;
    HD void addTo(Motion& m, int i) const {
        const real timeBin = load(p.timeBin, i);
        if (timeBin < 0) return;
        const Vector<real> u = load(p.velocity, i);
        m.add({float(dot(u, u)), int(timeBin), 1, isActive(timeBin, *state) ? 1.0 : 0.0});
    }
};

// How long it is until the next particle is active.
struct ChooseSubstep {
    using Index = int;
    View v;
    const Motion* motion;
    int count;  // of particles
    HD void operator()(int) const {
        StepState& s = *v.state;
        const int part = parts >> motion->deepest, next = (s.substep / part + 1) * part;
        s.dt = s.longest * (next - s.substep) / parts;
        advanceTime(s, s.dt);
        s.substep = next % parts;
        s.timeBin = 0;
        while (s.substep % (parts >> s.timeBin) != 0) ++s.timeBin;
        if (s.substep == 0) ++s.steps;
        s.speed = squareRoot(real(motion->speed2));
        s.evaluations += motion->active;
        s.awake = motion->awake / count;
        s.allActive = s.timeBin == 0 && motion->awake == count && !decides(s);
        s.allRest = motion->awake == 0 && !decides(s);
    }
};

// All are active at the beginning of the next step.
struct WakeParticles {
    using Index = int;
    Particles p;
    HD void operator()(int i) const { store(p.timeBin, i, p.id[i] < 0 ? resting : real(0)); }
};
struct WakeBlocks {
    using Index = int;
    Blocks blocks;
    HD void operator()(int b) const { blocks.calm[b] = 0, blocks.sleepLength[b] = firstSleep; }
};

}  // namespace spindrift::LANES
