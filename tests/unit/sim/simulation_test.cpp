// What the front end asks of a simulation.
#include "sim/simulation.h"

#include "scene/particles.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

Scene calm() {
    Scene s;
    s.domain.max = {1, 1, 1};
    s.simulation.spacing = 0.05f;
    s.simulation.gravity = {0, 0, 0};
    s.walls.kind = WallKind::Reflect;
    s.compute.threads = 2;
    return s;
}

// 1,000 particles far apart, the k-th with speed k/1000, and one outlier.
Placement apart() {
    Placement p;
    for (int k = 0; k < 1000; ++k) {
        p.positions.push_back({0.05f + 0.1f * float(k % 10), 0.05f + 0.1f * float(k / 10 % 10),
                               0.05f + 0.1f * float(k / 100)});
        p.velocities.push_back({float(k) / 1000, 0, 0});
    }
    p.velocities[500] = {100, 0, 0};
    return p;
}

TEST(Vertices, StandAtTheirIdWithTheirValue) {
    const Placement placement = apart();
    const auto simulation = makeSimdSimulation(calm(), placement, 2);
    std::vector<Vertex> vertices(placement.positions.size());
    simulation->writeVertices({vertices.data()}, ColorBy::Velocity, 0);
    for (size_t i = 0; i < vertices.size(); ++i) {
        EXPECT_EQ(vertices[i].x, placement.positions[i].x);
        EXPECT_EQ(vertices[i].y, placement.positions[i].y);
        EXPECT_FLOAT_EQ(vertices[i].value, placement.velocities[i].x);
    }
}

TEST(Vertices, RangeLeavesOutliersOut) {
    Placement placement = apart();
    const auto simulation = makeSimdSimulation(calm(), placement, 2);
    std::vector<Vertex> vertices(placement.positions.size());
    const Range range = simulation->writeVertices({vertices.data()}, ColorBy::Velocity, 0);
    EXPECT_LT(range.max, 2);
    EXPECT_GE(range.max, 0.99f);
    EXPECT_LT(range.min, 0.1f);
    const Range plain = simulation->writeVertices({vertices.data()}, ColorBy::Plain, 0);
    EXPECT_EQ(plain.min, 0);
    EXPECT_EQ(plain.max, 0);
}

// In whatever units a scene is: only sound bounds the step, unless a knob does.
TEST(Steps, AreAsLongAsSoundLetsThemBe) {
    for (const TimeMode mode : {TimeMode::Cfl, TimeMode::Local})
        for (float asked : {0.0f, 0.01f}) {
            Scene scene = calm();
            scene.simulation.formulation = Formulation::DeltaSph;
            scene.fluid.soundSpeed = 0.01f, scene.fluid.bodies = {Body{}};
            scene.fluid.bodies[0].min = {0.2f, 0.2f, 0.2f};
            scene.fluid.bodies[0].max = {0.6f, 0.6f, 0.6f};
            scene.time.mode = mode, scene.time.maxStep = asked;
            const auto simulation = makeSimdSimulation(scene, placeParticles(scene), 2);
            simulation->step(2);
            const double sound = scene.time.cfl * supportRadius(scene) / 2 / scene.fluid.soundSpeed;
            const double longest = simulation->measure().longestStep;
            EXPECT_GT(sound, 2);
            EXPECT_LE(longest, asked > 0 ? 0.010001 : 3 * sound);
            EXPECT_GE(longest, asked > 0 ? 0.0099 : 0.9 * sound);
        }
}

TEST(Measurement, MomentaAreSumsOverTheParticles) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        Scene s = calm();
        s.domain.min = {-3, 2, 0.5f}, s.domain.max = {-2, 3, 1.5f};
        s.compute.precision = precision;
        Placement placement = apart();
        for (size_t i = 0; i < placement.velocities.size(); ++i)
            placement.velocities[i] = {float(i % 7), float(i % 11) - 5, float(i % 3)};
        const auto simulation = makeSimulation(s, placement);
        const Vec3d middle{-2.5, 2.5, 1};
        const double mass = 1000 * 0.05 * 0.05 * 0.05;
        Vec3d momentum, angular;
        for (const Particle& p : simulation->particles()) {
            momentum = momentum + mass * p.velocity;
            angular = angular + mass * cross(p.position - middle, p.velocity);
        }
        const Measurement m = simulation->measure();
        EXPECT_LT(length(m.momentum - momentum), 1e-5 * length(momentum));
        EXPECT_LT(length(m.angularMomentum - angular), 1e-5 * length(angular));
        EXPECT_GT(length(angular), 1);
    }
}

TEST(Particle, OneIsWhatAllSay) {
    for (Precision precision : {Precision::Float, Precision::Double}) {
        Scene scene = calm();
        scene.simulation.gravity = {0, -9.81f, 0};
        const auto simulation = precision == Precision::Float
                                    ? makeSimdSimulation(scene, apart(), 2)
                                    : makeDoubleSimulation(scene, apart(), 2);
        simulation->step(5);
        const std::vector<Particle> all = simulation->particles();
        for (int id : {0, 7, 500, 999}) {
            const Particle one = simulation->particle(id);
            EXPECT_EQ(one.id, id);
            EXPECT_EQ(one.position, all[size_t(id)].position);
            EXPECT_EQ(one.velocity, all[size_t(id)].velocity);
            EXPECT_EQ(one.density, all[size_t(id)].density);
        }
    }
}

TEST(PairsSeen, AreAllThatCountAndNotManyMore) {
    Scene scene = calm();
    scene.compute.backend = Backend::Cpu;
    scene.fluid.bodies[0].min = {0.2f, 0.2f, 0.2f}, scene.fluid.bodies[0].max = {0.8f, 0.8f, 0.8f};
    const auto simulation = makeSimulation(scene);
    simulation->step(2);
    const std::vector<Particle> particles = simulation->particles();
    double within = 0;
    for (size_t i = 0; i < particles.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            within += length(particles[i].position - particles[j].position) < supportRadius(scene);
    const PairsSeen seen = simulation->pairsSeen();
    EXPECT_GE(seen.later, within);
    EXPECT_GE(seen.first, seen.later);
    EXPECT_LT(seen.first, 6 * within);
}

// v = g integral of s^2 (3 - 2 s), s = t / T: g T (s^3 - s^4 / 2), from T on g (t - T / 2). It goes
// on from a state as if nothing had been.
TEST(Gravity, GrowsSmoothlyOverItsRamp) {
    for (Precision precision : {Precision::Float, Precision::Double}) {
        Scene scene = calm();
        scene.domain.max = {1, 100, 1};
        scene.simulation.gravity = {0, 9.81f, 0};
        scene.simulation.gravityRamp = 0.4f;
        scene.time.mode = TimeMode::Fixed;
        scene.time.step = 0.001f;
        Placement one;
        one.positions = {{0.5f, 0.5f, 0.5f}}, one.velocities = {{0, 0, 0}};
        auto make = [&](const RunState& from) {
            return precision == Precision::Float ? makeSimdSimulation(scene, from, 1)
                                                 : makeDoubleSimulation(scene, from, 1);
        };
        auto simulation = make(RunState(one));
        for (int steps = 100; steps <= 600; steps += 100) {
            simulation->step(100);
            const double T = 0.4, t = 0.001 * steps, s = t / T;
            const double exact = 9.81 * (s < 1 ? T * (s * s * s - s * s * s * s / 2) : t - T / 2);
            EXPECT_NEAR(simulation->particles()[0].velocity.y, exact, 0.001 * 9.81 + 1e-4 * exact)
                << t;
            if (steps == 200) simulation = make(simulation->state());
        }
    }
}

TEST(Box, NobodyLeavesAndRestitutionHolds) {
    Scene scene = calm();
    scene.walls.restitution = 0.5f;
    Placement p;
    p.positions = {{0.5f, 0.5f, 0.5f}};
    p.velocities = {{2, 0, 0}};
    scene.time = {.mode = TimeMode::Fixed, .step = 0.01f, .cfl = 0.4f, .maxStep = 0.1f};
    const auto simulation = makeSimdSimulation(scene, p, 1);
    double fastestBack = 0;
    for (int k = 0; k < 60; ++k) {
        simulation->step();
        const Particle one = simulation->particle(0);
        EXPECT_GE(one.position.x, 0);
        EXPECT_LE(one.position.x, 1);
        fastestBack = std::min(fastestBack, one.velocity.x);
    }
    EXPECT_NEAR(fastestBack, -1, 1e-5);
}

// It would look like one at the wall, and all of them together would take forever.
TEST(Box, WhoIsNowhereStaysNowhere) {
    Placement p = apart();
    p.velocities[3] = {NAN, 0, 0};
    for (Precision precision : {Precision::Float, Precision::Double}) {
        const auto simulation = precision == Precision::Float ? makeSimdSimulation(calm(), p, 2)
                                                              : makeDoubleSimulation(calm(), p, 2);
        simulation->step();
        EXPECT_TRUE(std::isnan(simulation->particle(3).position.x));
        EXPECT_FALSE(std::isnan(simulation->particle(999).position.x));
        EXPECT_FALSE(simulation->measure().finite);
    }
}

TEST(Stir, DragsTheFluidInItsSphereOnly) {
    Placement still = apart();
    for (Vec3& u : still.velocities) u = {0, 0, 0};
    Scene scene = calm();
    scene.time = {.mode = TimeMode::Fixed, .step = 0.001f, .cfl = 0.4f, .maxStep = 0.1f};
    const auto simulation = makeSimdSimulation(scene, still, 2);
    simulation->stir({{0.05f, 0.05f, 0.05f}, 0.06f, {0, 3, 0}});
    simulation->step(20);
    EXPECT_GT(simulation->particle(0).velocity.y, 1);
    EXPECT_EQ(simulation->particle(999).velocity.y, 0);
    simulation->stir({});
    const double before = simulation->particle(0).velocity.y;
    simulation->step(1);
    EXPECT_NEAR(simulation->particle(0).velocity.y, before,
                1e-3);  // friction with its neighbours goes on
}

}  // namespace
}  // namespace spindrift
