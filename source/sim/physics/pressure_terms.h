// Terms of pressure.
#pragma once

#include "sim/physics/term.h"

namespace spindrift::LANES {

// -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W, Monaghan 1992. Walls take part with the pressure
// that ExtrapolateWallPressure gave them; in the classic formulation (and Akinci 2012) they have
// none.
struct PressureForce {
    static constexpr unsigned needs = 0;
    static constexpr const char* name = "pressure";
    static const char* skipped(const Scene&) { return ""; }
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        a.addPressure(k.g * (i.pressureOverRho2 + j.pressureOverRho2), p.r);
    }
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
        a.addPressure(b.mass * k.g * (i.pressureOverRho2 + b.pressureOverRho2), p.r);
    }
};

// The same where pressures are solved for: walls mirror the fluid's, and have what fluid at rest
// would have more (solver/pressure_passes.h).
struct MirroredPressureForce {
    static constexpr unsigned needs = Mirrored;
    template <class R, class A> HD void addWall(const StepParameters&, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
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
    template <class R, class A> HD void add(const StepParameters&, const Pair<R>& p,
                                            const Weights<R>& k, const PairInput<R>& i,
                                            const PairInput<R>& j, A& a) const {
        a.addPressure(
            k.g * R(real(0.5)) * (i.pressure + j.pressure) * (i.inverseDensity * j.inverseDensity),
            p.r);
    }
    template <class R, class A> HD void addWall(const StepParameters& c, const Pair<R>& p,
                                                const Weights<R>& k, const PairInput<R>& i,
                                                const Wall<R>& b, A& a) const {
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
    template <class R> HD void add(const StepParameters&, const Pair<R>& p, const Weights<R>& k,
                                   const PairInput<R>& i, const PairInput<R>& j,
                                   Acceleration<R>& a) const {
        addDifference(a, k.g * j.inverseDensity, j.pressure - i.pressure, p.r);
    }
    template <class R> HD void addWall(const StepParameters& c, const Pair<R>& p,
                                       const Weights<R>& k, const PairInput<R>& i, const Wall<R>& b,
                                       Acceleration<R>& a) const {
        const R rho0 = c.restDensity;
        addDifference(a, k.g * b.mass * R(1 / c.restDensity),
                      b.pressureOverRho2 * rho0 * rho0 - i.pressure, p.r);
    }
};

}  // namespace spindrift::LANES
