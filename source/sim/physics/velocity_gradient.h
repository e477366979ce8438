// What pictures show of how velocity changes from place to place.
#pragma once

#include "sim/physics/correction.h"
#include "sim/physics/kernels.h"
#include "sim/physics/model.h"

#include <cmath>

namespace spindrift::LANES {

// Row a is the gradient of velocity's component a, 1/s.
template <class R> struct VelocityGradient { Vector<R> u, v, w; };

// |rot u|, in two dimensions rot u itself, positive where fluid turns from x to y.
struct VorticityOf {
    template <class R> HD static R of(const VelocityGradient<R>& g, bool flat) {
        const Vector<R> turn{g.w.y - g.v.z, g.u.z - g.w.x, g.v.x - g.u.y};
        return flat ? turn.z : squareRoot(dot(turn, turn));
    }
};
// sqrt(2 D:D), D the symmetric part: in simple shear its rate.
struct ShearRateOf {
    template <class R> HD static R of(const VelocityGradient<R>& g, bool) {
        const R xy = g.u.y + g.v.x, xz = g.u.z + g.w.x, yz = g.v.z + g.w.y;
        const R along = mulAdd(g.u.x, g.u.x, mulAdd(g.v.y, g.v.y, g.w.z * g.w.z));
        return squareRoot(mulAdd(R(2), along, mulAdd(xy, xy, mulAdd(xz, xz, yz * yz))));
    }
};
struct DivergenceOf {
    template <class R> HD static R of(const VelocityGradient<R>& g, bool) {
        return g.u.x + g.v.y + g.w.z;
    }
};

// From the corrected gradient over fluid alone, exact for linear fields wherever a particle has
// neighbours enough (Randles & Libersky 1996; order 2 in the bulk, 1 at edges); 0 for one that is
// alone. What is found stands in place of the length of the surface's normal.
template <class Value> struct FromVelocityGradient {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real scale;  // of MeanKernel's sums / gradientScale, so that moments are 1 on a lattice
        static Parameters of(const Model& m) {
            const int d = m.dimensions();
            return {real(m.mass / m.restDensity() * MeanKernel::gradient(d) * MeanKernel::norm(d) /
                         std::pow(m.support(), d + 2) / double(m.shared.gradientScale))};
        }
    };
    View v;
    Parameters own;
    struct Sums {
        Symmetric<R> moments;
        Vector<R> u, v, w;
    };
    HD void operator()(ICluster i) const {
        const Vector<R> x = load(v.fluid.position, i), velocity = load(v.fluid.velocity, i);
        Sums s{};
        forNeighbours<Lists::All>(
            v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R weight = R(own.scale) * MeanKernel::g(p.q);
                const Vector<R> other = load(v.fluid.velocity, j), wr = weight * p.r;
                const Vector<R> less = other - velocity;
                s.moments = addOuter(s.moments, weight, p.r);
                s.u = addScaled(s.u, less.x, wr), s.v = addScaled(s.v, less.y, wr);
                s.w = addScaled(s.w, less.z, wr);
            });
        // At the corner of a block the determinant is a twentieth.
        const Correction<R> correction(v.c, total(s.moments), real(1e-3));
        const auto corrected = [&](Vector<R> sum) LANE_CALL {
            return correction.inverse * (R(v.c.gradientScale) * total(sum));
        };
        store(v.fluid.normalLength, i,
              Value::of(VelocityGradient<R>{corrected(s.u), corrected(s.v), corrected(s.w)},
                        v.c.dimensions == 2));
    }
};

// How many other particles of fluid are nearer than the support, in the same place.
struct CountNeighbours {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster i) const {
        R sum = 0;
        const R one = 1, zero = 0;
        forNeighbours<Lists::All>(v, v.fluidNearFluid, i, load(v.fluid.position, i),
                                  [&](const auto& p, JCluster)
                                      LANE_CALL { sum += select(p.q < one, one, zero); });
        store(v.fluid.normalLength, i, total(sum) - one);
    }
};

}  // namespace spindrift::LANES
