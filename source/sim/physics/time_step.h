// How long a step can be.
#pragma once

#include "sim/particles/view.h"

namespace spindrift::LANES {

// The largest speed and acceleration, for the time step; with shifting also the sum of rho0/rho.
struct Extremes {
    float speed2 = 0, acceleration2 = 0;  // (m/s)^2, (m/s²)^2
    double volume = 0, count = 0;
    HD_OUT void add(const Extremes& o) {
        speed2 = o.speed2 > speed2 ? o.speed2 : speed2;
        acceleration2 = o.acceleration2 > acceleration2 ? o.acceleration2 : acceleration2;
        volume += o.volume, count += o.count;
    }
};
template <bool volume> struct FindExtremes {
    Particles p;
    real restDensity;
    HD void addTo(Extremes& e, int i) const {
        if (p.id[i] < 0) return;
        const Vector<real> u = load(p.velocity, i), a = load(p.acceleration, i);
        Extremes one{float(dot(u, u)), float(dot(a, a))};
        if constexpr (volume)
            one.volume = double(restDensity * load(p.inverseDensity, i)), one.count = 1;
        e.add(one);
    }
};

// Courant's limit, s.
HD inline real acousticStep(const StepParameters& c, real speed) {
    return c.cfl * (c.support / 2) / (c.fastestSound + max(max(speed, c.solidSpeed), c.leastSpeed));
}
// A step is shorter where whole ones would miss the time at which the run stops.
HD inline double untilStop(const StepState& s, double dt) {
    const double left = s.stop - s.time;
    return left > 0 && left < 1e9 * dt ? left / ceil(left / dt * (1 - 1e-9)) : dt;
}

// A time to stop at is reached exactly, whatever sums of steps are rounded to.
HD inline void advanceTime(StepState& s, double dt) {
    s.time += dt;
    if (s.stop - s.time < 1e-6 * dt && s.time - s.stop < 1e-6 * dt) s.time = s.stop;
}

// dt from the sound speed, the largest velocity and acceleration, and the viscosity (Monaghan 1992,
// Morris 1997).
struct ChooseTimeStep {
    using Index = int;
    View v;
    const Extremes* extremes;
    HD void operator()(int) const {
        const StepParameters& c = v.c;
        double dt = c.fixedStep;
        real solids = 0;  // that float
        for (int s = 0; s < v.solidCount; ++s) solids = max(solids, v.solids[s].speed);
        const real speed = squareRoot(real(extremes->speed2));
        if (dt <= 0) {
            const real pull = squareRoot(real(extremes->acceleration2));
            const real fastest = min(acousticStep(c, max(speed, solids)), c.maxStep);
            dt = v.state->share *
                 min(fastest, real(0.25) * squareRoot(c.support / 2 / max(pull, real(1e-12))));
        }
        v.state->longest = dt;
        if (c.fixedStep <= 0) dt = untilStop(*v.state, dt);
        v.state->dt = dt;
        v.state->speed = speed;
        v.state->volume = extremes->count > 0 ? extremes->volume / extremes->count : 1;
        advanceTime(*v.state, dt);
        ++v.state->steps;
    }
};

}  // namespace spindrift::LANES
