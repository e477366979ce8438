#include "measure/health.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

Measurement sound() {
    Measurement m;
    m.time = 0.5, m.dt = 1e-4, m.steps = 12, m.maxSpeed = 3, m.meanDensity = 1000,
    m.kineticEnergy = 1;
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

}  // namespace
}  // namespace spindrift
