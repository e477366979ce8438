// The incompressible formulation: its pressures are those of the dense system, and good to what is
// asked for.
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

namespace spindrift {
namespace {

// Wendland's C2 kernel, and what makes sums over a lattice exact, written once more.
struct Kernel3 {
    double R, mass, gradientFactor;
    explicit Kernel3(double dx, double rho0) : R(2.6 * dx) {
        double sum = 0, slope = 0;
        for (int z = -3; z <= 3; ++z)
            for (int y = -3; y <= 3; ++y)
                for (int x = -3; x <= 3; ++x) {
                    const double r = dx * std::sqrt(double(x * x + y * y + z * z));
                    sum += w(r) * dx * dx * dx, slope -= over(r) * dx * dx * dx * (x * x * dx * dx);
                }
        mass = rho0 * dx * dx * dx / sum, gradientFactor = sum / slope;
    }
    double w(double r) const {
        const double q = r / R, t = std::max(1 - q, 0.0);
        return 21 / (2 * M_PI * R * R * R) * t * t * t * t * (1 + 4 * q);
    }
    // dW/dr / r.
    double over(double r) const {
        const double t = std::max(1 - r / R, 0.0);
        return -210 / (M_PI * std::pow(R, 5)) * t * t * t;
    }
};

// A drop of jittered particles that its velocities press together.
Scene dropScene(const char* precision) {
    Scene s;
    s.simulation.formulation = Formulation::Incompressible;
    s.simulation.spacing = 0.05f, s.simulation.gravity = {0, 0, 0}, s.simulation.jitter = 0.1f;
    s.domain.max = {1, 1, 1};
    s.walls.kind = WallKind::Reflect;
    s.fluid.bodies[0].min = {0.35f, 0.35f, 0.35f}, s.fluid.bodies[0].max = {0.65f, 0.65f, 0.65f};
    s.fluid.viscosity = 0, s.fluid.artificialViscosity = 0;
    s.time.mode = TimeMode::Fixed, s.time.step = 1e-3f;
    s.solver.densityError = 1e-6f, s.solver.iterations = 10000;
    s.compute.backend = Backend::Cpu, s.compute.threads = 1;
    setKnob(s, std::string("compute.precision=") + precision);
    return s;
}
RunState pressed(const Scene& s) {
    RunState state(placeParticles(s));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> noise(-0.5f, 0.5f);
    for (size_t i = 0; i < state.particles.positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            state.particles.velocities[i][k] =
                -4 * (state.particles.positions[i][k] - 0.5f) + noise(random);
    return state;
}

// The complementarity problem b + dt D a(p) / rho0 <= 0, p >= 0, by Gauss and Seidel in double
// precision on the dense matrix: velocities at the end of the step.
std::vector<Vec3d> denseVelocities(const Scene& s, const RunState& state) {
    const double rho0 = s.fluid.restDensity, dt = double(s.time.step);
    const Kernel3 kernel(double(s.simulation.spacing), rho0);
    const size_t n = state.particles.positions.size();
    std::vector<Vec3d> x, u, slope(n * n), all(n);
    std::vector<double> rho(n), source(n), pressure(n), matrix(n * n);
    for (size_t i = 0; i < n; ++i)
        x.push_back(toDouble(state.particles.positions[i])),
            u.push_back(toDouble(state.particles.velocities[i]));
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j) {
            const Vec3d r = x[i] - x[j];
            rho[i] += kernel.mass * kernel.w(length(r));
            slope[i * n + j] = (kernel.mass * kernel.gradientFactor * kernel.over(length(r))) * r;
            all[i] = all[i] + slope[i * n + j];
            source[i] += dt / rho0 * dot(u[i] - u[j], slope[i * n + j]);
        }
    double fastest = 0;
    for (const Vec3d& v : u) fastest = std::max(fastest, length(v));
    const double share =
        double(s.solver.densityShare) * std::min(1.0, dt * fastest / (0.2 * kernel.R));
    for (size_t i = 0; i < n; ++i) {
        const double error = rho[i] / rho0 - 1, torn = std::min(error + 0.02, 0.0);
        source[i] += torn + share * (error - torn);
    }
    // a_i = sum_k G_ik p_k / rho_k^2, (D a)_i = sum_j (a_i - a_j).slope_ij; and what neighbours'
    // pressures differ by, rho0 sum_j m W (p_j - p_i) / rho^2 times 0.4 / R^2.
    std::vector<Vec3d> G(n * n);
    for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < n; ++k)
            G[i * n + k] = i == k ? -1.0 * all[i] : -1.0 * slope[i * n + k];
    for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < n; ++k) {
            matrix[i * n + k] += dot(G[i * n + k], all[i]);
            for (size_t j = 0; j < n; ++j) matrix[i * n + k] -= dot(G[j * n + k], slope[i * n + j]);
            if (k == i) continue;
            const double even =
                rho0 * kernel.mass * kernel.w(length(x[i] - x[k])) * 0.4 / (kernel.R * kernel.R);
            matrix[i * n + k] += even, matrix[i * n + i] -= even;
        }
    const double scale = dt * dt / rho0;
    for (int sweep = 0; sweep < 4000; ++sweep)
        for (size_t i = 0; i < n; ++i) {
            double left = source[i];
            for (size_t k = 0; k < n; ++k) left += scale * matrix[i * n + k] * pressure[k];
            pressure[i] = std::max(pressure[i] - left / (scale * matrix[i * n + i]), 0.0);
        }
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j)
            u[i] = u[i] - (dt * (pressure[i] + pressure[j])) * slope[i * n + j];
    return u;
}

TEST(Incompressible, PressuresAreThoseOfTheDenseSystem) {
    for (const char* precision : {"double", "float"}) {
        const Scene s = dropScene(precision);
        const RunState state = pressed(s);
        const std::vector<Vec3d> exact = denseVelocities(s, state);
        const auto simulation = makeSimulation(s, state);
        simulation->step();
        const SolveReport report = simulation->measure().solve;
        EXPECT_EQ(report.failures, 0);
        const std::vector<Particle> particles = simulation->particles();
        double worst = 0, change = 0;
        for (size_t i = 0; i < exact.size(); ++i) {
            worst = std::max(worst, length(particles[i].velocity - exact[i]));
            change = std::max(change, length(toDouble(state.particles.velocities[i]) - exact[i]));
        }
        EXPECT_GT(change, 0.3);
        EXPECT_LT(worst, 2e-3 * change) << precision;
    }
}

// Of fluid that is pressed together: momentum and angular momentum stay, energy does not grow.
TEST(Incompressible, KeepsMomentumAndAngularMomentum) {
    Scene s = dropScene("double");
    s.solver.densityError = 1e-3f, s.simulation.jitter = 0;
    const auto simulation = makeSimulation(s, pressed(s));
    const Measurement before = simulation->measure();
    simulation->step(60);
    const Measurement after = simulation->measure();
    const double mass = double(particleMass(s)) * simulation->fluidCount();
    EXPECT_LT(length(after.momentum - before.momentum), 1e-6 * mass * before.maxSpeed);
    EXPECT_LT(length(after.angularMomentum - before.angularMomentum),
              1e-5 * mass * before.maxSpeed * 0.5);
    EXPECT_LT(after.kineticEnergy, before.kineticEnergy);
}

// Short steps: what is left is what was asked for, not what a long way changes neighbours by.
TEST(Incompressible, DensitiesAreAsGoodAsAsked) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/dam_break_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    s.time.cfl = 0.1f;
    double last = 1;
    for (const float asked : {0.03f, 0.003f, 0.001f}) {
        s.solver.densityError = asked, s.solver.iterations = 1000;
        const auto simulation = makeSimulation(s);
        double sum = 0;
        int steps = 0;
        for (simulation->stopAt(0.3); simulation->clock().time < 0.3; ++steps) {
            simulation->step();
            const Measurement m = simulation->measure();
            EXPECT_LE(m.solve.error, m.solve.allowed);
            EXPECT_LE(m.solve.allowed, 3.001 * double(asked * s.solver.densityShare));
            sum += m.densityError;
        }
        EXPECT_LT(sum / steps, double(asked));
        EXPECT_LE(sum / steps, last);  // as good already where pressures ask for more
        last = sum / steps;
    }
}

// What a step costs: 10 iterations, within a third.
TEST(Incompressible, PressuresOfTheLastStepAreAGoodStart) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/dam_break_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    const auto simulation = makeSimulation(s);
    int iterations = 0, steps = 0;
    for (simulation->stopAt(0.6); simulation->clock().time < 0.6; ++steps) {
        simulation->step();
        iterations += simulation->measure().solve.iterations;
    }
    EXPECT_LT(steps, 200);
    EXPECT_LT(iterations, 14 * steps);
    std::printf("%d steps, %.1f iterations each\n", steps, double(iterations) / steps);
}

// What the pressures of layers in a tank at rest are wrong by, share of rho g H, over time.
struct LayerErrors {
    double rms, worst;
};
LayerErrors layerErrors(int layers, float longestStep) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/validation/hydrostatic.json");
    const float dx = 0.9f / float(layers);
    s.simulation.formulation = Formulation::Incompressible, s.simulation.spacing = dx;
    s.fluid.bodies[0].max.x = s.domain.max.x = dx * std::round(0.6f / dx);
    s.time.maxStep = longestStep, s.compute.backend = Backend::Cpu;
    const auto simulation = makeSimulation(s);
    double sum = 0, worst = 0;
    int count = 0;
    for (simulation->stopAt(8); simulation->clock().time < 8;) {
        simulation->step();
        if (simulation->clock().time < 5) continue;
        std::vector<double> error(size_t(layers), 0), particles(size_t(layers), 0);
        for (const Particle& p : simulation->particles()) {
            const int layer = std::clamp(int(p.position.y / double(dx)), 0, layers - 1);
            error[size_t(layer)] += p.pressure / (1000 * 0.9) - (1 - p.position.y / 0.9);
            ++particles[size_t(layer)];
        }
        for (int k = 0; k < layers; ++k) {
            if (particles[size_t(k)] == 0) continue;
            const double mean = error[size_t(k)] / particles[size_t(k)];
            sum += mean * mean, worst = std::max(worst, std::abs(mean)), ++count;
        }
    }
    EXPECT_EQ(simulation->measure().solve.rough, 0);
    return {std::sqrt(sum / count), worst};
}

// Nor do they swing, however deep the tank and short the steps.
TEST(Incompressible, LayersHaveTheirPressureAtAllTimes) {
    for (const auto& [layers, most] : {std::pair{30, 0.008}, std::pair{60, 0.012}})
        for (const float longestStep : {0.0f, 0.006f}) {
            const LayerErrors e = layerErrors(layers, longestStep);
            EXPECT_LT(e.rms, most) << layers << " layers, " << longestStep << " s";
            EXPECT_LT(e.worst, 0.022) << layers << " layers, " << longestStep << " s";
            std::printf("%d layers, steps of at most %g s: rms %.2f %%, worst %.2f %%\n", layers,
                        double(longestStep), 100 * e.rms, 100 * e.worst);
        }
}

// Where iterations end before long waves are found that is counted, and steps stay as they are.
TEST(Incompressible, LongWavesThatAreNotFoundAreCounted) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/still_pool_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    s.solver.iterations = 2, s.solver.densityError = 0.1f, s.time.maxStep = 2e-4f;
    s.solver.relaxation = 0.05f;
    const auto simulation = makeSimulation(s);
    simulation->step(20);
    const Measurement m = simulation->measure();
    EXPECT_EQ(m.solve.failures, 0);
    EXPECT_GT(m.solve.rough, 2);
    EXPECT_NEAR(m.dt, 2e-4, 1e-6);
}

// Hydrostatic pressure, layer by layer, once the first unrest is gone.
TEST(Incompressible, StillWaterHasItsPressureAndStaysThere) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/still_pool_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    const auto simulation = makeSimulation(s);
    const Measurement begin = simulation->measure();
    const double mass = double(particleMass(s)) * simulation->fluidCount(), g = 9.81, depth = 0.24;
    simulation->stopAt(2);
    while (simulation->clock().time < 2) simulation->step();
    const Measurement end = simulation->measure();
    EXPECT_LT(end.kineticEnergy, 1e-4 * mass * g * depth);
    EXPECT_NEAR(end.centerOfMass.y, begin.centerOfMass.y, 0.01 * depth);
    double sum = 0, sum2 = 0;
    int n = 0;
    for (const Particle& p : simulation->particles()) {
        if (p.position.y > 0.18) continue;
        const double head = p.pressure + 1000 * g * p.position.y;
        sum += head, sum2 += head * head, ++n;
    }
    const double mean = sum / n;
    EXPECT_NEAR(mean, 1000 * g * depth, 0.03 * 1000 * g * depth);
    EXPECT_LT(std::sqrt(sum2 / n - mean * mean), 0.05 * mean);
}

TEST(Incompressible, ACheckpointGoesOnBitByBit) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/floating_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    const auto whole = makeSimulation(s);
    whole->step(30);
    whole->restart(whole->state());  // in the order of ids again, as runs with checkpoints do
    const auto rest = makeSimulation(s, whole->state());
    whole->step(20), rest->step(20);
    const std::vector<Particle> a = whole->particles(), b = rest->particles();
    for (size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].position, b[i].position) << i;
        ASSERT_EQ(a[i].velocity, b[i].velocity) << i;
    }
}

// Too few iterations are said, and steps become shorter.
TEST(Incompressible, PressuresThatAreNotFoundShortenSteps) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/still_pool_small.json");
    s.simulation.formulation = Formulation::Incompressible, s.compute.backend = Backend::Cpu;
    s.solver.iterations = 2, s.solver.densityError = 1e-5f;
    const auto simulation = makeSimulation(s);
    simulation->step();
    const double first = simulation->clock().dt;
    simulation->step(3);
    EXPECT_EQ(simulation->measure().solve.failures, 4);
    EXPECT_NEAR(simulation->clock().dt / first, 1.0 / 8, 0.02);
}

}  // namespace
}  // namespace spindrift
