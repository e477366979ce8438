// Steps of their own for particles (time.mode local), and rest.
#include "instruction_sets.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

Scene testScene(const std::string& name) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/" + name);
    s.compute.backend = Backend::Cpu;
    return s;
}

void expectSameParticles(Simulation& a, Simulation& b) {
    const std::vector<Particle> one = a.particles(), two = b.particles();
    ASSERT_EQ(one.size(), two.size());
    for (size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(one[i].position, two[i].position) << i;
        ASSERT_EQ(one[i].velocity, two[i].velocity) << i;
        ASSERT_EQ(one[i].density, two[i].density) << i;
    }
}

TEST(BlockTimeSteps, OfCalmFluidAreThoseOfAll) {
    for (Formulation f : {Formulation::Wcsph, Formulation::DeltaSph}) {
        Scene scene = testScene("dam_break_small.json");
        scene.simulation.formulation = f;
        scene.time.mode = TimeMode::Local, scene.time.maxStep = scene.time.step = 1e-4f;
        auto local = makeSimulation(scene);
        scene.time.mode = TimeMode::Fixed;
        auto global = makeSimulation(scene);
        local->step(40), global->step(40);
        EXPECT_EQ(local->measure().evaluations, 40.0 * local->fluidCount());
        expectSameParticles(*local, *global);
    }
}

// Two blocks meet in mid-air, without gravity or walls.
Scene collision() {
    Scene s;
    s.compute.backend = Backend::Cpu;
    s.simulation.spacing = 0.05f, s.simulation.gravity = {0, 0, 0};
    s.walls.kind = WallKind::Reflect;
    s.domain.max = {3, 2, 2};
    s.fluid.bodies.resize(2);
    s.fluid.bodies[0].min = {0.7f, 0.6f, 0.6f}, s.fluid.bodies[0].max = {1.3f, 1.2f, 1.2f};
    s.fluid.bodies[1].min = {1.4f, 0.8f, 0.7f}, s.fluid.bodies[1].max = {2.0f, 1.4f, 1.3f};
    s.fluid.bodies[0].velocity = {2, 0, 0};
    s.fluid.soundSpeed = 30;
    return s;
}

TEST(BlockTimeSteps, AreShorterWhereFluidIsHit) {
    Scene scene = collision();
    auto runFor = [&](TimeMode mode, float cfl) {
        scene.time.mode = mode, scene.time.cfl = cfl;
        auto simulation = makeSimulation(scene);
        simulation->stopAt(0.15);
        while (simulation->measure().time < 0.15) simulation->step();
        return simulation->measure();
    };
    const Measurement local = runFor(TimeMode::Local, 0.4f), global = runFor(TimeMode::Cfl, 0.4f),
                      fine = runFor(TimeMode::Cfl, 0.1f);
    const double n = 2 * 12 * 12 * 12, momentum = 1000 * 0.6 * 0.6 * 0.6 * 2,
                 perStep = local.evaluations / n / double(local.steps);
    std::printf(
        "collision: %d local steps of %.2f evaluations, %d global; kinetic energy %.2f J, %.2f "
        "global, %.2f with a quarter of the step; momentum "
        "%.1e lost, %.1e across\n",
        int(local.steps), perStep, int(global.steps), local.kineticEnergy, global.kineticEnergy,
        fine.kineticEnergy, 1 - local.momentum.x / momentum,
        std::hypot(local.momentum.y, local.momentum.z) / momentum);
    EXPECT_GT(perStep, 1.01);
    EXPECT_LT(double(local.steps) * perStep, 0.8 * double(global.steps));
    EXPECT_NEAR(local.kineticEnergy, fine.kineticEnergy, 0.01 * fine.kineticEnergy);
    EXPECT_NEAR(local.momentum.x, momentum, 1e-3 * momentum);
    EXPECT_LT(std::hypot(local.momentum.y, local.momentum.z), 1e-3 * momentum);
}

// In double precision neighbours are found without lists, and each pair counts twice: whoever is
// left out where only some are due, differs. (With lists all of a cluster are evaluated when one is
// due, so that densities are not quite as old.)
TEST(BlockTimeSteps, MissNoNeighbour) {
    Scene scene = collision();
    scene.time.mode = TimeMode::Local;
    scene.fluid.bodies[0].velocity = {6, 0, 0};
    const auto lists = makeSimulation(scene);
    scene.compute.precision = Precision::Double;
    const auto rows = makeSimulation(scene);
    const double n = lists->fluidCount();
    for (auto* s : {lists.get(), rows.get()}) s->step(30);
    EXPECT_GT(lists->measure().evaluations / n, 32) << "all were due all the time";
    EXPECT_NEAR(lists->measure().evaluations, rows->measure().evaluations,
                1e-3 * rows->measure().evaluations);
    const std::vector<Particle> a = lists->particles(), b = rows->particles();
    double position = 0, density = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        position = std::max(position, length(a[i].position - b[i].position) / 0.05);
        density += std::abs(a[i].density - b[i].density) / 1000 / n;
    }
    std::printf(
        "after %.1f evaluations: %.1e spacings at most, %.1e of the density apart in the mean\n",
        lists->measure().evaluations / n, position, density);
    EXPECT_LT(position, 0.05);
    EXPECT_LT(density, 2e-3);
}

// A flat pool that is stirred by nobody, and thick enough to come to rest soon.
Scene pool() {
    Scene s;
    s.compute.backend = Backend::Cpu;
    s.simulation.dimensions = 2, s.simulation.spacing = 0.02f;
    s.domain.max = {1.2f, 0.5f, 1};
    s.fluid.bodies[0].min = {0, 0, 0}, s.fluid.bodies[0].max = {1.2f, 0.3f, 1};
    s.fluid.artificialViscosity = 0.3f;
    s.time.mode = TimeMode::Local;
    return s;
}

// Mean difference of layers' pressures from the hydrostatic one, relative. Single particles'
// pressures depend on where each came to lie, which differs from run to run.
double pressureError(Simulation& simulation) {
    constexpr int Layers = 5;
    double sum[Layers] = {}, exact[Layers] = {}, error = 0, all = 0;
    for (const Particle& p : simulation.particles()) {
        const int layer = std::clamp(int(p.position.y / 0.3 * Layers), 0, Layers - 1);
        sum[layer] += p.pressure, exact[layer] += 1000 * 9.81 * std::max(0.3 - p.position.y, 0.0);
    }
    for (int k = 0; k < Layers; ++k) error += std::abs(sum[k] - exact[k]), all += exact[k];
    return error / all;
}

double evaluationsOf(Simulation& simulation, int steps) {
    const double before = simulation.measure().evaluations;
    simulation.step(steps);
    return (simulation.measure().evaluations - before) / simulation.fluidCount() / steps;
}

TEST(Rest, ComesToAPoolAndEndsWhenItIsDisturbed) {
    Scene scene = pool();
    const auto simulation = makeSimulation(scene);
    int steps = 0;
    while (evaluationsOf(*simulation, 50) > 0 && steps < 20000) steps += 50;
    ASSERT_LT(steps, 20000) << "it never rests";
    const Measurement m = simulation->measure();
    EXPECT_EQ(m.kineticEnergy, 0);
    scene.time.mode = TimeMode::Cfl;
    const auto global = makeSimulation(scene);
    while (global->measure().time < m.time) global->step(10);
    scene.time.mode = TimeMode::Local;
    const double error = pressureError(*simulation), usual = pressureError(*global);
    std::printf("pool: rests after %.2f s, pressure %.2f %% off, %.2f without rest\n", m.time,
                100 * error, 100 * usual);
    EXPECT_LT(error, 1.3 * usual);  // half and twice the step: 1.1 and 0.7 times
    EXPECT_NEAR(m.centerOfMass.y, global->measure().centerOfMass.y, 5e-4);
    EXPECT_EQ(evaluationsOf(*simulation, 100), 0);

    // The mouse in a corner wakes what is near, and only that.
    const std::vector<Particle> all = simulation->particles();
    const auto corner =
        std::min_element(all.begin(), all.end(), [](const Particle& a, const Particle& b) {
            return std::hypot(a.position.x - 0.1, a.position.y - 0.2) <
                   std::hypot(b.position.x - 0.1, b.position.y - 0.2);
        });
    simulation->stir({toFloat(corner->position), 0.06f, {1, 0, 0}});
    const double woken = evaluationsOf(*simulation, 24);
    simulation->stir({});
    EXPECT_GT(woken, 0.02);
    EXPECT_LT(woken, 0.6);
    EXPECT_GT(simulation->measure().kineticEnergy, 0);

    // Another gravity wakes all.
    scene.simulation.gravity = {2, -9.81f, 0};
    simulation->apply(scene);
    EXPECT_GE(evaluationsOf(*simulation, 200), 1);
    EXPECT_GT(simulation->measure().centerOfMass.x, m.centerOfMass.x + 0.001);
}

// The largest difference of an awake particle's density from the sum over all particles, where
// walls have no share. Forces were evaluated a straight line back from where particles are;
// somebody who rests says what the sum is in kg/m^3.
double densityError(Simulation& simulation, double R) {
    std::vector<Particle> particles = simulation.particles();
    const double dt = simulation.clock().dt;
    for (Particle& p : particles) p.position = p.position - dt * p.velocity;
    double scale = 0, worst = 0;
    for (bool calibrates : {true, false})
        for (const Particle& p : particles) {
            const bool rests = length(p.velocity) == 0;
            if (rests != calibrates || std::abs(p.position.x - 0.6) > 0.5 ||
                std::abs(p.position.y - 0.15) > 0.06)
                continue;
            double sum = 0;
            for (const Particle& other : particles) {
                const double q = length(p.position - other.position) / R;
                if (q < 1) sum += std::pow(1 - q, 4) * (4 * q + 1);
            }
            if (calibrates)
                scale = p.density / sum;
            else
                worst = std::max(worst, std::abs(scale * sum / p.density - 1));
        }
    return worst;
}

// Where few are awake lists reach further and are kept for longer. While all who are awake take the
// same step, as they do nearly always here, their densities are exact; somebody left out for as
// long as lists are kept would show.
TEST(Rest, ListsOfThoseAwakeMissNobody) {
    for (const Simd simd : instructionSets()) {
        Scene scene = pool();
        scene.compute.simd = simd;
        const auto simulation = makeSimulation(scene);
        for (int k = 0; k < 400 && evaluationsOf(*simulation, 50) > 0; ++k) {}
        simulation->stir(
            {{0.6f, 0.15f, float(simulation->particle(0).position.z)}, 0.03f, {0.3f, 0, 0}});
        int exact = 0;
        for (int k = 0; k < 40; ++k) {
            simulation->step(3);
            const double awake = simulation->clock().awake;
            exact += awake > 0.02 && awake < 0.9 &&
                     densityError(*simulation, supportRadius(scene)) < 1e-5;
        }
        std::printf("densities exact in %d of 40 looks, %.0f %% awake at the end\n", exact,
                    100 * simulation->clock().awake);
        EXPECT_GT(exact, 25);
    }
}

TEST(Rest, IsNotForbiddenToBeForbidden) {
    Scene scene = pool();
    scene.time.restSpeed = 0;
    const auto simulation = makeSimulation(scene);
    simulation->step(3000);
    EXPECT_GE(evaluationsOf(*simulation, 50), 1);
}

TEST(BlockTimeSteps, RestartGoesOnWithTheSameBits) {
    Scene scene = testScene("ball_drop_small.json");
    scene.time.mode = TimeMode::Local;
    auto one = makeSimulation(scene);
    one->step(60);
    const RunState state = one->state();
    one->restart(state);
    auto two = makeSimulation(scene, state);
    one->step(40), two->step(40);
    expectSameParticles(*one, *two);
}

TEST(BlockTimeSteps, CanBeSwitchedOnAndOff) {
    Scene scene = testScene("dam_break_small.json");
    auto simulation = makeSimulation(scene);
    for (int k = 0; k < 6; ++k) {
        scene.time.mode = k % 2 ? TimeMode::Cfl : TimeMode::Local;
        simulation->apply(scene);
        simulation->step(30);
    }
    auto global = makeSimulation(scene);
    global->stopAt(simulation->measure().time);
    while (global->measure().time < simulation->measure().time) global->step();
    const Vec3d apart = simulation->measure().centerOfMass - global->measure().centerOfMass;
    EXPECT_LT(length(apart), 0.01 * length(global->measure().centerOfMass));
}

TEST(StopAt, IsReachedExactly) {
    for (TimeMode mode : {TimeMode::Cfl, TimeMode::Local}) {
        Scene scene = testScene("dam_break_small.json");
        scene.time.mode = mode;
        const auto simulation = makeSimulation(scene);
        double longest = 0;
        for (double stop : {0.01, 0.0101, 0.0333}) {
            simulation->stopAt(stop);
            for (Measurement m = simulation->measure(); m.time < stop; m = simulation->measure()) {
                simulation->step();
                longest = std::max(longest, simulation->measure().dt);
            }
            EXPECT_EQ(simulation->measure().time, stop);
        }
        EXPECT_GT(longest, 1e-4);
    }
}

}  // namespace
}  // namespace spindrift
