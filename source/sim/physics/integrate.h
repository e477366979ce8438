// The passes that move particles in time.
#pragma once

#include "sim/particles/sort_passes.h"

namespace spindrift::LANES {

// What integrators are made of: v += a dt (Kick), x += v dt (Drift); what leaves the box is put
// back on its face and bounces, or enters on the other side. In parts where rates of velocity's
// neighbours come between: of density, and of shifting.
enum Advance : unsigned {
    Kick = 1,
    HalfKick = 2,  // half: by dt / 2
    Drift = 4,
    HalfDrift = 8,
    DriftDensity = 16,
    DriftShifted = 32,   // with Drift: these as well
    KeepVolume = 64,     // of all particles, by their densities
    Keep = 128,          // first: position, velocity and density are kept
    Resume = 256,        // starts from what was kept instead of what is there
    KeepVelocity = 512,  // last, but before KickOn
    KickOn = 1024,       // last: another half kick
    PressureKick = 2048  // by solved pressures
};

template <unsigned what> struct Integrate {
    using Index = Lanes4;
    using R = Real<Lanes4>;
    View v;
    HD void operator()(Lanes4 i) const {
        if (!isActive<Inactive>(v.fluid, i)) return;  // its cluster rests
        const R dt = real(v.state->dt), half = real(0.5) * real(v.state->dt),
                way = what & HalfDrift ? half : dt;
        constexpr bool resumesVelocity = (what & Resume) && (what & (Kick | HalfKick));
        Vector<R> u = load(resumesVelocity ? v.fluid.keptVelocity : v.fluid.velocity, i);
        if constexpr (what & Keep) keep(i, u);
        if constexpr (what & Kick) u = addScaled(u, dt, load(v.fluid.acceleration, i));
        if constexpr (what & PressureKick)
            u = addScaled(u, dt, load(v.fluid.pressureAcceleration, i));
        if constexpr (what & HalfKick) u = addScaled(u, half, load(v.fluid.acceleration, i));
        if constexpr (what & DriftDensity) driftDensity(i, way);
        if constexpr (what & (Drift | HalfDrift)) drift(i, way, u);
        if constexpr (what & KeepVelocity) store(v.fluid.keptVelocity, i, u);
        if constexpr (what & KickOn) u = addScaled(u, half, load(v.fluid.acceleration, i));
        store(v.fluid.velocity, i, resting(i, u));
    }
    HD void keep(Lanes4 i, Vector<R> u) const {
        store(v.fluid.keptPosition, i, load(v.fluid.position, i));
        store(v.fluid.keptVelocity, i, u);
        if constexpr (what & DriftDensity) store(v.fluid.keptDensity, i, load(v.fluid.density, i));
    }
    // Empty slots see each other as well: in thick fluid their speed would grow until it is none,
    // and a neighbour's weight of 0 times that is no number.
    HD Vector<R> resting(Lanes4 i, Vector<R> u) const {
        const auto empty = load(v.fluid.position, i).x > R(farAway);
        const R zero = 0;
        return {select(empty, zero, u.x), select(empty, zero, u.y), select(empty, zero, u.z)};
    }
    // Where fluid fills its space and gradients are differences, a pressure that is the same
    // everywhere does nothing, and its drift, the sum of small errors of div u, is taken out by
    // keeping the volume of all particles.
    HD void driftDensity(Lanes4 i, R dt) const {
        R rho = mulAdd(dt, load(v.fluid.densityRate, i),
                       load(what & Resume ? v.fluid.keptDensity : v.fluid.density, i));
        if constexpr (what & KeepVolume) rho = R(real(v.state->volume)) * rho;
        // Empty slots lie in few places and see each other there.
        const auto empty = load(v.fluid.position, i).x > R(farAway);
        store(v.fluid.density, i, select(empty, R(v.c.restDensity), rho));
    }
    HD void drift(Lanes4 i, R dt, Vector<R>& u) const {
        const Vector<R> before = load(v.fluid.position, i);
        const Vector<R> from = what & Resume ? load(v.fluid.keptPosition, i) : before;
        Vector<R> x = addScaled(from, dt, u);
        if constexpr (what & DriftShifted) {
            x = addScaled(x, dt, load(v.fluid.shiftVelocity, i));
            u = addScaled(u, dt, load(v.fluid.shiftAcceleration, i));
        }
        const Vector<R> unwrapped = x;
        v.c.period.x > 0 ? wrap(x.x, v.c.period.x)
                         : bounce(x.x, v.c.low.x, v.c.high.x, u.x, u.y, u.z);
        v.c.period.y > 0 ? wrap(x.y, v.c.period.y)
                         : bounce(x.y, v.c.low.y, v.c.high.y, u.y, u.z, u.x);
        v.c.period.z > 0 ? wrap(x.z, v.c.period.z)
                         : bounce(x.z, v.c.low.z, v.c.high.z, u.z, u.x, u.y);
        store(v.fluid.position, i, keepEmpty(before, x));
        if ((what & Drift) && v.solidCount > 0) keepWay(i, from, unwrapped, keepEmpty(before, x));
    }
    // Where the way began that ends here, in a line with it over periodic sides.
    HD void keepWay(Lanes4 i, Vector<R> from, Vector<R> to, Vector<R> place) const {
        if (v.c.period.x > 0) from.x = place.x - (to.x - from.x);
        if (v.c.period.y > 0) from.y = place.y - (to.y - from.y);
        if (v.c.period.z > 0) from.z = place.z - (to.z - from.z);
        store(v.fluid.keptPosition, i, from);
    }
    // The box would pull empty slots in among the particles.
    HD static Vector<R> keepEmpty(Vector<R> before, Vector<R> after) {
        const auto empty = before.x > R(farAway);
        return {select(empty, before.x, after.x), select(empty, before.y, after.y),
                select(empty, before.z, after.z)};
    }
    HD static void wrap(R& x, real period) { x = x - R(period) * roundDown(x * R(1 / period)); }
    HD void bounce(R& x, real low, real high, R& normal, R& tangent1, R& tangent2) const {
        const R inside =
            min(R(high), max(R(low), x));  // in this order what is no number stays none
        const R depth = (x - inside) * (x - inside);
        const auto hit = depth > R(0);
        normal = select(hit, R(-v.c.restitution) * normal, normal);
        tangent1 = select(hit, R(1 - v.c.friction) * tangent1, tangent1);
        tangent2 = select(hit, R(1 - v.c.friction) * tangent2, tangent2);
        x = inside;
    }
};

}  // namespace spindrift::LANES
