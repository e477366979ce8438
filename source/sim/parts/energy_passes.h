// The passes that find what forces, walls and rates do to the fluid's energy in a step.
#pragma once

#include "sim/energy_ledger.h"
#include "sim/particles/view.h"

namespace spindrift::LANES {

HD inline double product(Vector<real> a, Vector<real> b) {
    return double(a.x) * double(b.x) + double(a.y) * double(b.y) + double(a.z) * double(b.z);
}

// W per kg of the scene's particle: sum m a.u of all forces on the fluid, and of some of them; of
// pressure also of the part that is the walls' own.
struct Power {
    double all = 0, body = 0, pressure = 0, ofWalls = 0, viscosity = 0, artificial = 0;
    HD_OUT void add(const Power& o) {
        all += o.all, body += o.body, pressure += o.pressure, ofWalls += o.ofWalls,
            viscosity += o.viscosity, artificial += o.artificial;
    }
};
struct SumPower {
    View v;
    VectorField all, pressure, ofWalls, viscosity, artificial;  // m/s², null: there is none
    // Of a step's kick that is still to come, so that velocities are those of its middle: with them
    // a kick's work is exactly what kinetic energy grows by.
    real share;
    HD void addTo(Power& sum, int i) const {
        if (v.fluid.id[i] < 0) return;
        const Vector<real> a = load(v.fluid.acceleration, i);
        const Vector<real> u = addScaled(load(v.fluid.velocity, i), share * real(v.state->dt), a);
        const double mass = massRatio(v.fluid, i);
        const auto of = [&](const VectorField& part) LANE_CALL {
            return part.data ? mass * product(load(part, i), u) : 0.0;
        };
        sum.add({of(all),
                 mass * product(bodyForce(v.c, gravityNow(v), load(v.fluid.position, i)), u),
                 of(pressure), of(ofWalls), of(viscosity), of(artificial)});
    }
};

// Likewise what walls that move do to the fluid, by pressure, of which their own, and by the other
// forces, of which artificial viscosity.
struct WallPower {
    double pressure = 0, own = 0, other = 0, artificial = 0;
    HD_OUT void add(const WallPower& o) {
        pressure += o.pressure, own += o.own, other += o.other, artificial += o.artificial;
    }
};
struct SumWallPower {
    View v;
    VectorField pressure, own, other, artificial;  // m/s², what the fluid does to them
    HD void addTo(WallPower& sum, int i) const {
        if (v.walls.id[i] < 0) return;
        const Vector<real> u = ownVelocity(v.walls, i);
        const auto of = [&](const VectorField& part)
                            LANE_CALL { return part.data ? -product(load(part, i), u) : 0.0; };
        sum.add({of(pressure), of(own), of(other), of(artificial)});
    }
};

// What diffusion of density gives to the energy of compression, W per kg; what the velocity gives
// with which flow goes on into walls, in place of their own; what shifting gives, and in what fills
// its space the part of viscosity that goes with rates.
struct RatePower {
    double diffusion = 0, walls = 0, shifting = 0, viscosity = 0;
    HD_OUT void add(const RatePower& o) {
        diffusion += o.diffusion, walls += o.walls, shifting += o.shifting,
            viscosity += o.viscosity;
    }
};
struct SumRatePower {
    View v;
    // kg/(m^3 s), rates of density without one of them; null: it isn't there.
    ScalarField undiffused, withWallsOwn, unshifted;
    VectorField unshiftedAcceleration;  // m/s²
    bool hasPotential;
    HD void addTo(RatePower& sum, int i) const {
        if (v.fluid.id[i] < 0) return;
        const double perRate = load(v.fluid.pressureOverRho2, i),
                     rate = load(v.fluid.densityRate, i);
        RatePower one{perRate * (rate - double(load(undiffused, i)))};
        if (withWallsOwn.data) one.walls = perRate * (rate - double(load(withWallsOwn, i)));
        if (unshifted.data) {
            const Vector<real> a = load(v.fluid.shiftAcceleration, i),
                               still = load(unshiftedAcceleration, i);
            const Vector<real> u =
                addScaled(load(v.fluid.velocity, i), real(0.5) * real(v.state->dt), a);
            const Vector<real> pull = bodyForce(v.c, gravityNow(v), load(v.fluid.position, i));
            one.shifting = product(a - still, u) + perRate * (rate - double(load(unshifted, i)));
            if (hasPotential) one.shifting -= product(pull, load(v.fluid.shiftVelocity, i));
            one.viscosity = product(still, u);
        }
        sum.add(one);
    }
};

struct Total {
    double sum = 0;
    HD_OUT void add(const Total& o) { sum += o.sum; }
};

// m u^2 / 2 per kg of the scene's particle, (m/s)^2.
struct SumKinetic {
    Particles p;
    HD void addTo(Total& kinetic, int i) const {
        if (p.id[i] < 0) return;
        const Vector<real> u = load(p.velocity, i);
        kinetic.add({double(massRatio(p, i)) * product(u, u) / 2});
    }
};

struct KeepAcceleration {
    using Index = Lanes4;
    View v;
    VectorField out;
    HD void operator()(Lanes4 i) const { store(out, i, load(v.fluid.acceleration, i)); }
};

// Energy of compression, J per kg: what pressure has taken up from rest density on, the integral of
// p / rho^2. Where pressure has an end, as that of summed densities at 0, so has what it takes up.
struct SumCompression {
    View v;
    HD void addTo(Total& c, int i) const {
        if (v.fluid.id[i] < 0) return;
        const double rho0 = v.c.restDensity, k = v.c.stiffness, p0 = v.c.backgroundPressure;
        const int gamma = v.c.gamma;
        double ratio = double(load(v.fluid.density, i)) / rho0;
        if (v.c.leastPressure == 0 && p0 < k) {
            const double least = pow(1 - p0 / k, 1.0 / gamma);
            ratio = ratio < least ? least : ratio;
        }
        const double tait = gamma == 1 ? log(ratio) : (pow(ratio, gamma - 1) - 1) / (gamma - 1);
        c.add({(k * (tait + 1 / ratio - 1) + p0 * (1 - 1 / ratio)) / rho0});
    }
};

// The work of a step joins what there was before.
struct BookForces {
    using Index = int;
    EnergyLedger* ledger;
    const Power* fluid;
    const WallPower* walls;
    const StepState* state;
    double mass;            // kg, of a particle
    bool pressureIsSolved;  // later: neither it nor what gravity does with it is known yet
    bool pressureIsInViscosity;
    HD void operator()(int) const {
        const double dt = mass * state->dt;
        const Power& p = *fluid;
        const WallPower& w = *walls;
        ledger->walls += dt * w.other;
        if (!pressureIsSolved) {
            ledger->gravity += dt * p.body, ledger->walls += dt * w.pressure;
            ledger->wallPressure -= dt * (p.ofWalls - w.own);
        }
        const double viscosity = p.viscosity - (pressureIsInViscosity ? p.pressure : 0);
        ledger->viscosity -= dt * (viscosity - (w.other - w.artificial));
        ledger->artificial -= dt * (p.artificial - w.artificial);
        ledger->others += dt * (p.all - p.body - p.pressure - viscosity - p.artificial);
    }
};
struct BookSolvedPressure {
    using Index = int;
    EnergyLedger* ledger;
    const Power* fluid;
    const WallPower* walls;
    const StepState* state;
    double mass;
    HD void operator()(int) const {
        const double dt = mass * state->dt;
        ledger->gravity += dt * fluid->body, ledger->walls += dt * walls->pressure;
    }
};
struct BookRates {
    using Index = int;
    EnergyLedger* ledger;
    const RatePower* rates;
    const StepState* state;
    double mass;
    HD void operator()(int) const {
        const double dt = mass * state->dt;
        ledger->diffusion -= dt * rates->diffusion, ledger->shifting -= dt * rates->shifting;
        ledger->viscosity -= dt * rates->viscosity, ledger->wallPressure -= dt * rates->walls;
    }
};
struct BookStirring {
    using Index = int;
    EnergyLedger* ledger;
    const Total *before, *after;
    double mass;
    HD void operator()(int) const { ledger->stirred += mass * (after->sum - before->sum); }
};

}  // namespace spindrift::LANES
