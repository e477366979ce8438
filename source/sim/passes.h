// The passes of a step. A pass is a struct with a View and operator()(index); it reads neighbours and writes its
// own particles only, never a field that it gathers. `Index` says how many particles one call works on.
#if defined(SPINDRIFT_SIM_PASSES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_PASSES_H
#undef SPINDRIFT_SIM_PASSES_H
#else
#define SPINDRIFT_SIM_PASSES_H
#endif

#include "core/vertex.h"
#include "sim/kernels.h"
#include "sim/terms.h"

namespace spindrift::LANES {

// Empty slots lie beyond this coordinate, m.
inline constexpr real farAway = 1e6;

// Sort key: the particle's cell, or -1 for an empty slot. Who is nowhere (not finite) has no neighbours in any cell; such
// particles are spread, because all of them in one cell would take forever.
struct FindCell {
    using Index = int;
    Particles p;
    Grid grid;
    int* key;
    HD void operator()(int i) const {
        const Vector<real> x = load(p.position, i);
        const bool somewhere = dot(x, x) - dot(x, x) == 0;
        key[i] = p.id[i] < 0 ? -1 : somewhere ? grid.cell(x) : i % (grid.cells.x * grid.cells.y * grid.cells.z);
    }
};

// Moves what a particle carries from step to step to its new slot. Boundary particles have no velocity.
struct Reorder {
    using Index = int;
    const int* order;
    Particles from, to;
    HD void operator()(int i) const {
        const int s = order[i];
        to.id[i] = s < 0 ? -1 : from.id[s];
        // Empty slots: so far out that no distance to anybody is small or equal.
        const real far = 2 * farAway * real(1 + i % 4);
        store(to.position, i, s < 0 ? Vector<real>{far, far, far} : load(from.position, s));
        if (to.velocity.data) store(to.velocity, i, s < 0 ? Vector<real>{0, 0, 0} : load(from.velocity, s));
    }
};

// m_b = f rho0 / sum W over the boundary particles, itself included (Akinci 2012, their eq. 4 and 5), but no less than
// wallMassFloor: in the edges of a box, where two walls meet, the wall would become thin.
template <class Kernel> struct ComputeWallMass {
    using Index = Group;
    View v;
    HD void operator()(Group i) const {
        Real<Group> sum = 0;
        forNeighbours<Lists::All>(v, v.wallsNearWalls, i, load(v.walls.position, i), [&](const auto& p, Four) LANE_CALL {
            sum += Kernel::w(p.q);
        });
        const Real<Group> mass = Real<Group>(v.c.wallFactor * v.c.restDensity / v.c.kernelScale) / total(sum);
        store(v.walls.mass, i, max(mass, Real<Group>(v.c.wallMassFloor)));
    }
};

// rho_i = sum_j m W + sum_b m_b W, then the equation of state p = max(0, k ((rho/rho0)^gamma - 1)).
template <class Kernel> struct ComputeDensity {
    using Index = Group;
    using R = Real<Group>;
    View v;
    HD void operator()(Group i) const {
        const Vector<R> x = load(v.fluid.position, i);
        R fluid = 0, walls = 0;
        forNeighbours<Lists::Prune>(v, v.fluidNearFluid, i, x, [&](const auto& p, Four) LANE_CALL { fluid += Kernel::w(p.q); });
        forNeighbours<Lists::Prune>(v, v.wallsNearFluid, i, x, [&](const auto& p, Four j) LANE_CALL {
            walls = mulAdd(load(v.walls.mass, j), Kernel::w(p.q), walls);
        });
        const R others = total(fluid) + R((v.c.selfWeight - 1) * Kernel::w(real(0)));
        const R rho = R(v.c.kernelScale) * (others + total(walls));
        storeState(i, rho);
    }
    HD void storeState(Group i, R rho) const {
        const R ratio = rho * R(1 / v.c.restDensity);
        R power = ratio;
        for (int k = 1; k < v.c.gamma; ++k) power = power * ratio;
        const R pressure = max(R(v.c.stiffness) * (power - R(1)), R(0));
        const R inverse = R(1) / max(rho, R(real(0.01) * v.c.restDensity));
        store(v.fluid.density, i, rho);
        store(v.fluid.inverseDensity, i, inverse);
        store(v.fluid.pressureTerm, i, pressure * inverse * inverse);
    }
};

// What the fluid's pressure would be at a boundary particle: p_b = sum_f (p_f + rho_f g.(x_b - x_f)) W / sum_f W,
// Adami 2012, eq. 27, for walls at rest. Walls don't pull. With `sticks` also the velocity that makes it zero at the wall:
// v_b = -sum_f v_f W / sum_f W, eq. 23.
template <class Kernel, bool sticks> struct ExtrapolateToWalls {
    using Index = Group;
    using R = Real<Group>;
    View v;
    HD void operator()(Group b) const {
        const Vector<R> gravity{v.c.gravity.x, v.c.gravity.y, v.c.gravity.z};
        R pressure = 0, weight = 0;
        Vector<R> velocity{0, 0, 0};
        forNeighbours<Lists::All>(v, v.fluidNearWalls, b, load(v.walls.position, b), [&](const auto& p, Four j) LANE_CALL {
            const R rho = load(v.fluid.density, j), w = Kernel::w(p.q);
            pressure = mulAdd(w * rho, mulAdd(rho, load(v.fluid.pressureTerm, j), dot(gravity, p.r)), pressure);
            weight += w;
            if constexpr (sticks) velocity = addScaled(velocity, w, load(v.fluid.velocity, j));
        });
        const R perWeight = R(1) / max(total(weight), R(real(1e-6)));
        const R mean = max(total(pressure), R(0)) * perWeight;
        store(v.walls.pressureTerm, b, mean * R(1 / (v.c.restDensity * v.c.restDensity)));
        if constexpr (sticks) store(v.walls.velocity, b, R(-1) * perWeight * total(velocity));
    }
};

// a_i = gravity + m gradientNorm/R^5 times the sum of the scene's terms.
template <class Kernel, class Terms> struct ComputeForces;
template <class Kernel, class... Terms> struct ComputeForces<Kernel, TermList<Terms...>> {
    using Index = Group;
    using R = Real<Group>;
    static constexpr unsigned needs = TermList<Terms...>::needs;
    View v;
    HD void operator()(Group i) const {
        const Vector<R> x = load(v.fluid.position, i);
        const State<R> own = loadState<needs>(v.fluid, i);
        const R zero = 0;
        Acceleration<R> a{{zero, zero, zero}, {zero, zero, zero}};
        forNeighbours<Lists::Pruned>(v, v.fluidNearFluid, i, x, [&](const auto& p, Four j) LANE_CALL {
            const State<R> other = loadState<needs>(v.fluid, j);
            (Terms::add(v.c, p, Kernel::g(p.q), own, other, a), ...);
        });
        forNeighbours<Lists::Pruned>(v, v.wallsNearFluid, i, x, [&](const auto& p, Four j) LANE_CALL {
            (Terms::addWall(v.c, p, Kernel::g(p.q), own, loadWall<needs>(v.walls, j), a), ...);
        });
        const R scale = v.c.gradientScale;
        const Vector<R> gravity{v.c.gravity.x, v.c.gravity.y, v.c.gravity.z};
        store(v.fluid.acceleration, i, limited(scale * total(a.pressure)) + scale * total(a.other) + gravity);
    }
    HD Vector<R> limited(Vector<R> a) const {
        const R limit = v.c.accelerationLimit;
        return (limit / squareRoot(max(dot(a, a), limit * limit))) * a;
    }
};

// The largest speed and acceleration, for the time step.
struct Extremes {
    float speed2 = 0, acceleration2 = 0;   // (m/s)^2, (m/s^2)^2
    HD_OUT void add(const Extremes& o) {
        speed2 = o.speed2 > speed2 ? o.speed2 : speed2;
        acceleration2 = o.acceleration2 > acceleration2 ? o.acceleration2 : acceleration2;
    }
};
struct FindExtremes {
    Particles p;
    HD void addTo(Extremes& e, int i) const {
        if (p.id[i] < 0) return;
        const Vector<real> u = load(p.velocity, i), a = load(p.acceleration, i);
        e.add({float(dot(u, u)), float(dot(a, a))});
    }
};

// dt from the sound speed, the largest velocity and acceleration, and the viscosity (Monaghan 1992, Morris 1997).
struct ChooseTimeStep {
    using Index = int;
    View v;
    const Extremes* extremes;
    HD void operator()(int) const {
        const Constants& c = v.c;
        real dt = c.fixedStep;
        if (dt <= 0) {
            const real h = c.support / 2;
            const real speed = squareRoot(real(extremes->speed2));
            const real pull = squareRoot(real(extremes->acceleration2));
            dt = min(c.cfl * h / (c.soundSpeed + speed), min(c.maxStep, c.viscousStep));
            dt = min(dt, real(0.25) * squareRoot(h / max(pull, real(1e-12))));
        }
        v.state->dt = dt;
        v.state->time += dt;
        ++v.state->steps;
    }
};

// The mouse drags the fluid inside a sphere towards its own velocity, strongest in the middle.
struct StirFluid {
    using Index = Quad;
    View v;
    HD void operator()(Quad i) const {
        using R = Real<Quad>;
        const Vector<R> center{v.c.stirCenter.x, v.c.stirCenter.y, v.c.stirCenter.z};
        const Vector<R> drag{v.c.stirVelocity.x, v.c.stirVelocity.y, v.c.stirVelocity.z};
        const Vector<R> d = load(v.fluid.position, i) - center, u = load(v.fluid.velocity, i);
        const R weight = max(R(1) - dot(d, d) * R(1 / (v.c.stirRadius * v.c.stirRadius)), R(0));
        const R share = weight * R(min(real(1), real(30) * real(v.state->dt)));
        store(v.fluid.velocity, i, addScaled(u, share, drag - u));
    }
};

// Symplectic Euler: v += a dt, x += v dt; who leaves the box is put back on its face and bounces, or enters on the other
// side.
struct Integrate {
    using Index = Quad;
    using R = Real<Quad>;
    View v;
    HD void operator()(Quad i) const {
        const R dt = real(v.state->dt);
        Vector<R> u = addScaled(load(v.fluid.velocity, i), dt, load(v.fluid.acceleration, i));
        Vector<R> x = addScaled(load(v.fluid.position, i), dt, u);
        v.c.period.x > 0 ? wrap(x.x, v.c.period.x) : bounce(x.x, v.c.low.x, v.c.high.x, u.x, u.y, u.z);
        v.c.period.y > 0 ? wrap(x.y, v.c.period.y) : bounce(x.y, v.c.low.y, v.c.high.y, u.y, u.z, u.x);
        v.c.period.z > 0 ? wrap(x.z, v.c.period.z) : bounce(x.z, v.c.low.z, v.c.high.z, u.z, u.x, u.y);
        store(v.fluid.velocity, i, u);
        store(v.fluid.position, i, keepEmpty(load(v.fluid.position, i), x));
    }
    // The box would pull empty slots in among the particles.
    HD static Vector<R> keepEmpty(Vector<R> before, Vector<R> after) {
        const auto empty = before.x > R(farAway);
        return {select(empty, before.x, after.x), select(empty, before.y, after.y), select(empty, before.z, after.z)};
    }
    HD static void wrap(R& x, real period) { x = x - R(period) * roundDown(x * R(1 / period)); }
    HD void bounce(R& x, real low, real high, R& normal, R& tangent1, R& tangent2) const {
        const R inside = min(R(high), max(R(low), x));   // in this order what is no number stays none
        const R depth = (x - inside) * (x - inside);
        const auto hit = depth > R(0);
        normal = select(hit, R(-v.c.restitution) * normal, normal);
        tangent1 = select(hit, R(1 - v.c.friction) * tangent1, tangent1);
        tangent2 = select(hit, R(1 - v.c.friction) * tangent2, tangent2);
        x = inside;
    }
};

}  // namespace spindrift::LANES

#endif
