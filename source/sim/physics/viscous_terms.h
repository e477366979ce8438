// Terms of viscosity.
#pragma once

#include "scene/sources.h"
#include "sim/physics/term.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

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

// 2 mu, Pa s, for the kernel's own sums of Laplacians; over s^2 in Monaghan's form.
template <ViscosityForm form> real viscousScale(const Model& m, double mu) {
    const double dx = m.scene->simulation.spacing;
    return real(2 * mu * m.sums.gradient /
                (form == ViscosityForm::Morris ? m.sums.viscous : m.sums.shear * dx * dx));
}
// The longest step that viscosities bear, s (Morris 1997; what acts along the line of two particles
// damps waves along their way faster, on the lattice up to twice, in three dimensions 1.7 times as
// fast).
inline double viscousStep(const Model& m) {
    const Scene& s = *m.scene;
    const double d = m.dimensions(),
                 along = viscosityForm(s) == ViscosityForm::Monaghan ? d / (d + 2) : 1;
    double step = 1e9;
    for (const Body& body : fluidsOf(s.fluid))
        if (viscosity(s, body) > 0)
            step = std::min(step, along * 0.125 * m.h() * m.h() * restDensity(s, body) /
                                      (viscosity(s, body) * (isMultiFluid(s) ? 2 : 1)));
    return step;
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
    static LaminarViscosity of(const Model& m) {
        return {viscousScale<form>(m, m.scene->fluid.viscosity)};
    }
    static double longestStep(const Model& m) { return viscousStep(m); }
    real scale;
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        addViscous<form>(a, R(scale) * k.viscous * viscousVolume<form>(i) * viscousVolume<form>(j),
                         p, i.velocity - j.velocity);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
        addViscous<form>(
            a, R(scale) * k.viscous * viscousVolume<form>(i) * viscousVolume<form>(i) * b.mass, p,
            i.velocity - b.velocity);
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
    static ArtificialViscosity of(const Model& m) {
        return {real(m.scene->fluid.artificialViscosity * m.sound * m.h() / 2)};
    }
    // Sound does not bound steps where pressures are solved for.
    static double longestStep(const Model& m) {
        return factsOf(*m.scene).solvesPressure
                   ? m.h() / (m.scene->fluid.artificialViscosity * m.sound)
                   : 1e9;
    }
    real scale;  // alpha c h / 2, m^2/s
    template <class R> HD R approach(const Pair<R>& p, R g, Vector<R> vij) const {
        return R(scale) * g * (min(dot(vij, p.r), R(0)) * p.inverseDistance2);
    }
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        const R s = approach(p, k.g, i.velocity - j.velocity);
        a.addAlong(s * (i.inverseDensity + j.inverseDensity), p.r);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
        const R s = approach(p, k.g, i.velocity - b.own);
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
    static MixtureViscosity of(const Model& m) {
        return {viscousScale<form>(m, 1), ArtificialViscosity::of(m)};
    }
    static double longestStep(const Model& m) { return viscousStep(m); }
    real scale;
    ArtificialViscosity artificial;
    template <class R> HD static R harmonic(R a, R b) {
        return R(real(2)) * a * b / max(a + b, R(real(1e-20)));
    }
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        const Vector<R> vij = i.velocity - j.velocity;
        addViscous<form>(a,
                         R(scale) * harmonic(i.viscosity, j.viscosity) * k.viscous *
                             viscousVolume<form>(i) * viscousVolume<form>(j),
                         p, vij);
        const R s = harmonic(i.rootMassRatio, j.rootMassRatio) * artificial.approach(p, k.g, vij);
        a.addAlong(s * (i.inverseDensity + j.inverseDensity), p.r);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
        addViscous<form>(a,
                         R(scale) * i.viscosity * k.viscous * viscousVolume<form>(i) *
                             viscousVolume<form>(i) * b.mass,
                         p, i.velocity - b.velocity);
        const R s = i.rootMassRatio * artificial.approach(p, k.g, i.velocity - b.own);
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
    static ClassicViscosity of(const Model& m) {
        const double pi = 3.14159265358979323846;
        return {real(m.scene->fluid.viscosity * particleMass(*m.scene) /
                     (m.restDensity() * pi * std::pow(m.support(), 5)) / m.shared.gradientScale)};
    }
    static double longestStep(const Model& m) { return viscousStep(m); }
    real scale;
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>&, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        a.addOther(R(scale) * max(R(1) - p.q, R(0)), j.velocity - i.velocity);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>&,
                                                const Weights<R>&, const PairInput<R>&,
                                                const Wall<R>&, A&) const {}
};

}  // namespace spindrift::LANES
