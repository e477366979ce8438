// Terms: one pairwise contribution to the acceleration each. A term says why a scene does without
// it ("" when it is wanted), what it reads of both particles, and adds itself: between fluid
// particles (`add`) and between a fluid particle and a boundary particle (`addWall`). grad W =
// gradientNorm/R^5 g x, and what all pairs share, the mass m and gradientNorm/R^5, is left out here
// and multiplied once, at the end of the pass.
#pragma once

#include "scene/formulation.h"
#include "scene/scene.h"
#include "sim/physics/kernels.h"
#include "sim/neighbours/neighbours.h"

namespace spindrift::LANES {

enum Needs : unsigned {
    Velocity = 1,
    InverseDensity = 2,
    WallVelocity = 4,
    Pressure = 8,
    OwnVelocity = 16,
    Density = 32,
    Moments = 64,
    Mixture = 128,
    ViscousVolume = 256,
    Mirrored = 512
};

// What terms read of one particle.
template <class R> struct PairInput {
    Vector<R> velocity;
    R pressureOverRho2, inverseDensity, viscousVolume, pressure, density, rootMassRatio, viscosity,
        mirrored;
};

template <unsigned needs, class I>
HD inline PairInput<Real<I>> loadPairInput(const Particles& p, I i) {
    PairInput<Real<I>> s;
    s.pressureOverRho2 = load(p.pressureOverRho2, i);
    if constexpr (needs & Velocity) s.velocity = load(p.velocity, i);
    if constexpr (needs & InverseDensity) s.inverseDensity = load(p.inverseDensity, i);
    if constexpr (needs & ViscousVolume) s.viscousVolume = load(p.viscousVolume, i);
    if constexpr (needs & Pressure) {
        const Real<I> rho = load(p.density, i);
        s.pressure = s.pressureOverRho2 * rho * rho;
    }
    if constexpr (needs & Mirrored) s.mirrored = load(p.mirrored, i);
    if constexpr (needs & Density) s.density = massRatio(p, i) * load(p.density, i);
    if constexpr (needs & Mixture)
        s.rootMassRatio = squareRoot(load(p.massRatio, i)), s.viscosity = load(p.viscosity, i);
    return s;
}

// A boundary particle: its mass in units of m, p / rho^2, the velocity that makes fluid stick to
// the wall or slip along it as it may, and the one at its surface.
template <class R> struct Wall {
    R mass, pressureOverRho2;
    Vector<R> velocity, own;
    Vector<R> pull;  // 1/rho0 times what pulls at fluid beside it, in its own frame
};

template <unsigned needs, class I> HD inline Wall<Real<I>> loadWall(const Particles& p, I i) {
    Wall<Real<I>> w;
    w.mass = load(p.mass, i);
    w.pressureOverRho2 = load(p.pressureOverRho2, i);
    if constexpr (needs & WallVelocity) w.velocity = load(p.velocity, i);
    if constexpr (needs & OwnVelocity) w.own = surfaceVelocity(p, i);
    return w;
}

// A kernel at one distance, without what all pairs share: what gradients, Laplacians and means are
// sums of. What no term reads isn't computed.
template <class R> struct Weights { R g, viscous, w; };
template <class Kernel, class R> HD inline Weights<R> weights(const StepParameters& c, R q) {
    return {slopeOf<Kernel>(c, q), viscousOf<Kernel>(c, q), valueOf<Kernel>(c, q)};
}

// What terms add to, summed over neighbours. The pressure part is kept apart because the classic
// formulation caps it. Moments sum (V_j / m) g r r: what gradients are corrected by.
template <class R> struct Acceleration {
    Vector<R> pressure, other;
    Symmetric<R> moments;
    HD void addPressure(R s, Vector<R> r) { pressure = subtractScaled(pressure, s, r); }  // -s r
    HD void addAlong(R s, Vector<R> r) { other = addScaled(other, s, r); }  // s r, r = x_i - x_j
    HD void addOther(R s, Vector<R> a) { other = addScaled(other, s, a); }  // s a
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

// -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W, Monaghan 1992. Walls take part with the pressure
// that ExtrapolateWallPressure gave them; in the classic formulation (and Akinci 2012) they have
// none.
struct PressureForce {
    static constexpr unsigned needs = 0;
    static constexpr const char* name = "pressure";
    static const char* skipped(const Scene&) { return ""; }
    template <class R, class A> HD static void add(const StepParameters&, const Pair<R>& p,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        a.addPressure(k.g * (i.pressureOverRho2 + j.pressureOverRho2), p.r);
    }
    template <class R, class A> HD static void addWall(const StepParameters&, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        a.addPressure(b.mass * k.g * (i.pressureOverRho2 + b.pressureOverRho2), p.r);
    }
};

// The same where pressures are solved for: walls mirror the fluid's, and have what fluid at rest
// would have more (solver/pressure_passes.h).
struct MirroredPressureForce {
    static constexpr unsigned needs = Mirrored;
    template <class R, class A> HD static void addWall(const StepParameters&, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        a.addPressure(
            b.mass * k.g *
                (mulAdd(i.pressureOverRho2, i.mirrored, i.pressureOverRho2) - dot(b.pull, p.r)),
            p.r);
    }
};

// -sum_j m (p_i + p_j) / (2 rho_i rho_j) grad W, Mueller 2003, divided by rho_i.
struct MeanPressureForce {
    static constexpr unsigned needs = Pressure | InverseDensity;
    static constexpr const char* name = "mean pressure";
    template <class R, class A> HD static void add(const StepParameters&, const Pair<R>& p,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        a.addPressure(
            k.g * R(real(0.5)) * (i.pressure + j.pressure) * (i.inverseDensity * j.inverseDensity),
            p.r);
    }
    template <class R, class A> HD static void addWall(const StepParameters& c, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        const R rho0 = c.restDensity;
        a.addPressure(b.mass * k.g * R(real(0.5)) *
                          mulAdd(i.pressure, R(1 / c.restDensity), rho0 * b.pressureOverRho2) *
                          i.inverseDensity,
                      p.r);
    }
};

// -(grad p) / rho_i from differences, sum_j V_j (p_j - p_i) grad W, for ComputeForces to divide by
// the moments: exact for linear pressures however the particles lie (Randles & Libersky 1996),
// where fluid is all around. It does not keep momentum to round-off.
struct CorrectedPressureForce {
    static constexpr unsigned needs = Pressure | InverseDensity | Moments;
    static constexpr const char* name = "corrected pressure";
    template <class R>
    HD static void addDifference(Acceleration<R>& a, R weight, R difference, Vector<R> r) {
        a.moments = addOuter(a.moments, weight, r);
        a.pressure = addScaled(a.pressure, weight * difference, r);
    }
    template <class R> HD static void add(const StepParameters&, const Pair<R>& p,
                                          const Weights<R>& k, const PairInput<R>& i,
                                          const PairInput<R>& j, Acceleration<R>& a) {
        addDifference(a, k.g * j.inverseDensity, j.pressure - i.pressure, p.r);
    }
    template <class R> HD static void addWall(const StepParameters& c, const Pair<R>& p,
                                              const Weights<R>& k, const PairInput<R>& i,
                                              const Wall<R>& b, Acceleration<R>& a) {
        const R rho0 = c.restDensity;
        addDifference(a, k.g * b.mass * R(1 / c.restDensity),
                      b.pressureOverRho2 * rho0 * rho0 - i.pressure, p.r);
    }
};

// What viscosity makes of a pair. Morris 1997, along the difference of velocities: sum_j m 2 mu /
// (rho_i rho_j) (x.grad W) / d^2 v_ij, which has no pole at d = 0. Where fluid ends the sum ends,
// as if nothing sheared there: it stops fluid that turns as a solid.
// Monaghan & Gingold 1983, along the line between the particles: 2 mu / (rho_i rho_j) (v_ij.x)
// grad W / s^2. Fluid that turns feels nothing, angular momentum is kept, and what is lost is the
// exact dissipation of the fluid that is there, so that surfaces are free of stress (Colagrossi
// 2011). They divide by d^2, which on a lattice with R = 2.6 dx makes stretching 40 % more viscous
// than shearing; with the constant s^2, from the lattice, it is 3 %.
template <ViscosityForm form, class R, class A>
HD inline void addViscous(A& a, R weight, const Pair<R>& p, Vector<R> vij) {
    if constexpr (form == ViscosityForm::Morris)
        a.addOther(weight, vij);
    else
        a.addAlong(weight * dot(vij, p.r), p.r);
}
template <ViscosityForm form> inline constexpr unsigned viscousNeeds =
    form == ViscosityForm::Morris ? InverseDensity : ViscousVolume;
template <ViscosityForm form, class R> HD inline R viscousVolume(const PairInput<R>& s) {
    return form == ViscosityForm::Morris ? s.inverseDensity : s.viscousVolume;
}

// Laminar viscosity; at walls with the velocity of ExtrapolateToWalls, so that fluid doesn't slip
// (Adami 2012).
template <ViscosityForm form> struct LaminarViscosity {
    static constexpr unsigned needs = Velocity | WallVelocity | viscousNeeds<form>;
    static constexpr const char* name =
        form == ViscosityForm::Morris ? "laminar viscosity, Morris" : "laminar viscosity, Monaghan";
    static const char* skipped(const Scene& s) {
        if (factsOf(s).isHistorical) return "the classic formulation has another one";
        if (isMultiFluid(s)) return "each fluid of the mixture has its own";
        if (!(s.fluid.viscosity > 0)) return "fluid.viscosity is 0";
        return form == viscosityForm(s) ? "" : whyViscosityForm(s);
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>& p,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        addViscous<form>(a,
                         R(c.laminar) * k.viscous * viscousVolume<form>(i) * viscousVolume<form>(j),
                         p, i.velocity - j.velocity);
    }
    template <class R, class A> HD static void addWall(const StepParameters& c, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        addViscous<form>(
            a, R(c.laminar) * k.viscous * viscousVolume<form>(i) * viscousVolume<form>(i) * b.mass,
            p, i.velocity - b.velocity);
    }
};

// Artificial viscosity, Monaghan 1992, on approach only: sum_j m alpha c h (v.x) / ((d^2 + eta^2)
// rho) grad W, with the mean of 1/rho in place of one over the mean.
struct ArtificialViscosity {
    static constexpr unsigned needs = Velocity | InverseDensity | OwnVelocity;
    static constexpr const char* name = "artificial viscosity";
    static const char* skipped(const Scene& s) {
        if (!factsOf(s).takesOthers) return "simulation.formulation does without";
        if (isMultiFluid(s)) return "each fluid of the mixture has its own";
        return s.fluid.artificialViscosity > 0 ? "" : "fluid.artificial_viscosity is 0";
    }
    template <class R>
    HD static R approach(const StepParameters& c, const Pair<R>& p, R g, Vector<R> vij) {
        return R(c.artificial) * g * (min(dot(vij, p.r), R(0)) * p.inverseDistance2);
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>& p,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        const R s = approach(c, p, k.g, i.velocity - j.velocity);
        a.addAlong(s * (i.inverseDensity + j.inverseDensity), p.r);
    }
    template <class R, class A> HD static void addWall(const StepParameters& c, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        const R s = approach(c, p, k.g, i.velocity - b.own);
        a.addAlong(b.mass * s * (i.inverseDensity + i.inverseDensity), p.r);
    }
};

// Both, of fluids that each have their own: the harmonic mean of both particles' viscosities, with
// which stress goes on unchanged from one fluid to the other; of the artificial ones, too, which
// are as rho c, and c as 1 / sqrt(rho).
template <ViscosityForm form> struct MixtureViscosity {
    static constexpr unsigned needs =
        Velocity | InverseDensity | WallVelocity | OwnVelocity | Mixture | viscousNeeds<form>;
    static constexpr const char* name = form == ViscosityForm::Morris
                                            ? "viscosities of a mixture, Morris"
                                            : "viscosities of a mixture, Monaghan";
    static const char* skipped(const Scene& s) {
        if (!isMultiFluid(s)) return "there is one fluid";
        return form == viscosityForm(s) ? "" : whyViscosityForm(s);
    }
    template <class R> HD static R harmonic(R a, R b) {
        return R(real(2)) * a * b / max(a + b, R(real(1e-20)));
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>& p,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        const Vector<R> vij = i.velocity - j.velocity;
        addViscous<form>(a,
                         R(c.laminar) * harmonic(i.viscosity, j.viscosity) * k.viscous *
                             viscousVolume<form>(i) * viscousVolume<form>(j),
                         p, vij);
        const R s = harmonic(i.rootMassRatio, j.rootMassRatio) *
                    ArtificialViscosity::approach(c, p, k.g, vij);
        a.addAlong(s * (i.inverseDensity + j.inverseDensity), p.r);
    }
    template <class R, class A> HD static void addWall(const StepParameters& c, const Pair<R>& p,
                                                       const Weights<R>& k, const PairInput<R>& i,
                                                       const Wall<R>& b, A& a) {
        addViscous<form>(a,
                         R(c.laminar) * i.viscosity * k.viscous * viscousVolume<form>(i) *
                             viscousVolume<form>(i) * b.mass,
                         p, i.velocity - b.velocity);
        const R s = i.rootMassRatio * ArtificialViscosity::approach(c, p, k.g, i.velocity - b.own);
        a.addAlong(b.mass * s * (i.inverseDensity + i.inverseDensity), p.r);
    }
};

// The classic formulation's viscosity: nu sum_j m (v_j - v_i) / rho0 (R - d) / (pi R^6); walls
// slip.
struct ClassicViscosity {
    static constexpr unsigned needs = Velocity;
    static constexpr const char* name = "classic viscosity";
    static const char* skipped(const Scene& s) {
        if (!factsOf(s).isHistorical) return "only the classic formulation has it";
        return s.fluid.viscosity > 0 ? "" : "fluid.viscosity is 0";
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>& p,
                                                   const Weights<R>&, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        a.addOther(R(c.classicViscosity) * max(R(1) - p.q, R(0)), j.velocity - i.velocity);
    }
    template <class R, class A> HD static void addWall(const StepParameters&, const Pair<R>&,
                                                       const Weights<R>&, const PairInput<R>&,
                                                       const Wall<R>&, A&) {}
};

// Viscosity as velocity transfer: sum_j V_j W (v_j - v_i) a time of 1 / rate (Schechter & Bridson
// 2012's XSPH as a rate); walls slip.
struct VelocityTransfer {
    static constexpr unsigned needs = Velocity | InverseDensity;
    static constexpr const char* name = "velocity transfer";
    static const char* skipped(const Scene& s) {
        return s.fluid.velocityTransfer > 0 ? "" : "fluid.velocity_transfer is 0";
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>&,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        a.addOther(R(c.velocityTransfer) * k.w * (i.inverseDensity + j.inverseDensity),
                   j.velocity - i.velocity);
    }
    template <class R, class A> HD static void addWall(const StepParameters&, const Pair<R>&,
                                                       const Weights<R>&, const PairInput<R>&,
                                                       const Wall<R>&, A&) {}
};

// b g (rho_i - mean) / rho0, the mean inside the support: b g sum_j V W (rho_i - rho_j) / rho0.
// Fluid that is lighter than that around it rises faster.
struct Buoyancy {
    static constexpr unsigned needs = Density;
    static constexpr const char* name = "buoyancy";
    static const char* skipped(const Scene& s) {
        return s.fluid.buoyancy > 0 ? "" : "fluid.buoyancy is 0";
    }
    template <class R, class A> HD static void add(const StepParameters& c, const Pair<R>&,
                                                   const Weights<R>& k, const PairInput<R>& i,
                                                   const PairInput<R>& j, A& a) {
        const Vector<R> gravity{c.gravity.x, c.gravity.y, c.gravity.z};
        a.addOther(R(c.buoyancy) * k.w * (i.density - j.density), gravity);
    }
    template <class R, class A> HD static void addWall(const StepParameters&, const Pair<R>&,
                                                       const Weights<R>&, const PairInput<R>&,
                                                       const Wall<R>&, A&) {}
};

template <class... Ts> struct TermList {
    static constexpr unsigned needs = (0u | ... | Ts::needs);
};
using Mixing = TermList<VelocityTransfer, Buoyancy>;  // in a pass of their own, as rare as they are
template <ViscosityForm form> using Viscosities =
    TermList<LaminarViscosity<form>, ArtificialViscosity>;  // of all formulations but the classic
using OptionalTerms =
    TermList<LaminarViscosity<ViscosityForm::Morris>, LaminarViscosity<ViscosityForm::Monaghan>,
             ArtificialViscosity, MixtureViscosity<ViscosityForm::Morris>,
             MixtureViscosity<ViscosityForm::Monaghan>, ClassicViscosity>;

// Calls done with the form of viscosity that a scene has, as a type's value.
template <ViscosityForm form> struct FormOf { static constexpr ViscosityForm value = form; };
template <class Done> auto withViscosityForm(const Scene& s, Done done) {
    return viscosityForm(s) == ViscosityForm::Morris ? done(FormOf<ViscosityForm::Morris>{})
                                                     : done(FormOf<ViscosityForm::Monaghan>{});
}

// Calls done(TermList<...>) with just the terms this scene wants: a run-time scene becomes a
// compile-time list.
template <class Done, class... Chosen>
auto chooseTerms(const Scene&, Done done, TermList<Chosen...> chosen, TermList<>) {
    return done(chosen);
}
template <class Done, class... Chosen, class T, class... Rest>
auto chooseTerms(const Scene& s, Done done, TermList<Chosen...> chosen, TermList<T, Rest...>) {
    return *T::skipped(s) ? chooseTerms(s, done, chosen, TermList<Rest...>{})
                          : chooseTerms(s, done, TermList<Chosen..., T>{}, TermList<Rest...>{});
}

}  // namespace spindrift::LANES
