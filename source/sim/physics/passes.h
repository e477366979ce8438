// The passes of a step. A pass is a struct with a View and operator()(index); it reads neighbours
// and writes its own particles only, never a field that it gathers. `Index` says how many particles
// one call works on.
#pragma once

#include "core/vertex.h"
#include "sim/physics/kernels.h"
#include "sim/physics/terms.h"

namespace spindrift::LANES {

// Empty slots lie beyond this coordinate, m.
inline constexpr real farAway = 1e6;

// Sort key: the particle's cell, or -1 for an empty slot. One that is nowhere (not finite) has no
// neighbours in any cell; such particles are spread, because all of them in one cell would take
// forever.
struct FindCell {
    using Index = int;
    Particles p;
    Grid grid;
    int* key;
    HD void operator()(int i) const {
        const Vector<real> x = load(p.position, i);
        const bool somewhere = dot(x, x) - dot(x, x) == 0;
        key[i] = p.id[i] < 0 ? -1
                 : somewhere ? grid.cell(x)
                             : i % (grid.cells.x * grid.cells.y * grid.cells.z);
    }
};

// Fields that go along as particles are put in order.
struct Carried {
    static constexpr int most = 12;
    struct Field {
        real *from, *to;
        bool isVector, isPosition;
        real empty;
    } fields[most];
    int count;
};

// Moves what a particle carries from step to step to its new slot.
struct Reorder {
    using Index = int;
    const int* order;
    const int* id;
    int* sortedId;
    Carried carried;
    HD void operator()(int i) const {
        const int s = order[i];
        sortedId[i] = s < 0 ? -1 : id[s];
        // Empty slots: so far out that no distance to any particle is small or equal.
        const real far = 2 * farAway * real(1 + i % 4);
        for (int k = 0; k < carried.count; ++k) {
            const Carried::Field& f = carried.fields[k];
            const real empty = f.isPosition ? far : f.empty;
            if (f.isVector)
                store(VectorField{f.to}, i,
                      s < 0 ? Vector<real>{empty, empty, empty} : load(VectorField{f.from}, s));
            else
                store(ScalarField{f.to}, i, s < 0 ? empty : load(ScalarField{f.from}, s));
        }
    }
};

// m_b = f rho0 / sum W over the boundary particles (Akinci 2012, their eq. 4 and 5), itself
// included but in the classic formulation, and no less than wallMassFloor: in the edges of a box,
// where two walls meet, the wall would become thin. One that is alone, as empty slots are, stays
// finite.
template <class Kernel> struct ComputeWallMass {
    using Index = ICluster;
    View v;
    HD void operator()(ICluster i) const {
        Real<ICluster> sum = 0;
        forNeighbours<Lists::All>(v, v.wallsNearWalls, i, load(v.walls.position, i),
                                  [&](const auto& p, JCluster)
                                      LANE_CALL { sum += valueOf<Kernel>(v.c, p.q); });
        const real alone = valueOf<Kernel>(v.c, real(0));
        const Real<ICluster> near = max(total(sum) + Real<ICluster>((v.c.selfWeight - 1) * alone),
                                        Real<ICluster>(real(0.01) * alone));
        const Real<ICluster> mass =
            Real<ICluster>(v.c.wallFactor * v.c.restDensity / v.c.kernelScale) / near;
        store(v.walls.mass, i, max(mass, Real<ICluster>(v.c.wallMassFloor)));
    }
};

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
            storeDensity(v, i, rho);
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

// What of a velocity goes through a boundary particle's surface; of the domain's faces component by
// component, in its edges too.
template <class R>
HD inline Vector<R> acrossWall(const Particles& walls, ICluster b, Vector<R> u, Vector<R> out) {
    const R zero = 0, depth2 = max(dot(out, out), R(real(1e-20)));
    const auto ofBox = load(walls.slip, b) < zero;
    auto part = [&](R along, R out) LANE_CALL { return select(out * out > zero, along, zero); };
    const Vector<R> across = (dot(u, out) / depth2) * out;
    return {select(ofBox, part(u.x, out.x), across.x), select(ofBox, part(u.y, out.y), across.y),
            select(ofBox, part(u.z, out.z), across.z)};
}

// What the fluid's pressure would be at a boundary particle: p_b = sum_f (p_f + rho_f g.(x_b -
// x_f)) W / sum_f W, Adami 2012, eq. 27, g without the wall's own acceleration. With `sticks` also
// the velocity that makes it the wall's own at the wall, along a straight line from the mean of the
// fluid nearby (Adami 2012 takes both sides as equally far, as Morris 1997 does not); with `dense`
// the density of that pressure, for its gradient. Where walls let fluid slip, that line reaches the
// wall's velocity the slip length behind its surface (Navier 1823), along it: with an endless one
// fluid slides freely.
template <class Kernel, bool sticks, bool dense> struct ExtrapolateToWalls {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster b) const {
        if (!isActive(v.walls, b)) return;
        const Vector<real> gravity = gravityNow(v);
        const Vector<R> x = load(v.walls.position, b);
        const Vector<R> force = bodyForce(v.c, gravity, x) - ownAcceleration(v.walls, b);
        Vector<R> out;
        if constexpr (sticks) out = load(v.walls.outward, b);
        R pressure = 0, weight = 0, apart = 0;
        Vector<R> velocity{0, 0, 0};
        forNeighbours<Lists::All>(
            v, v.fluidNearWalls, b, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R rho = load(v.fluid.density, j), w = valueOf<Kernel>(v.c, p.q);
                const R pull = v.fluid.massRatio.data ? load(v.fluid.massRatio, j) * dot(force, p.r)
                                                      : dot(force, p.r);
                pressure =
                    mulAdd(w * rho, mulAdd(rho, load(v.fluid.pressureOverRho2, j), pull), pressure);
                weight += w;
                if constexpr (sticks) {
                    velocity = addScaled(velocity, w, load(v.fluid.velocity, j));
                    apart = mulAdd(w, dot(p.r, out), apart);
                }
            });
        const R perWeight = R(1) / max(total(weight), R(real(1e-6)));
        const R mean = max(total(pressure) * perWeight, R(v.c.leastPressure));
        store(v.walls.pressureOverRho2, b, mean * R(1 / (v.c.restDensity * v.c.restDensity)));
        if constexpr (sticks)
            storeVelocity(b, ownVelocity(v.walls, b), perWeight * total(velocity), out,
                          perWeight * total(apart));
        if constexpr (dense)
            store(v.walls.density, b,
                  mulAdd(mean, R(1 / (v.c.soundSpeed * v.c.soundSpeed)), R(v.c.restDensity)));
    }
    // `apart` is the distance to the fluid along `out`, times its length. Fluid that touches the
    // wall would ask for any speed: no line is steeper than if the fluid were a third as far away
    // as the wall's particle.
    HD void storeVelocity(ICluster b, Vector<R> wall, Vector<R> fluid, Vector<R> out,
                          R apart) const {
        const R depth2 = dot(out, out);
        const R away = max(apart - depth2, max(depth2 * R(real(1) / 3), R(real(1e-20))));
        const R ratio = depth2 / away;
        const Vector<R> slower = wall - fluid;
        if (v.walls.slipVelocity.data) return slip(b, wall, slower, out, ratio, away);
        store(v.walls.velocity, b, addScaled(wall, ratio, slower));
    }
    // `away` is the fluid's distance from the surface times the length of `out`.
    HD void slip(ICluster b, Vector<R> wall, Vector<R> slower, Vector<R> out, R ratio,
                 R away) const {
        const R stored = load(v.walls.slip, b), zero = 0;
        const R depth2 = max(dot(out, out), R(real(1e-20))), depth = squareRoot(depth2);
        const R length = max(stored, zero - stored), reach = away / depth + length;
        const Vector<R> normal = acrossWall(v.walls, b, slower, out);
        const Vector<R> along = slower - normal;
        store(v.walls.velocity, b,
              addScaled(addScaled(wall, ratio, normal), (depth - length) / reach, along));
        store(v.walls.slipVelocity, b, subtractScaled(wall, length / reach, along));
    }
};

// The velocity with which the flow goes on into walls, for its divergence: through a surface along
// the straight line from the mean of the fluid nearby to the wall's own velocity at the surface,
// and along it as that fluid. So its divergence is what the fluid alone would say, and fluid passes
// a body as if that had its own size. With the wall's own velocity everywhere, what the flow
// stretches along a curved surface is missing on its other side, and with the own velocity across
// and the fluid's along, what it narrows across: added masses of a cylinder of radius 10 dx were 5
// and 22 % too small. Around an edge, where the mean fluid is not straight out, the wall's own.
template <class Kernel> struct ContinueFlowIntoWalls {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster b) const {
        if (!isActive(v.walls, b)) return;
        R weight = 0;
        Vector<R> velocity{0, 0, 0}, towards{0, 0, 0};
        forNeighbours<Lists::All>(v, v.fluidNearWalls, b, load(v.walls.position, b),
                                  [&](const auto& p, JCluster j) LANE_CALL {
                                      const R w = valueOf<Kernel>(v.c, p.q);
                                      weight += w;
                                      velocity = addScaled(velocity, w, load(v.fluid.velocity, j));
                                      towards = addScaled(towards, w, p.r);
                                  });
        const R perWeight = R(1) / max(total(weight), R(real(1e-6)));
        finish(b, perWeight * total(velocity), perWeight * total(towards));
    }
    HD void finish(ICluster b, Vector<R> fluid, Vector<R> towards) const {
        const R zero = 0, one = 1, least = R(real(1e-20));
        const Vector<R> out = load(v.walls.outward, b), wall = ownVelocity(v.walls, b),
                        slower = wall - fluid, normal = acrossWall(v.walls, b, slower, out);
        const R depth2 = dot(out, out), along = dot(towards, out);
        const R ratio = depth2 / max(along - depth2, max(depth2 * R(real(1) / 3), least));
        const R straight = along * along / max(depth2 * dot(towards, towards), least);
        const R solid = min(max((straight - R(real(0.8))) * R(real(1 / 0.15)), zero), one);
        const R share = select(load(v.walls.slip, b) < zero, one, solid);
        store(v.walls.flowVelocity, b,
              addScaled(wall, share, addScaled(normal - slower, ratio, normal)));
    }
};

// How much viscosity along the lines of pairs finds around a particle, sum_j g d^4, in comparison
// with a point of the lattice: half at a flat surface. Each pair counts 1 / root of both, so that a
// particle loses what fluid all around it would (that of uniform stretching, exactly so at flat
// surfaces) and both still feel the opposite. Drops are not stiffened without an end: a particle
// counts four times at most.
template <class Kernel, Lists which> struct WeighViscosity {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
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
        const R around = max(R(v.c.perSurroundings) * (fluid + total(walls)), R(real(0.25)));
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

// The moments of a particle's neighbours, M = -sum_j V_j r grad W, which is 1 on a lattice, and
// what they correct: gradients divided by M are exact for linear fields, Laplacians by its trace
// for parabolas (Randles & Libersky 1996). Where neighbours are too few or lie in a plane, nothing
// is corrected.
template <class R> struct Correction {
    Symmetric<R> inverse;  // of M
    R determinant;         // of M: 1 with neighbours all around, about a third at a flat surface
    R perTrace;            // d / trace of M
    HD Correction(const StepParameters& c, const Symmetric<R>& sums) {
        const R scale = -c.gradientScale;
        Symmetric<R> m{scale * sums.xx, scale * sums.yy, scale * sums.zz,
                       scale * sums.xy, scale * sums.xz, scale * sums.yz};
        perTrace = R(c.dimensions) / max(m.xx + m.yy + m.zz, R(real(0.1)));
        m.zz += R(c.flatMoment);
        const R xx = m.yy * m.zz - m.yz * m.yz, xy = m.xz * m.yz - m.xy * m.zz,
                xz = m.xy * m.yz - m.xz * m.yy;
        const R det = m.xx * xx + m.xy * xy + m.xz * xz, one = 1, zero = 0;
        const auto solvable = det > R(real(0.1));
        const R d = one / max(det, R(real(0.1)));
        determinant = det;
        inverse = {select(solvable, d * xx, one),
                   select(solvable, d * (m.xx * m.zz - m.xz * m.xz), one),
                   select(solvable, d * (m.xx * m.yy - m.xy * m.xy), one),
                   select(solvable, d * xy, zero),
                   select(solvable, d * xz, zero),
                   select(solvable, d * (m.xy * m.xz - m.xx * m.yz), zero)};
    }
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
    static constexpr unsigned needs = TermList<Terms...>::needs;
    View v;
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
        (Terms::add(v.c, p, k, own, other, a), ...);
    }
    // `a`: lane by lane, `whole`: the same for all of a particle's lanes.
    HD void finish(ICluster i, Vector<R> x, const PairInput<R>& own, Acceleration<R> a,
                   Vector<R> whole) const {
        const Vector<real> gravity = gravityNow(v);
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            (Terms::addWall(v.c, p, weights<Kernel>(v.c, p.q), own, loadWall<needs>(v.walls, j), a),
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

// Particles move by u + du instead of u, so that they stay evenly spread (Sun 2019), and carry the
// fields of where they are:
//     d rho/dt = -rho div u + du.grad rho + delta h c Laplacian rho        du/dt = ... + du.grad u
// Gradients are corrected. The Laplacians of density and (in the forces) velocity lose what linear
// fields add on uneven neighbours, 2 S.grad f with S = sum_j V_j grad W. Walls take part with their
// own velocity, not with the one that viscosity sees (Adami 2012): with that one, the error of
// cavity flow at Re = 100, 50 particles across, is 1.1 % instead of 0.23 %. With a free `surface`,
// which the determinant of the moments tells (Sun 2019: their smallest eigenvalue), particles there
// are shifted along it only and carry nothing, and those with hardly a neighbour are not shifted:
// gradients are poor there, and splashes gained energy. div u is the plain sum, which pressure
// forces in pairs go with: what they take from motion is in compression then. Shifting changes the
// room of a particle, not its mass: Sun 2019 takes rho div du as the difference of its two discrete
// forms, 2 rho du.S. (Without it, drops grow by 1 % a period.)
template <class Kernel, bool surface> struct ComputeTransport {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    struct Sums {
        Symmetric<R> moments;
        Vector<R> u, v, w, rho;  // weighted r times the differences of each: gradients
        Vector<R> concentrationGradient, shift;
        R laplacian;  // of the density
        HD void add(R weight, Vector<R> r, Vector<R> velocity, R density, R excess, R crowding) {
            const Vector<R> wr = weight * r;
            moments = addOuter(moments, weight, r);
            u = addScaled(u, velocity.x, wr), v = addScaled(v, velocity.y, wr),
            w = addScaled(w, velocity.z, wr);
            rho = addScaled(rho, density, wr);
            concentrationGradient = concentrationGradient + wr;
            shift = addScaled(shift, crowding, wr);
            laplacian = negMulAdd(weight, excess, laplacian);
        }
    };
    HD void operator()(ICluster i) const {
        const Vector<real> gravity = gravityNow(v);
        const Vector<R> x = load(v.fluid.position, i), own = load(v.fluid.velocity, i);
        const R rho = load(v.fluid.density, i), perRest = 1 / v.c.restDensity;
        const Vector<R> slope = hydrostaticSlope(v.c, gravity, x);
        Sums s{};
        forNeighbours<Lists::Inner>(
            v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R more = load(v.fluid.density, j) - rho;
                s.add(slopeOf<Kernel>(v.c, p.q) * load(v.fluid.inverseDensity, j), p.r,
                      load(v.fluid.velocity, j) - own, more,
                      surface ? more + dot(slope, p.r) : more, crowding(p.q));
            });
        forNeighbours<Lists::Inner>(
            v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R more = load(v.walls.density, j) - rho;
                s.add(slopeOf<Kernel>(v.c, p.q) * load(v.walls.mass, j) * perRest, p.r,
                      flowVelocity(v.walls, j) - own, more, surface ? R(0) : more, crowding(p.q));
            });
        finish(i, rho, s);
    }
    // Sun 2019: 1 + 0.2 (W / W(dx))^4 keeps particles from pairing.
    HD R crowding(R q) const {
        const R w = valueOf<Kernel>(v.c, q) * R(v.c.shiftWeight), w2 = w * w;
        return mulAdd(R(real(0.2)), w2 * w2, R(1));
    }
    HD void finish(ICluster i, R rho, const Sums& s) const {
        const R scale = v.c.gradientScale;
        const Correction<R> correction(v.c, total(s.moments));
        auto gradient = [&](Vector<R> sum)
                            LANE_CALL { return scale * (correction.inverse * total(sum)); };
        const Vector<R> gradU = gradient(s.u), gradV = gradient(s.v), gradW = gradient(s.w),
                        gradRho = gradient(s.rho);
        const R two = 2;
        const Vector<R> concentrationGradient =
            (two * correction.perTrace * scale) * total(s.concentrationGradient);
        const Vector<R> inward = scale * total(s.concentrationGradient);
        Vector<R> wanted = (R(-v.c.shifting * real(v.state->speed)) * scale) * total(s.shift);
        R inside = 1;
        if constexpr (surface) {
            inside = between(real(0.6), real(0.85), correction.determinant);
            wanted = between(real(0.2), real(0.35), correction.determinant) *
                     alongSurface(wanted, inward, inside);
        }
        const Vector<R> shift = limitedShift(wanted);
        // Half of `laminar` is the viscosity, of `diffusion` the diffusion's.
        const R half = real(0.5),
                nu = surface ? R(0) : half * R(v.c.laminar) * load(v.fluid.inverseDensity, i);
        const Vector<R> along = subtractScaled(inside * shift, nu, concentrationGradient);
        const R diffused = surface ? two * scale * total(s.laplacian)
                                   : two * correction.perTrace * scale * total(s.laplacian) -
                                         dot(concentrationGradient, gradRho);
        const R divergence = surface
                                 ? scale * total(s.u.x + s.v.y + s.w.z) - roomLost(shift, inward)
                                 : gradU.x + gradV.y + gradW.z;
        const R rate = inside * dot(shift, gradRho) - rho * divergence;
        store(v.fluid.densityRate, i, mulAdd(half * R(v.c.diffusion), diffused, rate));
        store(v.fluid.shiftVelocity, i, shift);
        store(v.fluid.shiftAcceleration, i,
              Vector<R>{dot(along, gradU), dot(along, gradV), dot(along, gradW)});
    }
    // 0 below `low`, 1 above `high`, smooth in between.
    HD static R between(real low, real high, R value) {
        const R t = min(max((value - R(low)) * R(1 / (high - low)), R(0)), R(1));
        return t * t * (R(3) - R(2) * t);
    }
    // Where neighbours are missing the shift loses its part along S, which points inward (Sun
    // 2019).
    HD static Vector<R> alongSurface(Vector<R> shift, Vector<R> inward, R inside) {
        const R across = dot(shift, inward) / max(dot(inward, inward), R(real(1e-20)));
        return subtractScaled(shift, (R(1) - inside) * across, inward);
    }
    // 1/s. Where fluid is torn its pressure would fall on and on: at most twice what swinging drops
    // need, 0.02 U / R.
    HD R roomLost(Vector<R> shift, Vector<R> inward) const {
        return max(R(real(2)) * dot(shift, inward),
                   R(real(-0.04) * real(v.state->speed) / v.c.support));
    }
    // At most half as fast as the fastest fluid.
    HD Vector<R> limitedShift(Vector<R> shift) const {
        const R limit = max(R(real(0.5) * real(v.state->speed)), R(real(1e-15)));
        return (limit / squareRoot(max(dot(shift, shift), limit * limit))) * shift;
    }
};

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

// What slows particles down without a neighbour: dissipation, -d u, and the air, as it slows
// spheres of their volume: -k |u - wind| (u - wind) where nothing hides them, which is where their
// density is no more than what they have of themselves.
struct ResistMotion {
    using Index = Lanes4;
    View v;
    HD void operator()(Lanes4 i) const {
        using R = Real<Lanes4>;
        if (!isActive(v.fluid, i)) return;
        const Vector<R> u = load(v.fluid.velocity, i), wind{v.c.wind.x, v.c.wind.y, v.c.wind.z},
                        past = u - wind;
        const R hidden = (load(v.fluid.density, i) * R(1 / v.c.restDensity) - R(v.c.aloneDensity)) *
                         R(1 / (1 - v.c.aloneDensity));
        const R exposed = R(1) - min(max(hidden, R(0)), R(1));
        const R drag =
            R(v.c.airDrag) * exposed * squareRoot(dot(past, past)) / massRatio(v.fluid, i);
        store(v.fluid.acceleration, i,
              subtractScaled(subtractScaled(load(v.fluid.acceleration, i), R(v.c.dissipation), u),
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
        const Vector<R> center{v.c.stirCenter.x, v.c.stirCenter.y, v.c.stirCenter.z};
        const Vector<R> drag{v.c.stirVelocity.x, v.c.stirVelocity.y, v.c.stirVelocity.z};
        const Vector<R> d = load(v.fluid.position, i) - center, u = load(v.fluid.velocity, i);
        const R weight = max(R(1) - dot(d, d) * R(1 / (v.c.stirRadius * v.c.stirRadius)), R(0));
        const R share = weight * R(min(real(1), v.c.stirRate * real(v.state->dt)));
        const Vector<R> wanted = subtractScaled(drag, R(v.c.stirPull), d);
        store(v.fluid.velocity, i, addScaled(u, share, wanted - u));
    }
};

}  // namespace spindrift::LANES
