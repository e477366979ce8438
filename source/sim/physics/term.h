// Terms: one pairwise contribution to the acceleration each. A term says why a scene does without
// it ("" when it is wanted), what it reads of both particles, which steps it bears, takes its
// parameters from the model (`of`), and adds itself: between fluid particles (`add`) and between a
// fluid particle and a boundary particle (`addWall`). grad W = gradientNorm/R^5 g x, and what all
// pairs share, the mass m and gradientNorm/R^5, is left out here and multiplied once, at the end of
// the pass.
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/model.h"

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

}  // namespace spindrift::LANES
