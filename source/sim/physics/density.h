// Density: as a sum over neighbours, or its rate where it is carried; and the pressure of it.
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/kernels.h"

namespace spindrift::LANES {

// A sum over few neighbours says little of the fluid's density: 1/rho, which viscous forces go with
// twice, is never more than 1.25/rho0. (Without that, single drops at walls were seen to blow up in
// thick fluid.) Returns 1/rho.
template <class I> HD inline Real<I> storeDensity(const View& v, I i, Real<I> rho) {
    using R = Real<I>;
    const R inverse = R(1) / max(rho, R(real(0.8) * v.c.restDensity));
    store(v.fluid.density, i, rho);
    store(v.fluid.inverseDensity, i, inverse);
    return inverse;
}
// What follows from a density: the equation of state p = max(p_least, p0 + k ((rho/rho0)^gamma -
// 1)).
template <class I> HD inline void storeState(const View& v, I i, Real<I> rho) {
    using R = Real<I>;
    const R ratio = rho * R(1 / v.c.restDensity);
    R power = ratio;
    for (int k = 1; k < v.c.gamma; ++k) power = power * ratio;
    const R pressure = max(mulAdd(R(v.c.stiffness), power - R(1), R(v.c.backgroundPressure)),
                           R(v.c.leastPressure));
    const R inverse = storeDensity(v, i, rho);
    store(v.fluid.pressureOverRho2, i, pressure * inverse * inverse);
}

// rho_i = sum_j m W + sum_b m_b W; pressure follows from it, unless it is `solved` for.
template <class Kernel, bool solved = false> struct ComputeDensity {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster i) const {
        if (!isActive<activeFrom>(v.fluid, i)) return;
        const Vector<R> x = load(v.fluid.position, i);
        R fluid = 0;
        forNeighbours<lists>(v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster) LANE_CALL {
            fluid += valueOf<Kernel>(v.c, p.q);
        });
        finish(i, x, total(fluid));
    }
    HD void finish(ICluster i, Vector<R> x, R fluid) const {
        R walls = 0;
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            walls = mulAdd(load(v.walls.mass, j), valueOf<Kernel>(v.c, p.q), walls);
        });
        const R others = fluid + R((v.c.selfWeight - 1) * valueOf<Kernel>(v.c, real(0)));
        const R rho = R(v.c.kernelScale) * (others + total(walls));
        if constexpr (solved)
            storeDensity(v, i, rho), store(v.fluid.fluidWeight, i, fluid);
        else
            storeState(v, i, rho);
    }
    // For lists with each pair once (HalfListSums).
    static constexpr Lists lists = Lists::BuildInner;
    static constexpr uint8_t activeFrom = SleepingHalo;
    static constexpr bool opposite = false;
    struct Nothing {};
    ScalarField field() const { return v.fluid.density; }
    template <class I> HD Nothing input(I) const { return {}; }
    HD R of(const Pair<R>& p, Nothing, Nothing) const { return valueOf<Kernel>(v.c, p.q); }
    HD void finish(ICluster i) const { finish(i, load(v.fluid.position, i), load(field(), i)); }
};

// Where density is carried from step to step.
struct ApplyEquationOfState {
    using Index = Lanes4;
    View v;
    HD void operator()(Lanes4 i) const { storeState(v, i, load(v.fluid.density, i)); }
};

// The gradient of density that hydrostatic pressure makes.
template <class R> HD inline Vector<R> hydrostaticSlope(const StepParameters& c,
                                                        Vector<real> gravityNow, Vector<R> x) {
    return R(c.restDensity / (c.soundSpeed * c.soundSpeed)) * bodyForce(c, gravityNow, x);
}

// d rho/dt = -rho div u + delta h c 2 sum_j V_j (rho_j - rho_i - rho_H) (-F), Molteni & Colagrossi
// 2009, without the difference rho_H that hydrostatic pressure makes (Fourtakas 2019). Velocities
// are of the middle of a step, places of its beginning; so pairs are seen from where they will be
// in its middle. (Without that, fluid that turns as a solid is compressed, by omega^2 dt a second.)
template <class Kernel> struct ComputeDensityRate {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster i) const {
        if (!isActive<SleepingHalo>(v.fluid, i)) return;
        const Vector<real> gravity = gravityNow(v);
        const Vector<R> x = load(v.fluid.position, i), u = load(v.fluid.velocity, i);
        const R rho = load(v.fluid.density, i);
        R diffusion = v.c.diffusion;
        Vector<R> slope = hydrostaticSlope(v.c, gravity, x);
        if (v.fluid.massRatio.data) {  // heavier fluid has a lower speed of sound
            const R ratio = load(v.fluid.massRatio, i);
            slope = ratio * slope, diffusion = diffusion / squareRoot(ratio);
        }
        R sum = 0;
        const R ahead = v.c.rateAhead * real(v.state->dt);
        forNeighbours<Lists::Inner>(
            v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const Vector<R> apart = u - load(v.fluid.velocity, j);
                const R approach = rho * dot(apart, addScaled(p.r, ahead, apart));
                const R excess = load(v.fluid.density, j) - rho + dot(slope, p.r);
                sum = mulAdd(slopeOf<Kernel>(v.c, p.q) * load(v.fluid.inverseDensity, j),
                             negMulAdd(diffusion, excess, approach), sum);
            });
        R walls = 0;
        forNeighbours<Lists::Inner>(
            v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const Vector<R> apart = u - flowVelocity(v.walls, j);
                walls = mulAdd(slopeOf<Kernel>(v.c, p.q) * load(v.walls.mass, j),
                               dot(apart, addScaled(p.r, ahead, apart)), walls);
            });
        const R perRest = 1 / v.c.restDensity;
        store(v.fluid.densityRate, i,
              R(v.c.gradientScale) * mulAdd(rho * perRest, total(walls), total(sum)));
    }
};

}  // namespace spindrift::LANES
