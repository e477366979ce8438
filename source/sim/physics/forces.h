// The acceleration of fluid: by the terms that a scene has, by gravity, by the mouse.
#pragma once

#include "sim/physics/correction.h"
#include "sim/physics/terms.h"

#include <cmath>

namespace spindrift::LANES {

// How much viscosity along the lines of pairs finds around a particle, sum_j g d^4, in comparison
// with a point of the lattice: half at a flat surface. Each pair counts 1 / root of both, so that a
// particle loses what fluid all around it would (that of uniform stretching, exactly so at flat
// surfaces) and both still feel the opposite. Drops are not stiffened without an end: a particle
// counts four times at most.
template <class Kernel, Lists which> struct WeighViscosity {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real perSurroundings;  // 1 / what is summed up around a lattice point
        static Parameters of(const Model& m) { return {real(1 / m.sums.surroundings)}; }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const {
        const Vector<R> x = load(v.fluid.position, i);
        R fluid = 0;
        forNeighbours<lists>(v, v.fluidNearFluid, i, x,
                             [&](const auto& p, JCluster) LANE_CALL { fluid += weight(p.q); });
        finish(i, x, total(fluid));
    }
    HD R weight(R q) const {
        const R q2 = q * q;
        return q2 * q2 * viscousOf<Kernel>(v.c, q);
    }
    HD void finish(ICluster i, Vector<R> x, R fluid) const {
        R walls = 0;
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            walls = mulAdd(load(v.walls.mass, j), weight(p.q), walls);
        });
        const R around = max(R(own.perSurroundings) * (fluid + total(walls)), R(real(0.25)));
        store(v.fluid.viscousVolume, i, R(1 / v.c.restDensity) / squareRoot(around));
    }
    // For lists with each pair once (HalfListSums).
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Inactive;
    static constexpr bool opposite = false;
    struct Nothing {};
    HD ScalarField field() const { return v.fluid.viscousVolume; }
    template <class I> HD Nothing input(I) const { return {}; }
    HD R of(const Pair<R>& p, Nothing, Nothing) const { return weight(p.q); }
    HD void finish(ICluster i) const { finish(i, load(v.fluid.position, i), load(field(), i)); }
};

// a_i = body force + m gradientNorm/R^5 times the sum of the scene's terms, corrected where the
// terms ask for it. With `Alone` just the sum, with `Added` on top of what acceleration is already.
enum class Forces { All, Alone, Added };
template <class Kernel, Lists lists, class Terms, Forces role = Forces::All> struct ComputeForces;
template <class Kernel, Lists which, class... Terms, Forces role>
struct ComputeForces<Kernel, which, TermList<Terms...>, role> {
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom =
        which == Lists::BuildInner ? SleepingHalo : Active;  // later passes need the inner lists
    using Index = ICluster;
    using R = Real<ICluster>;
    using Parameters = TermList<Terms...>;
    static constexpr unsigned needs = Parameters::needs;
    View v;
    Parameters terms;
    HD void operator()(ICluster i) const {
        if (!isActive<activeFrom>(v.fluid, i)) return;
        const Vector<R> x = load(v.fluid.position, i);
        const PairInput<R> own = input(i);
        Acceleration<R> a{};
        forNeighbours<lists>(v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            add(p, own, input(j), a);
        });
        finish(i, x, own, a, {});
    }
    template <class I> HD PairInput<R> input(I i) const { return loadPairInput<needs>(v.fluid, i); }
    template <class A>
    HD void add(const Pair<R>& p, const PairInput<R>& own, const PairInput<R>& other, A& a) const {
        const Weights<R> k = weights<Kernel>(v.c, p.q);
        (static_cast<const Terms&>(terms).add(v.c, p, k, own, other, a), ...);
    }
    // `a`: lane by lane, `whole`: the same for all of a particle's lanes.
    HD void finish(ICluster i, Vector<R> x, const PairInput<R>& own, Acceleration<R> a,
                   Vector<R> whole) const {
        const Vector<real> gravity = gravityNow(v);
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            (static_cast<const Terms&>(terms).addWall(v.c, p, weights<Kernel>(v.c, p.q), own,
                                                      loadWall<needs>(v.walls, j), a),
             ...);
        });
        const R scale = v.fluid.massRatio.data ? R(v.c.gradientScale) / load(v.fluid.massRatio, i)
                                               : R(v.c.gradientScale);
        Vector<R> pressure = scale * (whole + total(a.pressure)), other = scale * total(a.other);
        if constexpr (needs & Moments) {
            const Correction<R> correction(v.c, total(a.moments));
            pressure = -own.inverseDensity * (correction.inverse * pressure);
            other = correction.perTrace * other;
        }
        if constexpr (role == Forces::Added)
            return store(v.fluid.acceleration, i, load(v.fluid.acceleration, i) + pressure + other);
        if constexpr (role == Forces::Alone)
            return store(v.fluid.acceleration, i, limited(pressure) + other);
        store(v.fluid.acceleration, i, limited(pressure) + other + bodyForce(v.c, gravity, x));
    }
    // For lists with each pair once (HalfListSums), where no part of the acceleration is limited.
    static constexpr bool opposite = true;
    VectorField field() const {
        return role == Forces::Added ? v.fluid.addedForce : v.fluid.acceleration;
    }
    HD Vector<R> of(const Pair<R>& p, const PairInput<R>& own, const PairInput<R>& other) const {
        PairAcceleration<R> a{};
        add(p, own, other, a);
        return a.sum(p.r);
    }
    HD void finish(ICluster i) const {
        finish(i, load(v.fluid.position, i), input(i), {}, load(field(), i));
    }
    HD Vector<R> limited(Vector<R> a) const {
        const R limit = v.c.accelerationLimit;
        return (limit / squareRoot(max(dot(a, a), limit * limit))) * a;
    }
};

// a_i = body force, where no term is wanted.
struct ApplyBodyForce {
    using Index = Lanes4;
    View v;
    HD void operator()(Lanes4 i) const {
        store(v.fluid.acceleration, i, bodyForce(v.c, gravityNow(v), load(v.fluid.position, i)));
    }
};

// What slows particles down without a neighbour: dissipation, -d u, and the air, as it slows
// spheres of their volume: -k |u - wind| (u - wind) where nothing hides them, which is where their
// density is no more than what they have of themselves.
struct ResistMotion {
    using Index = Lanes4;
    struct Parameters {
        real dissipation, airDrag;  // 1/s, 1/m
        Vector<real> wind;          // m/s
        real aloneDensity;          // of a particle without neighbours / rho0
        static Parameters of(const Model& m) {
            const Scene& s = *m.scene;
            const Fluid& f = s.fluid;
            const Vec3d step = latticeStep(s);
            const double dx = s.simulation.spacing, pi = 3.14159265358979323846,
                         volume = hasOwnVolume(s) ? step.x * step.y * step.z : dx * dx * dx,
                         across = pi * std::pow(3 * volume / (4 * pi), 2.0 / 3);
            return {
                real(f.dissipation),
                real(f.airDensity * f.dragCoefficient * across / (2 * m.restDensity() * volume)),
                toVector(f.wind), real(m.shared.kernelScale * m.alone / m.restDensity())};
        }
    };
    View v;
    Parameters own;
    HD void operator()(Lanes4 i) const {
        using R = Real<Lanes4>;
        if (!isActive(v.fluid, i)) return;
        const Vector<R> u = load(v.fluid.velocity, i), wind{own.wind.x, own.wind.y, own.wind.z},
                        past = u - wind;
        const R hidden = (load(v.fluid.density, i) * R(1 / v.c.restDensity) - R(own.aloneDensity)) *
                         R(1 / (1 - own.aloneDensity));
        const R exposed = R(1) - min(max(hidden, R(0)), R(1));
        const R drag =
            R(own.airDrag) * exposed * squareRoot(dot(past, past)) / massRatio(v.fluid, i);
        store(v.fluid.acceleration, i,
              subtractScaled(subtractScaled(load(v.fluid.acceleration, i), R(own.dissipation), u),
                             drag, past));
    }
};

// The mouse drags the fluid inside a sphere towards its own velocity, strongest in the middle, or
// pulls it to the middle.
struct StirFluid {
    using Index = Lanes4;
    View v;
    HD void operator()(Lanes4 i) const {
        using R = Real<Lanes4>;
        const Stirring s = *v.stirring;
        const Vector<R> center{s.center.x, s.center.y, s.center.z};
        const Vector<R> drag{s.velocity.x, s.velocity.y, s.velocity.z};
        const Vector<R> d = load(v.fluid.position, i) - center, u = load(v.fluid.velocity, i);
        const R weight = max(R(1) - dot(d, d) * R(1 / (s.radius * s.radius)), R(0));
        R share = weight * R(min(real(1), s.rate * real(v.state->dt)));
        if (v.fluid.heldBy.data)  // what a source holds goes as that wants
            share = select(load(v.fluid.heldBy, i) > R(0), R(0), share);
        const Vector<R> wanted = subtractScaled(drag, R(s.pull), d);
        store(v.fluid.velocity, i, addScaled(u, share, wanted - u));
    }
};

}  // namespace spindrift::LANES
