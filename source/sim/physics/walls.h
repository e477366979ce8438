// What boundary particles weigh, and what they take from the fluid beside them.
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/kernels.h"

namespace spindrift::LANES {

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

}  // namespace spindrift::LANES
