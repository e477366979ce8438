// Terms: one pairwise contribution to the acceleration each. A term says why a scene does without it (""
// when it is wanted), what it reads of both particles, and adds itself: between fluid particles (`add`) and between a fluid particle and a
// boundary particle (`addWall`). grad W = gradientNorm/R^5 g x, and what all pairs share, the mass m and
// gradientNorm/R^5, is left out here and multiplied once, at the end of the pass.
#pragma once

#include "scene/scene.h"
#include "sim/neighbours.h"

namespace spindrift::LANES {

enum Needs : unsigned { Velocity = 1, InverseDensity = 2, WallVelocity = 4, Pressure = 8, OwnVelocity = 16 };

// What terms read of one particle.
template <class R> struct State { Vector<R> velocity; R pressureTerm, inverseDensity, pressure; };

template <unsigned needs, class I> HD inline State<Real<I>> loadState(const Particles& p, I i) {
    State<Real<I>> s;
    s.pressureTerm = load(p.pressureTerm, i);
    if constexpr (needs & Velocity) s.velocity = load(p.velocity, i);
    if constexpr (needs & InverseDensity) s.inverseDensity = load(p.inverseDensity, i);
    if constexpr (needs & Pressure) {
        const Real<I> rho = load(p.density, i);
        s.pressure = s.pressureTerm * rho * rho;
    }
    return s;
}

// A boundary particle: its mass in units of m, p / rho^2, the velocity that makes fluid stick to the wall, and the wall's own.
template <class R> struct Wall { R mass, pressureTerm; Vector<R> velocity, own; };

template <unsigned needs, class I> HD inline Wall<Real<I>> loadWall(const Particles& p, I i) {
    Wall<Real<I>> w;
    w.mass = load(p.mass, i);
    w.pressureTerm = load(p.pressureTerm, i);
    if constexpr (needs & WallVelocity) w.velocity = load(p.velocity, i);
    if constexpr (needs & OwnVelocity) w.own = ownVelocity(p, i);
    return w;
}

// What terms add to, summed over neighbours. The pressure part is kept apart because the classic formulation caps it. Moments sum
// (V_j / m) g r r: what gradients are corrected by.
template <class R> struct Acceleration {
    Vector<R> pressure, other;
    Symmetric<R> moments;
    HD void addPressure(R s, Vector<R> r) { pressure = subtractScaled(pressure, s, r); }   // -s r
    HD void addAlong(R s, Vector<R> r) { other = addScaled(other, s, r); }                 // s r, r = x_i - x_j
    HD void addOther(R s, Vector<R> a) { other = addScaled(other, s, a); }                 // s a
};

// The same of one pair, where nothing is kept apart: what lies along r is multiplied by it once.
template <class R> struct PairAcceleration {
    R along;
    Vector<R> other;
    HD void addPressure(R s, Vector<R>) { along -= s; }
    HD void addAlong(R s, Vector<R>) { along += s; }
    HD void addOther(R s, Vector<R> a) { other = addScaled(other, s, a); }
    HD Vector<R> sum(Vector<R> r) const { return addScaled(other, along, r); }
};

// -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W, Monaghan 1992. Walls take part with the pressure that
// ExtrapolateWallPressure gave them; in the classic formulation (and Akinci 2012) they have none.
struct PressureForce {
    static constexpr unsigned needs = 0;
    static constexpr const char* name = "pressure";
    static const char* skipped(const Scene&) { return ""; }
    template <class R, class A>
    HD static void add(const Constants&, const Pair<R>& p, R g, const State<R>& i, const State<R>& j, A& a) {
        a.addPressure(g * (i.pressureTerm + j.pressureTerm), p.r);
    }
    template <class R, class A>
    HD static void addWall(const Constants&, const Pair<R>& p, R g, const State<R>& i, const Wall<R>& b, A& a) {
        a.addPressure(b.mass * g * (i.pressureTerm + b.pressureTerm), p.r);
    }
};

// -(grad p) / rho_i from differences, sum_j V_j (p_j - p_i) grad W, for ComputeForces to divide by the moments: exact for
// linear pressures however the particles lie (Randles & Libersky 1996), where fluid is all around. It does not keep momentum to round-off.
struct CorrectedPressureForce {
    static constexpr unsigned needs = Pressure | InverseDensity;
    static constexpr const char* name = "corrected pressure";
    template <class R> HD static void addDifference(Acceleration<R>& a, R weight, R difference, Vector<R> r) {
        a.moments = addOuter(a.moments, weight, r);
        a.pressure = addScaled(a.pressure, weight * difference, r);
    }
    template <class R>
    HD static void add(const Constants&, const Pair<R>& p, R g, const State<R>& i, const State<R>& j, Acceleration<R>& a) {
        addDifference(a, g * j.inverseDensity, j.pressure - i.pressure, p.r);
    }
    template <class R>
    HD static void addWall(const Constants& c, const Pair<R>& p, R g, const State<R>& i, const Wall<R>& b, Acceleration<R>& a) {
        const R rho0 = c.restDensity;
        addDifference(a, g * b.mass * R(1 / c.restDensity), b.pressureTerm * rho0 * rho0 - i.pressure, p.r);
    }
};

// Laminar viscosity, Morris 1997: sum_j m 2 mu / (rho_i rho_j) (x.grad W) / d^2 v_ij, which has no pole at d = 0; at walls with the velocity
// of ExtrapolateToWalls, so that fluid doesn't slip (Adami 2012).
struct LaminarViscosity {
    static constexpr unsigned needs = Velocity | InverseDensity | WallVelocity;
    static constexpr const char* name = "laminar viscosity";
    static const char* skipped(const Scene& s) {
        if (s.simulation.formulation == Formulation::Classic) return "the classic formulation has another one";
        return s.fluid.viscosity > 0 ? "" : "fluid.viscosity is 0";
    }
    template <class R, class A>
    HD static void add(const Constants& c, const Pair<R>&, R g, const State<R>& i, const State<R>& j, A& a) {
        a.addOther(R(c.laminar) * g * i.inverseDensity * j.inverseDensity, i.velocity - j.velocity);
    }
    template <class R, class A>
    HD static void addWall(const Constants& c, const Pair<R>&, R g, const State<R>& i, const Wall<R>& b, A& a) {
        a.addOther(R(c.laminar) * g * i.inverseDensity * i.inverseDensity * b.mass, i.velocity - b.velocity);
    }
};

// Artificial viscosity, Monaghan 1992, on approach only: sum_j m alpha c h (v.x) / ((d^2 + eta^2) rho) grad W,
// with the mean of 1/rho in place of one over the mean.
struct ArtificialViscosity {
    static constexpr unsigned needs = Velocity | InverseDensity | OwnVelocity;
    static constexpr const char* name = "artificial viscosity";
    static const char* skipped(const Scene& s) {
        if (s.simulation.formulation == Formulation::Classic) return "the classic formulation has none";
        if (s.simulation.formulation == Formulation::TransportVelocity) return "transport_velocity does without";
        return s.fluid.artificialViscosity > 0 ? "" : "fluid.artificial_viscosity is 0";
    }
    template <class R> HD static R approach(const Constants& c, const Pair<R>& p, R g, Vector<R> vij) {
        return R(c.artificial) * g * (min(dot(vij, p.r), R(0)) * p.inverseDistance2);
    }
    template <class R, class A>
    HD static void add(const Constants& c, const Pair<R>& p, R g, const State<R>& i, const State<R>& j, A& a) {
        const R s = approach(c, p, g, i.velocity - j.velocity);
        a.addAlong(s * (i.inverseDensity + j.inverseDensity), p.r);
    }
    template <class R, class A>
    HD static void addWall(const Constants& c, const Pair<R>& p, R g, const State<R>& i, const Wall<R>& b, A& a) {
        const R s = approach(c, p, g, i.velocity - b.own);
        a.addAlong(b.mass * s * (i.inverseDensity + i.inverseDensity), p.r);
    }
};

// The classic formulation's viscosity: nu sum_j m (v_j - v_i) / rho0 (R - d) / (pi R^6); walls slip.
struct ClassicViscosity {
    static constexpr unsigned needs = Velocity;
    static constexpr const char* name = "classic viscosity";
    static const char* skipped(const Scene& s) {
        if (s.simulation.formulation != Formulation::Classic) return "only the classic formulation has it";
        return s.fluid.viscosity > 0 ? "" : "fluid.viscosity is 0";
    }
    template <class R, class A>
    HD static void add(const Constants& c, const Pair<R>& p, R, const State<R>& i, const State<R>& j, A& a) {
        a.addOther(R(c.classicViscosity) * max(R(1) - p.q, R(0)), j.velocity - i.velocity);
    }
    template <class R, class A>
    HD static void addWall(const Constants&, const Pair<R>&, R, const State<R>&, const Wall<R>&, A&) {}
};

template <class... Ts> struct TermList { static constexpr unsigned needs = (0u | ... | Ts::needs); };
using Viscosities = TermList<LaminarViscosity, ArtificialViscosity>;   // of all formulations but the classic one
using OptionalTerms = TermList<LaminarViscosity, ArtificialViscosity, ClassicViscosity>;

// Calls done(TermList<...>) with just the terms this scene wants: a run-time scene becomes a compile-time list.
template <class Done, class... Chosen> auto chooseTerms(const Scene&, Done done, TermList<Chosen...> chosen, TermList<>) {
    return done(chosen);
}
template <class Done, class... Chosen, class T, class... Rest>
auto chooseTerms(const Scene& s, Done done, TermList<Chosen...> chosen, TermList<T, Rest...>) {
    return *T::skipped(s) ? chooseTerms(s, done, chosen, TermList<Rest...>{})
                          : chooseTerms(s, done, TermList<Chosen..., T>{}, TermList<Rest...>{});
}

}  // namespace spindrift::LANES
