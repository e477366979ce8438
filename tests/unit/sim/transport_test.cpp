// What transport_velocity promises: linear fields exactly, however the particles lie.
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

Scene jittered(int dimensions, const char* precision) {
    Scene s;
    s.simulation.formulation = Formulation::TransportVelocity;
    s.simulation.dimensions = dimensions;
    s.simulation.spacing = 0.05f;
    s.simulation.jitter = 0.2f;
    s.simulation.gravity = {0, 0, 0};
    s.domain.max = {1, 1, dimensions == 3 ? 0.8f : 0.1f};
    s.walls.kind = WallKind::Reflect;
    s.fluid.bodies[0].max = s.domain.max;
    s.fluid.soundSpeed = 10, s.fluid.equationOfState = EquationOfState::Linear;
    s.fluid.viscosity = 0.5f, s.fluid.densityDiffusion = 0.1f;
    s.time.mode = TimeMode::Fixed, s.time.step = 1e-6f;
    s.compute.backend = Backend::Cpu;
    setKnob(s, std::string("compute.precision=") + precision);
    return s;
}

// rho = rho0 (1 + b.x): a = -c^2 b rho0 / rho. u = A x: no viscous force, d rho/dt = -rho trace A +
// the shift's part.
void expectLinearFieldsExact(int dimensions, const char* precision, double tolerance) {
    const Scene s = jittered(dimensions, precision);
    const Vec3d b{0.5, -0.15, dimensions == 3 ? 0.2 : 0.0};
    const double rho0 = s.fluid.restDensity, c2 = 100;
    RunState state(placeParticles(s));
    for (size_t i = 0; i < state.particles.positions.size(); ++i) {
        const Vec3d x = toDouble(state.particles.positions[i]);
        state.densities.push_back(float(rho0 * (1 + dot(b, x))));
        state.particles.velocities[i] =
            toFloat(Vec3d{0.2 * x.x + 0.1 * x.y, -0.3 * x.y, dimensions == 3 ? 0.4 * x.x : 0.0});
    }
    const auto simulation = makeSimulation(s, state);
    const double R = supportRadius(s);
    int inside = 0;
    double worst = 0;
    for (const Particle& p : simulation->particles()) {
        bool far = true;
        for (int k = 0; k < dimensions; ++k)
            far = far && p.position[k] > R && p.position[k] < s.domain.max[k] - R;
        if (!far) continue;
        ++inside;
        const Vec3d exact = (-c2 * rho0 / p.density) * b;
        worst = std::max(worst, length(p.acceleration - exact) / length(exact));
    }
    EXPECT_GT(inside, 50);
    EXPECT_LT(worst, tolerance);
}

TEST(Transport, PressureGradientOfALinearFieldIsExact) {
    // Densities go in as floats, on every device: 6e-8 of rho0 over a spacing, where the field
    // changes by 2e-2. (Uncorrected: 0.1.)
    expectLinearFieldsExact(2, "double", 1e-4);
    expectLinearFieldsExact(3, "double", 1e-4);
    expectLinearFieldsExact(2, "float", 1e-4);
    expectLinearFieldsExact(3, "float", 1e-4);
}

// After one tiny step velocity has changed by dt du.grad u: the exact field at the new place.
void expectFieldsAreCarried(Scene s) {
    s.time.step = 1e-4f;
    RunState state(placeParticles(s));
    auto velocity = [](Vec3d x) { return Vec3d{2 * x.x + 1 * x.y, -2 * x.y, 0}; };  // div u = 0
    for (size_t i = 0; i < state.particles.positions.size(); ++i) {
        state.densities.push_back(s.fluid.restDensity);
        state.particles.velocities[i] = toFloat(velocity(toDouble(state.particles.positions[i])));
    }
    const auto simulation = makeSimulation(s, state);
    const std::vector<Particle> before = simulation->particles();
    simulation->step();
    double farthest = 0, worst = 0, density = 0;
    for (const Particle& p : simulation->particles()) {
        const Vec3d x = before[size_t(p.id)].position;
        if (std::min({x.x, x.y, 1 - x.x, 1 - x.y}) < 2 * supportRadius(s)) continue;
        // Along its own path a particle's velocity would not change: no pressure, no viscous force.
        // What changes it is the shift alone.
        const Vec3d shift = p.position - x - double(s.time.step) * before[size_t(p.id)].velocity;
        const Vec3d expected =
            before[size_t(p.id)].velocity + Vec3d{2 * shift.x + shift.y, -2 * shift.y, 0};
        farthest = std::max(farthest, length(shift));
        worst = std::max(worst, length(p.velocity - expected));
        density = std::max(density, std::abs(p.density / s.fluid.restDensity - 1));
    }
    EXPECT_GT(farthest, 1e-6);
    EXPECT_LT(worst, 1e-3 * farthest) << "velocity does not follow the shift";
    EXPECT_LT(density, 1e-6);
}

TEST(Transport, ShiftedParticlesCarryTheFieldsOfWhereTheyAre) {
    Scene s = jittered(2, "double");
    s.fluid.densityDiffusion = 0, s.fluid.viscosity = 0;
    expectFieldsAreCarried(s);
}

// Where particles lie unevenly the plain sums of Laplacians see linear fields.
TEST(Transport, ALinearVelocityHasNoViscousForce) {
    Scene s = jittered(2, "double");
    s.fluid.densityDiffusion = 0, s.fluid.viscosity = 10;
    expectFieldsAreCarried(s);
}
TEST(Transport, ALinearDensityDoesNotDiffuse) {
    Scene s = jittered(2, "double");
    s.fluid.viscosity = 0, s.fluid.densityDiffusion = 1, s.fluid.shifting = 0, s.time.step = 1e-5f;
    const double rho0 = s.fluid.restDensity;
    auto density = [&](Vec3d x) { return rho0 * (1 + 0.05 * x.x - 0.02 * x.y); };
    RunState state(placeParticles(s));
    for (const Vec3& x : state.particles.positions)
        state.densities.push_back(float(density(toDouble(x))));
    const auto simulation = makeSimulation(s, state);
    const std::vector<Particle> before = simulation->particles();
    simulation->step();
    double least = 1e300, most = 0;  // of all particles the volume is kept: by one factor for all
    for (const Particle& p : simulation->particles()) {
        const Vec3d x = before[size_t(p.id)].position;
        if (std::min({x.x, x.y, 1 - x.x, 1 - x.y}) < 2 * supportRadius(s)) continue;
        const double ratio = p.density / before[size_t(p.id)].density;
        least = std::min(least, ratio), most = std::max(most, ratio);
    }
    // A sum that loses nothing changes it by 2 delta h c |S| |grad rho| dt, about 1e-6.
    EXPECT_LT(most - least, 1e-7);
}

}  // namespace
}  // namespace spindrift
