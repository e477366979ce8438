#include "measure/health.h"

#include "scene/json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

Measurement sound() {
    Measurement m;
    m.time = 0.5, m.dt = 1e-4, m.longestStep = 1e-4, m.steps = 12, m.maxSpeed = 3,
    m.meanDensity = 1000, m.kineticEnergy = 1;
    return m;
}

TEST(Health, ASoundRunHasNoComplaint) { EXPECT_EQ(divergence(Scene{}, sound()), ""); }

TEST(Health, SaysWhatHasDivergedAndWhen) {
    Measurement m = sound();
    m.finite = false;
    EXPECT_NE(
        divergence(Scene{}, m).find("diverged at step 12 (0.5 s): values that are no numbers"),
        std::string::npos);
    m = sound();
    m.kineticEnergy = NAN;
    EXPECT_NE(divergence(Scene{}, m), "");
    m = sound();
    m.dt = INFINITY;
    EXPECT_NE(divergence(Scene{}, m), "");

    m = sound();
    m.dt = 0.02;  // 3 m/s: 6 cm, over the support radius of 5.2 cm
    EXPECT_NE(divergence(Scene{}, m).find("farther than its support radius"), std::string::npos);

    Scene scene;
    scene.fluid.soundSpeed = 20;
    m = sound();
    m.maxSpeed = 59;
    EXPECT_EQ(divergence(scene, m), "");
    m.maxSpeed = 61;
    EXPECT_NE(divergence(scene, m).find("times the speed of sound"), std::string::npos);
}

// The simulation takes a sliding lid and a central pull into its speed of sound; so must the alarm.
TEST(Health, FastLidIsNoAlarm) {
    Measurement m = sound();
    m.maxSpeed = 400, m.dt = 1e-6;
    Scene scene;
    EXPECT_NE(divergence(scene, m), "");
    scene.walls.velocity = {400, 0, 0};
    EXPECT_EQ(divergence(scene, m), "");
    scene.walls.velocity = {0, 0, 0};
    scene.simulation.centralRate = 300;
    EXPECT_EQ(divergence(scene, m), "");
}

TEST(Health, RemedyFitsTheStepping) {
    Measurement m = sound();
    m.finite = false;
    Scene scene;
    EXPECT_NE(divergence(scene, m).find("time.cfl"), std::string::npos);
    scene.time.mode = TimeMode::Fixed;
    EXPECT_NE(divergence(scene, m).find("time.step"), std::string::npos);
}

TEST(Health, SqueezedParticlesAndStepsWithoutLengthAreTrouble) {
    Measurement m = sound();
    m.maxDensityError = 1.1;
    EXPECT_NE(divergence(Scene{}, m).find("squeezed to 2.1 times the rest density"),
              std::string::npos);
    EXPECT_EQ(divergence(Scene{}, m, 1.2), "");
    Scene classic;
    classic.simulation.formulation = Formulation::Classic;
    EXPECT_EQ(divergence(classic, m), "");

    m = sound();
    m.dt = 1e-8;
    EXPECT_EQ(divergence(Scene{}, m), "") << "the run only stopped there";
    m.longestStep = 1e-8;
    EXPECT_NE(divergence(Scene{}, m).find("a thousandth of what sound allows"), std::string::npos);
    Scene fixed;
    fixed.time.mode = TimeMode::Fixed;
    EXPECT_EQ(divergence(fixed, m), "");
}

// A block falls into a tank of half a metre.
Scene dropped() {
    Scene s;
    s.compute.backend = Backend::Cpu;
    s.simulation.spacing = 0.05f;
    s.domain.max = {0.5f, 0.8f, 0.5f};
    s.fluid.bodies[0].min = {0.1f, 0.2f, 0.1f}, s.fluid.bodies[0].max = {0.4f, 0.6f, 0.4f};
    return s;
}

struct Guarded {
    explicit Guarded(const Scene& s)
        : scene(s), simulation(makeSimulation(s)), guard(*simulation, scene) {}
    // Until then, in steps, or until the guard gives up. What it said, one line each.
    HealthGuard::Finding run(int64_t steps) {
        HealthGuard::Finding found = HealthGuard::Finding::Sound;
        for (int looks = 0;
             looks < 10000 && now.steps < steps && found != HealthGuard::Finding::GaveUp; ++looks) {
            simulation->step(10);
            now = simulation->measure();
            found = guard.look(now);
            if (!guard.said().empty()) said.push_back(guard.said());
        }
        return found;
    }
    bool heard(const std::string& words) const {
        return std::any_of(said.begin(), said.end(), [&](const std::string& s) {
            return s.find(words) != std::string::npos;
        });
    }
    Scene scene;
    std::unique_ptr<Simulation> simulation;
    HealthGuard guard;
    Measurement now;
    std::vector<std::string> said;
};

TEST(HealthGuard, LeavesASoundRunAsItIs) {
    Guarded guarded(dropped());
    EXPECT_EQ(int(guarded.run(1000)), int(HealthGuard::Finding::Sound));
    EXPECT_TRUE(guarded.said.empty()) << guarded.said[0];
    const auto alone = makeSimulation(dropped());
    alone->step(1000);
    const RunState a = alone->state(), b = guarded.simulation->state();
    EXPECT_EQ(a.particles.positions, b.particles.positions);
    EXPECT_EQ(a.particles.velocities, b.particles.velocities);
    EXPECT_EQ(a.clock.time, b.clock.time);
    EXPECT_GE(guarded.guard.lastGood().clock.steps, 800);
}

TEST(HealthGuard, RescuesARunWhoseStepIsFarTooLong) {
    Scene scene = dropped();
    scene.time.mode = TimeMode::Fixed,
    scene.time.step = 0.02f;  // sound crosses a particle's reach in 0.003 s
    Guarded guarded(scene);
    EXPECT_EQ(int(guarded.run(3000)), int(HealthGuard::Finding::Sound));
    EXPECT_EQ(guarded.now.steps, 3000);
    EXPECT_TRUE(guarded.heard("back to step 0 (0 s), on with 0.5 of the time step, try 1 of 3"))
        << guarded.said.size();
    EXPECT_TRUE(guarded.now.finite);
    EXPECT_LT(guarded.now.dt, 0.011);
    EXPECT_LT(guarded.now.maxSpeed, 4);
    scene.time.retries = 0;
    EXPECT_EQ(int(Guarded(scene).run(3000)), int(HealthGuard::Finding::GaveUp))
        << "else this test shows nothing";
}

// A step that is too long only while sound is made fast: afterwards it is what it was.
TEST(HealthGuard, LengthensTheStepAgain) {
    Scene scene = dropped();
    scene.time.mode = TimeMode::Fixed, scene.time.step = 0.002f;
    Guarded guarded(scene);
    ASSERT_EQ(int(guarded.run(400)), int(HealthGuard::Finding::Sound));
    ASSERT_TRUE(guarded.said.empty()) << guarded.said[0];
    Scene wild = scene;
    wild.fluid.soundSpeed = 150;
    guarded.guard.apply(wild);
    ASSERT_NE(int(guarded.run(440)), int(HealthGuard::Finding::GaveUp));
    ASSERT_GT(guarded.guard.retries(), 0);
    EXPECT_LT(guarded.now.dt, 0.0011);
    guarded.guard.apply(scene);
    EXPECT_EQ(int(guarded.run(4000)), int(HealthGuard::Finding::Sound));
    EXPECT_TRUE(guarded.heard("the time step is what it was"));
    EXPECT_FLOAT_EQ(float(guarded.now.dt), 0.002f);
}

TEST(HealthGuard, GivesUpWithPlaceCauseAndParticles) {
    Scene scene = dropped();
    scene.time.mode = TimeMode::Fixed, scene.time.step = 0.5f, scene.time.retries = 2;
    Guarded guarded(scene);
    EXPECT_EQ(int(guarded.run(3000)), int(HealthGuard::Finding::GaveUp));
    EXPECT_EQ(guarded.guard.retries(), 2);
    ASSERT_FALSE(guarded.guard.culprits().empty());
    const Particle worst = guarded.guard.culprits()[0];
    EXPECT_TRUE(std::isfinite(worst.position.x));
    for (const char* words : {"diverged at step ", " at (", ") m: ", "; particle ",
                              "shorter steps have not helped 2 times", "lower time.step"})
        EXPECT_TRUE(guarded.heard(words)) << words << " in " << guarded.said.back();
    EXPECT_NE(guarded.said.back().find("particle " + std::to_string(worst.id)), std::string::npos);
    EXPECT_EQ(guarded.guard.lastGood().clock.steps, 0);
}

// The same bits each time: what is done is counted in steps and simulated time alone.
TEST(HealthGuard, RescuesTheSameWayEachTime) {
    Scene scene = dropped();
    scene.time.mode = TimeMode::Fixed, scene.time.step = 0.02f;
    Guarded one(scene), two(scene);
    one.run(1500), two.run(1500);
    EXPECT_GT(one.guard.retries(), 0);
    EXPECT_EQ(one.said, two.said);
    EXPECT_EQ(one.simulation->state().particles.positions,
              two.simulation->state().particles.positions);
}

}  // namespace
}  // namespace spindrift
