// Rates and shifts of particles that are kept evenly spread.
#pragma once

#include "sim/physics/correction.h"
#include "sim/physics/density.h"
#include "sim/physics/viscous_terms.h"

namespace spindrift::LANES {

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
    struct Parameters {
        real shifting;     // shift velocity per largest speed, m
        real atNeighbour;  // 1 / w at the distance of neighbours on the lattice
        real viscosity;    // Pa s, for the kernel's own sums of Laplacians
        static Parameters of(const Model& m) {
            const Fluid& f = m.scene->fluid;
            return {real(f.shifting * 2 * m.h()), 1 / m.atNeighbour,
                    real(0.5) * viscousScale<ViscosityForm::Morris>(m, f.viscosity)};
        }
    };
    View v;
    Parameters own;
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
        const Vector<R> x = load(v.fluid.position, i), velocity = load(v.fluid.velocity, i);
        const R rho = load(v.fluid.density, i), perRest = 1 / v.c.restDensity;
        const Vector<R> slope = hydrostaticSlope(v.c, gravity, x);
        Sums s{};
        forNeighbours<Lists::Inner>(
            v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R more = load(v.fluid.density, j) - rho;
                s.add(slopeOf<Kernel>(v.c, p.q) * load(v.fluid.inverseDensity, j), p.r,
                      load(v.fluid.velocity, j) - velocity, more,
                      surface ? more + dot(slope, p.r) : more, crowding(p.q));
            });
        forNeighbours<Lists::Inner>(
            v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R more = load(v.walls.density, j) - rho;
                s.add(slopeOf<Kernel>(v.c, p.q) * load(v.walls.mass, j) * perRest, p.r,
                      flowVelocity(v.walls, j) - velocity, more, surface ? R(0) : more,
                      crowding(p.q));
            });
        finish(i, rho, s);
    }
    // Sun 2019: 1 + 0.2 (W / W(dx))^4 keeps particles from pairing.
    HD R crowding(R q) const {
        const R w = valueOf<Kernel>(v.c, q) * R(own.atNeighbour), w2 = w * w;
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
        Vector<R> wanted = (R(-own.shifting * real(v.state->speed)) * scale) * total(s.shift);
        R inside = 1;
        if constexpr (surface) {
            inside = between(real(0.6), real(0.85), correction.determinant);
            wanted = between(real(0.2), real(0.35), correction.determinant) *
                     alongSurface(wanted, inward, inside);
        }
        const Vector<R> shift = limitedShift(wanted);
        const R half = real(0.5),  // of `diffusion` is the diffusion
            nu = surface ? R(0) : R(own.viscosity) * load(v.fluid.inverseDensity, i);
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

}  // namespace spindrift::LANES
