// The passes of the incompressible formulation's pressure solve: pressures p >= 0 with which no
// density grows by where the velocities lead (Ihmsen 2014, Bender & Koschier 2015),
//     b_i + dt/rho0 (D dt a)_i = 0  where p_i > 0,    (D u)_i = sum_j m (u_i - u_j).grad W
//     a_i = -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W - p_i/rho_i^2 (1 + mu_i) B_i
// with B_i = sum_b m_b grad W. b is what densities would grow by without pressure, relative to
// rho0, and a share of what they are too large by already (Cornelis 2019 weighs both as well).
// Walls mirror the fluid's pressure, mu = 1. What they have more, that of fluid at rest in between,
// does not change as pressures do and is a force like others (Band 2018 extrapolate linearly, too).
// So an iteration asks walls for B_i alone.
// Pressures that alternate from particle to particle push none of them: D a does not see them, and
// what feeds them would add up from step to step. A fiftieth of a Laplacian that sees neighbours,
// 0.4 / R^2 sum_j m W (p_j - p_i) / rho0, holds them together (Rhie & Chow 1983 mend the same on
// grids).
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/model.h"

namespace spindrift::LANES {

// Sums over a particle's fluid neighbours where no list holds each pair once (HalfListSums).
template <class Pass, class Sum> HD inline void sumAround(const Pass& pass, ICluster i, Sum sum) {
    const View& v = pass.v;
    const Vector<Real<ICluster>> x = load(v.fluid.position, i);
    const auto own = pass.input(i);
    forNeighbours<Pass::lists>(v, v.fluidNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
        sum = sum + pass.of(p, own, pass.input(j));
    });
    pass.finish(i, total(sum));
}

// kg/m^5: by W's second moment sum_j of this times w (p_j - p_i) / rho0 is a fiftieth of the
// Laplacian.
HD inline real evenness(const StepParameters& c) {
    return real(0.4) * c.kernelScale * c.inverseSupport2;
}

// What walls give to a particle: B_i, and the acceleration by the pressure that they have more than
// the particle itself, rho0 (g - a_b).(x_b - x_i). And the operator's diagonal, with F_i = sum_j m
// grad W: -d(D a)_i / d(p_i/rho_i^2) = (F_i + (1 + mu_i) B_i).(F_i + B_i) + sum_j (m grad W)^2,
// with the sum of squares of the lattice: beside surfaces it is less, and iterations are a little
// more careful there. Where walls leave little room, as at the foot of a slope, what they mirror
// would make a particle the denser the more it pushes; they mirror just so much that it doesn't.
template <class Kernel, Lists which> struct SumGradients {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real latticeSquares;  // kg²/m^8, sum_j (m grad W)^2 of a lattice point
        static Parameters of(const Model& m) {
            const double dx = m.scene->simulation.spacing;
            return {real(m.sums.squares * dx * dx) * m.shared.gradientScale *
                    m.shared.gradientScale};
        }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const { sumAround(*this, i, Vector<R>{R(0), R(0), R(0)}); }
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Active;
    static constexpr bool opposite = true;
    struct Nothing {};
    HD VectorField field() const { return v.fluid.pressureAcceleration; }
    template <class I> HD Nothing input(I) const { return {}; }
    HD Vector<R> of(const Pair<R>& p, Nothing, Nothing) const {
        return slopeOf<Kernel>(v.c, p.q) * p.r;
    }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
    HD void finish(ICluster i, Vector<R> fluid) const {
        const Vector<real> gravity = gravityNow(v);
        const Vector<R> x = load(v.fluid.position, i);
        Vector<R> walls{R(0), R(0), R(0)}, rest = walls;
        R differences = 0;
        forNeighbours<lists>(v, v.wallsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
            const Vector<R> slope = (load(v.walls.mass, j) * slopeOf<Kernel>(v.c, p.q)) * p.r;
            const Vector<R> pull =
                bodyForce(v.c, gravity, load(v.walls.position, j)) - ownAcceleration(v.walls, j);
            walls = walls + slope;
            rest = addScaled(rest, dot(pull, p.r), slope);
            differences = negMulAdd(load(v.walls.mass, j) * valueOf<Kernel>(v.c, p.q),
                                    dot(pull, p.r), differences);
        });
        const R scale = v.c.gradientScale, zero = 0;
        const Vector<R> toWalls = scale * total(walls), all = scale * fluid + toWalls;
        const R push = dot(all, all), mirror = dot(toWalls, all), squares = own.latticeSquares,
                bears = mulAdd(R(real(0.5)), squares, push);
        const R mirrored = bears / max(zero - mirror, bears);
        store(v.fluid.wallGradient, i, toWalls);
        store(v.fluid.residual, i, total(differences));
        store(v.fluid.mirrored, i, mirrored);
        store(v.fluid.diagonal, i, max(mulAdd(mirrored, mirror, push), zero) + squares);
        store(v.fluid.acceleration, i,
              addScaled(load(v.fluid.acceleration, i), R(v.c.gradientScale / v.c.restDensity),
                        total(rest)));
    }
};

// Of an error of density, what a step takes out: of one in which the flow moves 0.4 h what is asked
// for, of a shorter one less. (As much of each lets particles fly apart the faster the shorter
// steps are.)
struct ShareTakenOut {
    real densityShare;
    static ShareTakenOut of(const Model& m) { return {m.scene->solver.densityShare}; }
    HD real now(const View& v) const {
        const StepParameters& c = v.c;
        const real speed = max(max(real(v.state->speed), c.solidSpeed), c.leastSpeed);
        return densityShare * min(real(v.state->dt) * speed / (real(0.2) * c.support), real(1));
    }
};

// b_i. Where fluid is torn it may come together again until it is as dense as at rest; gaps too
// small to be seen close like any other error of density. (Closing at once, fluid at rest falls
// freely through every one of them, and bounces.)
template <class Kernel, Lists which> struct FindSource {
    using Index = ICluster;
    using R = Real<ICluster>;
    static constexpr double small = 0.02;  // share of rho0
    using Parameters = ShareTakenOut;
    View v;
    Parameters share;
    HD void operator()(ICluster i) const { sumAround(*this, i, R(0)); }
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Active;
    static constexpr bool opposite = false;
    HD ScalarField field() const { return v.fluid.source; }
    template <class I> HD Vector<R> input(I i) const { return load(v.fluid.velocity, i); }
    HD R of(const Pair<R>& p, Vector<R> own, Vector<R> other) const {
        return slopeOf<Kernel>(v.c, p.q) * dot(own - other, p.r);
    }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
    HD void finish(ICluster i, R fluid) const {
        const Vector<R> own = input(i);
        const R differences = load(v.fluid.residual, i);  // of walls' pressures
        R walls = 0;
        forNeighbours<lists>(v, v.wallsNearFluid, i, load(v.fluid.position, i),
                             [&](const auto& p, JCluster j) LANE_CALL {
                                 const Vector<R> apart = own - ownVelocity(v.walls, j);
                                 walls = mulAdd(load(v.walls.mass, j) * slopeOf<Kernel>(v.c, p.q),
                                                dot(apart, p.r), walls);
                             });
        const real perRest = 1 / v.c.restDensity;
        const R grown = R(v.c.gradientScale) * (fluid + total(walls));
        const real even = evenness(v.c) * real(v.state->dt * v.state->dt) * perRest;
        const R error = mulAdd(R(perRest), load(v.fluid.density, i), R(-1)),
                torn = min(error + R(real(small)), R(0));
        store(field(), i,
              mulAdd(R(perRest * real(v.state->dt)), grown,
                     mulAdd(R(share.now(v)), error - torn, mulAdd(R(even), differences, torn))));
        store(v.fluid.lastPressure, i, load(v.fluid.pressureOverRho2, i));
    }
};

// a_i, of pressures as they are.
template <class Kernel, Lists which> struct AccelerateByPressure {
    using Index = ICluster;
    using R = Real<ICluster>;
    View v;
    HD void operator()(ICluster i) const { sumAround(*this, i, Vector<R>{R(0), R(0), R(0)}); }
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Active;
    static constexpr bool opposite = true;
    HD VectorField field() const { return v.fluid.pressureAcceleration; }
    template <class I> HD R input(I i) const { return load(v.fluid.pressureOverRho2, i); }
    HD Vector<R> of(const Pair<R>& p, R own, R other) const {
        return (slopeOf<Kernel>(v.c, p.q) * (own + other)) * p.r;
    }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
    HD void finish(ICluster i, Vector<R> fluid) const {
        const R pressure = input(i);
        const Vector<R> walls =
            mulAdd(pressure, load(v.fluid.mirrored, i), pressure) * load(v.fluid.wallGradient, i);
        store(field(), i, R(-v.c.gradientScale) * fluid - walls);
        store(v.fluid.triedPressure, i, pressure);
    }
};

// Better pressures: a relaxed Jacobi iteration, and from there on in the direction of the last
// change (Nesterov 1983, with p >= 0 Beck & Teboulle 2009). What is left is what that changes
// growths of density by: they are too large, or smaller than they would be with less pressure.
// (Counting the first alone, last step's pressures threw fluid apart after every blow.)
template <class Kernel, Lists which> struct RelaxPressure {
    using Index = ICluster;
    using R = Real<ICluster>;
    struct Parameters {
        real relaxation, even;
        static Parameters of(const Model& m) {
            const StepParameters& c = m.shared;
            return {real(m.scene->solver.relaxation / m.largestEigenvalue),
                    evenness(c) * c.restDensity / c.gradientScale};
        }
    };
    View v;
    Parameters own;
    HD void operator()(ICluster i) const { sumAround(*this, i, R(0)); }
    static constexpr Lists lists = which;
    static constexpr uint8_t activeFrom = Active;
    static constexpr bool opposite = false;
    HD ScalarField field() const { return v.fluid.residual; }
    struct Pushed {
        Vector<R> acceleration;
        R pressure;
    };
    template <class I> HD Pushed input(I i) const {
        return {load(v.fluid.pressureAcceleration, i),
                R(own.even) * load(v.fluid.triedPressure, i)};
    }
    // Both get the same of a pair: of pressures their sum, of which twice the own is taken off in
    // the end.
    HD R of(const Pair<R>& p, const Pushed& own, const Pushed& other) const {
        return mulAdd(slopeOf<Kernel>(v.c, p.q), dot(own.acceleration - other.acceleration, p.r),
                      valueOf<Kernel>(v.c, p.q) * (own.pressure + other.pressure));
    }
    HD void finish(ICluster i) const { finish(i, load(field(), i)); }
    HD void finish(ICluster i, R fluid) const {
        const real dt2 = real(v.state->dt * v.state->dt);
        const Pushed self = input(i);
        const R sum = fluid - (self.pressure + self.pressure) * load(v.fluid.fluidWeight, i);
        const R change = mulAdd(R(v.c.gradientScale), sum,
                                dot(self.acceleration, load(v.fluid.wallGradient, i)));
        const R left = mulAdd(R(dt2 / v.c.restDensity), change, load(v.fluid.source, i));
        const R step = R(own.relaxation * v.c.restDensity / dt2) / load(v.fluid.diagonal, i);
        const R zero = 0, now = load(v.fluid.pressureOverRho2, i),
                last = load(v.fluid.lastPressure, i), better = max(mulAdd(step, left, now), zero);
        store(v.fluid.lastPressure, i, better);
        store(v.fluid.pressureOverRho2, i,
              max(mulAdd(R(real(v.state->momentum)), better - last, better), zero));
        store(field(), i, (better - now) / step);
    }
};

// What is left to be solved, without signs; what pressures do to densities where there are any;
// and the work of both along the pressures, p.left, which is 0 when they are right, and p.made.
struct SolveError {
    double sum = 0, count = 0, made = 0, workLeft = 0, workMade = 0;
    HD_OUT void add(const SolveError& o) {
        sum += o.sum, count += o.count, made += o.made;
        workLeft += o.workLeft, workMade += o.workMade;
    }
};
struct SumError {
    Particles p;
    HD void addTo(SolveError& e, int i) const {
        if (p.id[i] < 0) return;
        const real left = load(p.residual, i), made = load(p.source, i) - left;
        const double pressure = double(load(p.lastPressure, i));
        e.add({double(max(left, -left)), 1, pressure > 0 ? double(max(made, -made)) : 0,
               pressure * double(left), pressure * double(made)});
    }
};

// How the iterations of a step go: `allowed` is the mean error of density with which they end.
struct SolveProgress {
    double weight = 1, allowed = 0;
    SolveError error{1e300};
    int iterations = 0;  // of this step; of the run, the steps in which densities were not found,
    int failures = 0, rough = 0;  // and in which long waves of pressure were not
    int goesOn = 1;
    HD bool isFound() const { return error.sum <= allowed * error.count; }
    // In deep fluid and short steps a small error of density may be all that pressures do: it is
    // to be less than that.
    HD bool isRough() const { return error.sum > 0.3 * error.made; }
    HD static double after(double weight) { return (1 + sqrt(1 + 4 * weight * weight)) / 2; }
};
// As a step takes out a share of what densities are too large by, they settle where that is what
// steps leave, of both signs. In a dam break they are too large by 0.7 of what is asked for;
// without the factor, for 2.4 times as many iterations, by 0.6.
struct BeginSolve {
    using Index = int;
    View v;
    ShareTakenOut share;
    double densityError;
    SolveProgress* progress;
    HD void operator()(int) const {
        const int failures = progress->failures, rough = progress->rough;
        *progress = SolveProgress{};
        progress->failures = failures, progress->rough = rough;
        progress->allowed = 3 * densityError * double(share.now(v));
        v.state->momentum = 0;
    }
};
// How far the next iteration goes on in the direction of the last change: the further the longer it
// goes well, and where errors grow from the beginning (O'Donoghue & Candes 2015).
struct ChooseMomentum {
    using Index = int;
    StepState* state;
    const SolveError* error;
    int mostIterations;
    SolveProgress* progress;
    HD void operator()(int) const {
        SolveProgress& p = *progress;
        p.weight = error->sum > p.error.sum ? 1 : SolveProgress::after(p.weight);
        p.error = *error;
        state->momentum = (p.weight - 1) / SolveProgress::after(p.weight);
        ++p.iterations;
        p.goesOn = (!p.isFound() || p.isRough()) && p.iterations < mostIterations;
        p.failures += !p.goesOn && !p.isFound();
        p.rough += !p.goesOn && p.isRough();
    }
};

// Where pressures were not found the next steps are shorter, by half each time. What is left in
// long waves, which take the most iterations, is left in pressures as a whole as well: all of them
// times 1 + p.left / p.made have no work left to do. A quarter of that is done, in each step.
struct EndSolve {
    using Index = int;
    StepState* state;
    const SolveProgress* progress;
    HD void operator()(int) const {
        const double share = state->share * (progress->isFound() ? 1.2 : 0.5);
        state->share = share > 1 ? 1 : share < 0.05 ? 0.05 : share;
        const SolveError& e = progress->error;
        const double whole = e.workMade > 0 ? e.workLeft / e.workMade : 0;
        state->pressureScale = 1 + 0.25 * (whole > 1 ? 1 : whole < -0.5 ? -0.5 : whole);
    }
};
struct ScalePressures {
    using Index = Lanes4;
    using R = Real<Lanes4>;
    View v;
    HD void operator()(Lanes4 i) const {
        const R scale = real(v.state->pressureScale);
        store(v.fluid.pressureOverRho2, i, scale * load(v.fluid.pressureOverRho2, i));
        store(v.fluid.pressureAcceleration, i, scale * load(v.fluid.pressureAcceleration, i));
    }
};

}  // namespace spindrift::LANES
