// Elastic objects: they bend as beams do, break when they should, keep momentum, and fluid and
// objects keep out of each other's way.
#include "physics/bonded_reference.h"
#include "physics/cube.h"
#include "scene/mass.h"
#include "scene/sample_object.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

Scene sceneOf(const std::vector<std::string>& knobs) {
    std::vector<std::string> all{"walls.kind=reflect"};
    all.insert(all.end(), knobs.begin(), knobs.end());
    return dryCubeWith(all);
}

void runUntil(Simulation& simulation, double time) {
    simulation.stopAt(time);
    while (simulation.clock().time < time) simulation.step(1);
}

Vec3d momentumOf(const Scene& scene, Simulation& simulation) {
    const ObjectSample sample = sampleObjects(scene);
    const ObjectState state = simulation.state().objects;
    Vec3d sum = simulation.measure().momentum;
    for (size_t i = 0; i < sample.size(); ++i)
        sum = sum + double(sample.masses[i]) * toDouble(state.velocities[i]);
    return sum;
}

// A bar that is held at one end sags under its weight: w = rho g A L^4 / (8 E I), and what it is
// sheared by, rho g L^2 / (2 k G) (Timoshenko's k = 5/6).
TEST(Objects, BarSagsAsABeamDoes) {
    for (const int dimensions : {2, 3}) {
        const double L = 0.6, h = 0.1, E = 2e6, rho = 1000, g = 0.5;
        Scene scene = sceneOf(
            {"simulation.gravity=0,-0.5,0", "simulation.dimensions=" + std::to_string(dimensions),
             "domain.max=1,1,0.4",
             R"(objects=[{"shape":"block","min":[0.2,0.45,0.15],"max":[0.8,0.55,0.25],)"
             R"("spacing":0.0125,"youngs_modulus":2e6,"damping":0}])",
             R"(grips=[{"min":[0.1,0.4,0],"max":[0.2001,0.6,0.4]}])", "simulation.spacing=0.0125",
             "fluid.bodies[0].max=0.05,0.05,0.05", "fluid.sound_speed=2"});
        auto simulation = makeSimulation(scene);
        const ObjectSample sample = sampleObjects(scene);
        // It swings about its sag, from 0 to twice as much.
        double lowest = 0;
        while (simulation->clock().time < 0.5) {
            simulation->step(20);
            const ObjectState state = simulation->state().objects;
            double sag = 0, n = 0;
            for (size_t i = 0; i < sample.size(); ++i)
                if (sample.positions[i].x > 0.799f)
                    sag += double(sample.positions[i].y) - state.positions[i].y, n += 1;
            lowest = std::max(lowest, sag / n);
        }
        const double sag = lowest / 2;
        const double nu = dimensions == 2 ? 1.0 / 3 : 0.25;
        const double bent = rho * g * std::pow(L, 4) * 12 / (8 * E * h * h),
                     sheared = rho * g * L * L / (2 * 5.0 / 6 * E / (2 * (1 + nu)));
        std::printf("%d dimensions: sag %.5f m, beam %.5f m\n", dimensions, sag, bent + sheared);
        EXPECT_NEAR(sag / (bent + sheared), 1, 0.05) << dimensions;
    }
}

// Pulled at one end at a steady rate a chain breaks at the stated strain, and not before.
TEST(Objects, BondsBreakAtTheirStrain) {
    Scene scene = sceneOf(
        {"simulation.gravity=0,0,0", "simulation.dimensions=2",
         R"(objects=[{"shape":"sheet","min":[0.3,0.5,0.3],"max":[0.7,0.5,0.6],)"
         R"("breaking_strain":0.2,"youngs_modulus":1e6,"damping":0.5}])",
         R"(grips=[{"min":[0.25,0.4,0],"max":[0.301,0.6,1]},{"min":[0.699,0.4,0],"max":[0.75,)"
         R"(0.6,1],"velocity":[0.05,0,0]}])"});
    auto simulation = makeSimulation(scene);
    auto broken = [&] {
        const ObjectState state = simulation->state().objects;
        return std::count(state.broken.begin(), state.broken.end(), 1);
    };
    runUntil(*simulation, 0.97 * 0.2 * 0.4 / 0.05);
    EXPECT_EQ(broken(), 0);
    runUntil(*simulation, 1.1 * 0.2 * 0.4 / 0.05);
    EXPECT_GT(broken(), 0);
    EXPECT_EQ(broken() % 2, 0) << "both ends of a bond know";
}

// Fluid runs into a block, alone in space. The forces of a pair are opposite, and so is what bonds
// do.
TEST(Objects, FluidAndObjectsKeepTheirMomentum) {
    for (const char* formulation : {"wcsph", "delta_sph"}) {
        Scene scene = sceneOf(
            {std::string("simulation.formulation=") + formulation, "simulation.gravity=0,0,0",
             "domain.max=4,4,4", "compute.precision=double",
             R"(fluid.bodies=[{"shape":"block","min":[1.5,1.8,1.8],"max":[1.9,2.2,2.2],)"
             R"("velocity":[1,0,0]}])",
             R"(objects=[{"shape":"block","min":[2,1.9,1.7],"max":[2.3,2.4,2.2],"density":700,)"
             R"("youngs_modulus":2e4}])"});
        auto simulation = makeSimulation(scene);
        const Vec3d before = momentumOf(scene, *simulation);
        EXPECT_NEAR(before.x, 64, 0.01);
        simulation->step(1000);
        EXPECT_LT(simulation->measure().momentum.x, 60) << "it hit";
        EXPECT_LT(length(momentumOf(scene, *simulation) - before) / length(before), 1e-5)
            << formulation;
    }
}

// A tube that is full, and a sheet under water: nobody is on the other side after a while, whatever
// the ratio of particle sizes.
TEST(Objects, WaterStaysInABag) {
    for (const float spacing : {0.025f, 0.1f}) {
        Scene scene = sceneOf(
            {"fluid.bodies=[{\"shape\":\"block\",\"min\":[0.2,0.5,0.2],\"max\":[0.8,0.8,0.8]}]",
             "objects=[{\"shape\":\"sheet\",\"min\":[0,0.4,0],\"max\":[1,0.4,1],\"youngs_modulus\":"
             "3e6,\"thickness\":0.02}]",
             R"(grips=[{"min":[0,0,0],"max":[0.051,1,1]},{"min":[0.949,0,0],"max":[1,1,1]},)"
             R"({"min":[0,0,0],"max":[1,1,0.051]},{"min":[0,0,0.949],"max":[1,1,1]}])"});
        scene.objects[0].spacing = spacing;
        auto simulation = makeSimulation(scene);
        runUntil(*simulation, 0.35);
        const ObjectState state = simulation->state().objects;
        double lowest = 1;
        for (const Vec3& x : state.positions) lowest = std::min<double>(lowest, x.y);
        EXPECT_LT(lowest, 0.395) << "it carries the water";
        int through = 0;
        for (const Particle& p : simulation->particles()) through += p.position.y < lowest - 0.01;
        EXPECT_EQ(through, 0) << spacing;
    }
}

// Two blocks that meet, and a sheet that falls on itself, keep their particles apart.
TEST(Objects, KeepOutOfEachOther) {
    Scene scene = sceneOf(
        {"simulation.gravity=0,0,0", "domain.max=3,1,1",
         R"(objects=[{"shape":"block","min":[0.2,0.4,0.4],"max":[0.4,0.6,0.6],"velocity":[1,0,)"
         R"(0],"youngs_modulus":1e5},)"
         R"({"shape":"block","min":[0.6,0.4,0.4],"max":[0.8,0.6,0.6],"youngs_modulus":1e5}])"});
    auto simulation = makeSimulation(scene);
    const Vec3d before = momentumOf(scene, *simulation);
    runUntil(*simulation, 0.4);
    const ObjectSample sample = sampleObjects(scene);
    const ObjectState state = simulation->state().objects;
    double left = 0, right = 0, n = 0;
    for (size_t i = 0; i < sample.size(); ++i)
        (sample.objects[i] == 0 ? left : right) += state.velocities[i].x, n += 0.5;
    EXPECT_LT(left / n, 0.3);
    EXPECT_GT(right / n, 0.6);
    EXPECT_LT(length(momentumOf(scene, *simulation) - before) / length(before), 1e-4);
}

// The built-in bonds and the plain ones, which drive from outside: a block that is held at one end
// falls, swings, and is hit by water.
TEST(Objects, BondsAgreeWithPlainOnesThatDriveFromOutside) {
    Scene scene =
        sceneOf({"domain.max=1,1,0.4",
                 R"(fluid.bodies=[{"shape":"block","min":[0.5,0.65,0.1],"max":[0.7,0.8,0.3],)"
                 R"("velocity":[0,-1,0]}])",
                 R"(objects=[{"shape":"block","min":[0.2,0.5,0.1],"max":[0.8,0.6,0.3],)"
                 R"("youngs_modulus":2e6}])",
                 R"(grips=[{"min":[0.1,0.4,0],"max":[0.201,0.7,0.4]}])", "compute.precision=double",
                 "time.mode=fixed", "time.step=0.0001"});
    auto built = makeSimulation(scene), driven = makeSimulation(scene);
    BondedReference reference(scene, 0.0002, 2);
    driven->drive(&reference);
    for (Simulation* s : {built.get(), driven.get()}) s->step(3000);
    const ObjectSample sample = sampleObjects(scene);
    const ObjectState a = built->state().objects, b = driven->state().objects;
    double moved = 0, apart = 0;
    for (size_t i = 0; i < sample.size(); ++i) {
        moved = std::max<double>(moved, length(a.positions[i] - sample.positions[i]));
        apart = std::max<double>(apart, length(a.positions[i] - b.positions[i]));
    }
    EXPECT_GT(moved, 0.05);
    EXPECT_LT(apart, 0.02 * moved);
    // Given back, they move by themselves again.
    driven->drive(nullptr);
    driven->step(100);
    EXPECT_GT(length(driven->state().objects.positions.back() - b.positions.back()), 1e-4);
}

// A driver that says nothing of velocities comes to water at rest: neighbours are found all the
// same, and water is pushed out of the way.
TEST(Objects, DriversNeedNotSayHowFastTheyAre) {
    struct Plunger final : ObjectDriver {
        double interval() const override { return 0.002; }
        void exchange(double, const std::vector<Vec3d>&, std::vector<Vec3d>& positions,
                      std::vector<Vec3d>&) override {
            for (Vec3d& x : positions) x.y -= 0.002;  // 1 m/s
        }
    } plunger;
    Scene scene =
        sceneOf({"simulation.gravity=0,0,0", "fluid.sound_speed=20",
                 R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,1]}])",
                 R"(objects=[{"shape":"block","min":[0.3,0.6,0.3],"max":[0.7,0.8,0.7]}])"});
    auto simulation = makeSimulation(scene);
    simulation->drive(&plunger);
    runUntil(*simulation, 0.35);
    const double bottom = simulation->state().objects.positions[0].y;
    EXPECT_LT(bottom, 0.3);  // the fluid was at 0.4
    for (const Particle& p : simulation->particles())
        if (p.position.x > 0.3 && p.position.x < 0.7 && p.position.z > 0.3 && p.position.z < 0.7) {
            EXPECT_TRUE(p.position.y < bottom || p.position.y > bottom + 0.2) << p.position.y;
        }
}

// A block is cut and its halves are pulled apart: fluid falls between them, not into what was
// inside.
TEST(Objects, WhatTearsOpenKeepsFluidOut) {
    Scene scene = sceneOf(
        {"simulation.dimensions=2", "simulation.spacing=0.02",
         R"(fluid.bodies=[{"shape":"block","min":[0.2,0.5,0],"max":[0.8,0.7,0.1]}])",
         R"(objects=[{"shape":"block","min":[0.2,0,0],"max":[0.8,0.48,0.1],"youngs_modulus":1e6}])",
         R"(cuts=[{"time":0,"min":[0.49,0,0],"max":[0.51,1,1]}])",
         R"(grips=[{"min":[0.1,0,0],"max":[0.28,0.6,0.1],"keyframes":[[0,0,0,0],[0.3,-0.15,0,0]]},
                                     {"min":[0.72,0,0],"max":[0.9,0.6,0.1],
                                       "keyframes":[[0,0,0,0],[0.3,0.15,0,0]]}])"});
    auto simulation = makeSimulation(scene);
    runUntil(*simulation, 0.6);
    double nearest = 1;
    int between = 0;
    const ObjectState state = simulation->state().objects;
    for (const Particle& p : simulation->particles()) {
        between += std::abs(p.position.x - 0.5) < 0.1 && p.position.y < 0.3;
        for (const Vec3& x : state.positions)
            nearest = std::min(nearest,
                               std::hypot(p.position.x - double(x.x), p.position.y - double(x.y)));
    }
    EXPECT_GT(between, 50);
    EXPECT_GT(nearest, 0.5 * 0.02);
}

// A ball flies into a block that nobody holds, off its middle: both together keep their momentum,
// and the block is pushed on.
TEST(Objects, FloatingSolidsPushAndArePushed) {
    Scene scene =
        sceneOf({"simulation.gravity=0,0,0", "fluid.sound_speed=10",
                 R"(objects=[{"shape":"block","min":[0.6,0.4,0.4],"max":[0.8,0.7,0.6],)"
                 R"("youngs_modulus":1e5}])",
                 R"(solids=[{"shape":"sphere","center":[0.42,0.5,0.5],"radius":0.1,"density":2000,)"
                 R"("velocity":[1,0,0]}])"});
    auto simulation = makeSimulation(scene);
    const double mass = massOf(scene, scene.solids[0]).mass;
    const ObjectSample sample = sampleObjects(scene);
    auto pushed = [&] {
        Vec3d sum{0, 0, 0};
        const ObjectState state = simulation->state().objects;
        for (size_t i = 0; i < sample.size(); ++i)
            sum = sum + double(sample.masses[i]) * toDouble(state.velocities[i]);
        return sum;
    };
    runUntil(*simulation, 0.2);
    const Vec3d ball = mass * simulation->measure().solids[0].velocity;
    std::printf("momenta: ball %.4f of %.4f, block %.4f %.4f kg m/s\n", ball.x, mass, pushed().x,
                pushed().y);
    EXPECT_LT(length(ball + pushed() - Vec3d{mass, 0, 0}), 2e-5 * mass);
    EXPECT_GT(pushed().x, 0.3 * mass);
    EXPECT_GT(simulation->measure().solids[0].velocity.x, -1);
}

// A ball as light as air does not leave faster than it came.
TEST(Objects, LightSolidsBounceOff) {
    Scene scene = sceneOf(
        {"simulation.gravity=0,0,0", "fluid.sound_speed=10",
         R"(objects=[{"shape":"block","min":[0.6,0.3,0.3],"max":[0.8,0.7,0.7],)"
         R"("youngs_modulus":1e5}])",
         R"(solids=[{"shape":"block","min":[0.38,0.4,0.4],"max":[0.55,0.6,0.6],"density":0.2,)"
         R"("velocity":[1,0,0]}])"});
    auto simulation = makeSimulation(scene);
    runUntil(*simulation, 0.12);
    const Vec3d velocity = simulation->measure().solids[0].velocity;
    EXPECT_LT(velocity.x, 0);
    EXPECT_LT(length(velocity), 1.01);
}

// A ball that falls onto a sheet whose rim is held stays above it, and sags with it.
TEST(Objects, SheetsCarryBalls) {
    Scene scene = sceneOf(
        {R"(objects=[{"shape":"sheet","min":[0.2,0.4,0.2],"max":[0.8,0.4,0.8],"spacing":0.025,)"
         R"("youngs_modulus":1e5,"thickness":0.01,"damping":0.3}])",
         R"(grips=[{"min":[0.1,0.3,0.1],"max":[0.21,0.5,0.9]},{"min":[0.79,0.3,0.1],"max":[0.9,)"
         R"(0.5,0.9]}])",
         R"(solids=[{"shape":"sphere","center":[0.5,0.55,0.5],"radius":0.1,"density":500}])"});
    auto simulation = makeSimulation(scene);
    runUntil(*simulation, 1);
    const Vec3d ball = simulation->measure().solids[0].position;
    double lowest = 1;
    for (const Vec3& x : simulation->state().objects.positions)
        lowest = std::min(lowest, double(x.y));
    std::printf("ball at %.4f m, the sheet's lowest at %.4f m\n", ball.y, lowest);
    EXPECT_LT(lowest, 0.39);
    EXPECT_NEAR(ball.y - lowest, 0.1 + 0.0125, 0.01);
}

// A run that goes on from a state does so with the same bits, torn or not.
TEST(Objects, RunsGoOnFromTheirStates) {
    Scene scene = sceneOf(
        {"domain.max=1,1,0.4",
         R"(fluid.bodies=[{"shape":"block","min":[0.3,0.6,0.1],"max":[0.7,0.8,0.3]}])",
         R"(objects=[{"shape":"sheet","min":[0.2,0.5,0.05],"max":[0.8,0.5,0.35],)"
         R"("youngs_modulus":1e6,"breaking_strain":0.05}])",
         R"(grips=[{"min":[0.1,0.4,0],"max":[0.201,0.7,0.4]},{"min":[0.799,0.4,0],"max":[0.9,)"
         R"(0.7,0.4]}])",
         R"(cuts=[{"time":0.1,"min":[0.5,0,0],"max":[0.53,1,0.2]}])"});
    auto first = makeSimulation(scene);
    runUntil(*first, 0.11);
    const RunState middle = first->state();
    EXPECT_GT(std::count(middle.objects.broken.begin(), middle.objects.broken.end(), 1), 0);
    first->restart(middle);
    auto second = makeSimulation(scene, middle);
    for (Simulation* s : {first.get(), second.get()}) s->step(200);
    const ObjectState a = first->state().objects, b = second->state().objects;
    EXPECT_EQ(a.broken, b.broken);
    for (size_t i = 0; i < a.positions.size(); ++i) ASSERT_EQ(a.positions[i], b.positions[i]) << i;
}

}  // namespace
}  // namespace spindrift
