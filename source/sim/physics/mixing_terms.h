// Terms that few scenes have: they mix what is near.
#pragma once

#include "sim/physics/term.h"

namespace spindrift::LANES {

// Viscosity as velocity transfer: sum_j V_j W (v_j - v_i) a time of 1 / rate (Schechter & Bridson
// 2012's XSPH as a rate); walls slip.
struct VelocityTransfer {
    static constexpr unsigned needs = Velocity | InverseDensity;
    static constexpr const char* name = "velocity transfer";
    static const char* skipped(const Scene& s) {
        return s.fluid.velocityTransfer > 0 ? "" : "fluid.velocity_transfer is 0";
    }
    static VelocityTransfer of(const Model& m) {
        return {real(m.scene->fluid.velocityTransfer * m.meanScale() / 2 / m.shared.gradientScale)};
    }
    static double longestStep(const Model& m) { return 0.5 / m.scene->fluid.velocityTransfer; }
    real scale;
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>&,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        a.addOther(R(scale) * k.w * (i.inverseDensity + j.inverseDensity), j.velocity - i.velocity);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>&,
                                                const Weights<R>&, const PairInput<R>&,
                                                const Wall<R>&, A&) const {}
};

// b g (rho_i - mean) / rho0, the mean inside the support: b g sum_j V W (rho_i - rho_j) / rho0.
// Fluid that is lighter than that around it rises faster.
struct Buoyancy {
    static constexpr unsigned needs = Density;
    static constexpr const char* name = "buoyancy";
    static const char* skipped(const Scene& s) {
        return s.fluid.buoyancy > 0 ? "" : "fluid.buoyancy is 0";
    }
    static Buoyancy of(const Model& m) {
        const double rho0 = m.restDensity();
        return {
            real(m.scene->fluid.buoyancy * m.meanScale() / (rho0 * rho0) / m.shared.gradientScale)};
    }
    real scale;
    template <class R, class A> HD void add(const StepParameters& c, const Pair<R>&,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        const Vector<R> gravity{c.gravity.x, c.gravity.y, c.gravity.z};
        a.addOther(R(scale) * k.w * (i.density - j.density), gravity);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>&,
                                                const Weights<R>&, const PairInput<R>&,
                                                const Wall<R>&, A&) const {}
};

}  // namespace spindrift::LANES
