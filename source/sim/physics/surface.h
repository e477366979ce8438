// The surface of the fluid: where it faces, how it bends, and its tension. Continuum surface force
// (Brackbill 1992, Morris 2000): per volume sigma kappa n, n the gradient of a colour that is 1 in
// fluid and 0 in air.
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/model.h"

#include <cmath>

namespace spindrift::LANES {

// n_i = sum_j V grad W, V = m / rho0: points inward, is 1.5 / R long at a flat surface and vanishes
// a support radius below it. Walls have the colour of fluid: they are wetted. (Tried: (1 + cos
// theta) / 2, for surfaces whose tensions are as their steps in colour meet at the angle theta.
// Drops with theta = 60, 90 and 120 degrees all drew up and left the wall.)
struct ComputeNormals {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real scale;  // m gradientNorm / (rho0 R^5), 1/m
        real least;  // 1/m: shorter ones belong to no surface; a tenth of that of a flat one
        static Parameters of(const Model& m) {
            const int d = m.dimensions();
            return {real(m.mass / m.restDensity() * MeanKernel::gradient(d) * MeanKernel::norm(d) /
                         std::pow(m.support(), d + 2)),
                    real(0.15 / m.support())};
        }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const {
        Vector<R> sum{0, 0, 0};
        const Vector<R> x = load(v.fluid.position, i);
        forNeighbours<lists>(v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster) LANE_CALL {
            sum = addScaled(sum, MeanKernel::g(p.q), p.r);
        });
        finish(i, x, total(sum));
    }
    HD void finish(ICluster i, Vector<R> x, Vector<R> fluid) const {
        Vector<R> walls{0, 0, 0};
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            walls = addScaled(walls, load(v.walls.mass, j) * MeanKernel::g(p.q), p.r);
        });
        const Vector<R> n = R(own.scale) * (fluid + total(walls));
        const R length = squareRoot(dot(n, n)), least = own.least, zero = 0;
        store(v.fluid.normal, i, select(length > least, R(1) / max(length, least), zero) * n);
        store(v.fluid.normalLength, i, length);
    }
    // For lists with each pair once (HalfListSums).
    static constexpr Lists lists = Lists::Inner;
    static constexpr uint8_t activeFrom = Inactive;
    static constexpr bool opposite = true;
    struct Nothing {};
    HD VectorField field() const { return v.fluid.normal; }
    template <class I> HD Nothing input(I) const { return {}; }
    HD Vector<R> of(const Pair<R>& p, Nothing, Nothing) const { return MeanKernel::g(p.q) * p.r; }
    HD void finish(ICluster i) const { finish(i, load(v.fluid.position, i), load(field(), i)); }
};

// For the eye: 1 where the colour's gradient is more than half of what it is at a flat surface,
// otherwise 0. In place of the normal, for LeaveOutSpray.
struct TagSurface {
    using Index = Lanes4;
    View v;
    HD void operator()(Lanes4 i) const {
        using R = Real<Lanes4>;
        const R steep =
            select(load(v.fluid.normalLength, i) > R(real(0.75) / v.c.support), R(1), R(0));
        store(v.fluid.normal, i, Vector<R>{steep, R(0), R(0)});
    }
};

// A surface bounds fluid. A particle whose sum of W over the fluid is less than four fifths of that
// in a corner of a block is spray, walls not counted: single drops and the first few that meet have
// one-sided surroundings too, at walls above all.
struct LeaveOutSpray {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real leastCompany;  // sum of w
        static Parameters of(const Model& m) {
            return {real(0.8 * latticeCorner<MeanKernel>(*m.scene))};
        }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const {
        R sum = 0;
        forNeighbours<lists>(v, v.fluidNearFluid, i, load(v.fluid.position, i),
                             [&](const auto& p, JCluster) LANE_CALL { sum += MeanKernel::w(p.q); });
        finish(i, total(sum));
    }
    HD void finish(ICluster i, R company) const {
        const R tag = load(v.fluid.normal, i).x;
        store(v.fluid.normalLength, i, select(company > R(own.leastCompany), tag, R(0)));
    }
    // For lists with each pair once (HalfListSums).
    static constexpr Lists lists = Lists::Inner;
    static constexpr uint8_t activeFrom = Inactive;
    static constexpr bool opposite = false;
    struct Nothing {};
    HD ScalarField field() const { return v.fluid.normalLength; }
    template <class I> HD Nothing input(I) const { return {}; }
    HD R of(const Pair<R>& p, Nothing, Nothing) const { return MeanKernel::w(p.q); }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
};

// a_i += 2 sigma / rho0 kappa n. Twice, because half of the colour's gradient lies in the air,
// where nothing is to be pulled. The curvature is that of Adami 2010, but by distances along the
// surface, so that it doesn't matter how deep neighbours still have a normal:
//     kappa = -div n^ = (1 - d) sum_j (n^_i - n^_j).grad W / sum_j (r - n^ n^.r).grad W (with
//     Adami's r.grad W and -d drops swing 1.3 times as fast)
struct AddSurfaceTension {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real tension;  // 2 sigma / rho0, m³/s²
        static Parameters of(const Model& m) {
            return {real(2 * m.scene->fluid.surfaceTension / m.restDensity())};
        }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const {
        const Vector<R> n = load(v.fluid.normal, i);
        R turn = 0, along = 0;
        forNeighbours<Lists::Inner>(
            v, v.fluidNearFluid, i, load(v.fluid.position, i),
            [&](const auto& p, JCluster j) LANE_CALL {
                const Vector<R> other = load(v.fluid.normal, j);
                const R zero = 0,
                        g = select(dot(other, other) > R(real(0.5)), MeanKernel::g(p.q), zero),
                        in = dot(n, p.r), out = dot(other, p.r);
                turn = mulAdd(g, in - out, turn);
                along = mulAdd(g, negMulAdd(R(real(0.5)), mulAdd(in, in, out * out), p.distance2),
                               along);
            });
        const real most =
            2 * real(v.c.dimensions - 1) / v.c.support;  // a drop of half a support radius
        const R bent =
            R(real(1 - v.c.dimensions)) * total(turn) / max(total(along), R(real(1e-20)));
        const R s =
            R(own.tension) * min(max(bent, R(-most)), R(most)) * load(v.fluid.normalLength, i);
        store(v.fluid.acceleration, i, addScaled(load(v.fluid.acceleration, i), s, n));
    }
};

}  // namespace spindrift::LANES
