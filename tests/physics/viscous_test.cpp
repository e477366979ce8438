// Viscosity at surfaces that are free of stress, and at walls that let fluid slip.
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

void choose(Scene& scene, const std::vector<std::string>& knobs) {
    for (const std::string& knob : knobs) setKnob(scene, knob);
}

Scene validationScene(const std::string& name, const std::vector<std::string>& choices) {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/validation/" + name + ".json");
    scene.compute.backend = Backend::Cpu;
    choose(scene, choices);
    return scene;
}

void runUntil(Simulation& simulation, double time) {
    simulation.stopAt(time);
    while (simulation.measure().time < time) simulation.step();
}

double angularMomentum(Simulation& simulation) {  // per mass of a particle
    double sum = 0;
    for (const Particle& p : simulation.particles())
        sum += p.position.x * p.velocity.y - p.position.y * p.velocity.x;
    return sum;
}

// In a disc that turns as a solid viscosity finds nothing to do, on its surface too.
TEST(Viscosity, LeavesWhatTurnsAsASolid) {
    for (const char* formulation : {"wcsph", "delta_sph", "delta_plus"}) {
        SCOPED_TRACE(formulation);
        const Scene scene =
            validationScene("rotation", {"simulation.spacing=0.08", "fluid.viscosity=0.02",
                                         std::string("simulation.formulation=") + formulation});
        const auto simulation = makeSimulation(scene);
        const double energy = simulation->measure().kineticEnergy,
                     turning = angularMomentum(*simulation);
        runUntil(*simulation, 5);
        EXPECT_NEAR(simulation->measure().kineticEnergy / energy, 1, 0.02);
        if (!shiftsParticles(scene)) {
            EXPECT_NEAR(angularMomentum(*simulation) / turning, 1, 2e-4);
        }
    }
}

// Whatever particles do to each other by viscosity keeps momentum and angular momentum; with
// nothing else at work a drop in which all move at random comes to turn as a solid.
TEST(Viscosity, KeepsAngularMomentum) {
    for (const char* precision : {"float", "double"}) {
        SCOPED_TRACE(precision);
        const Scene scene = validationScene(
            "rotation", {"simulation.spacing=0.1", "simulation.formulation=delta_sph",
                         "fluid.bodies[0].field=shear", "fluid.viscosity=0.2",
                         std::string("compute.precision=") + precision});
        const auto simulation = makeSimulation(scene);
        const double turning = angularMomentum(*simulation);
        ASSERT_LT(turning, -1);
        simulation->step(400);
        EXPECT_NEAR(angularMomentum(*simulation) / turning, 1, 1e-4);
        EXPECT_LT(length(simulation->measure().momentum), 1e-4);
    }
}

// Nusselt 1916: no stress at the surface, the wall's at the wall.
TEST(Viscosity, LetsFilmsRunDownInclines) {
    for (const char* formulation : {"delta_sph", "delta_plus"}) {
        SCOPED_TRACE(formulation);
        const Scene scene =
            validationScene("film", {"simulation.spacing=0.1", "fluid.sound_speed=15",
                                     std::string("simulation.formulation=") + formulation});
        const auto simulation = makeSimulation(scene);
        runUntil(*simulation, 6);
        double top = 0;
        for (const Particle& p : simulation->particles()) top = std::max(top, p.velocity.x);
        EXPECT_NEAR(top, 1, 0.02);
    }
}

double drift(const Scene& scene, double time) {  // the share of a uniform flow that is lost
    const auto simulation = makeSimulation(scene);
    const double before = simulation->measure().momentum.x;
    runUntil(*simulation, time);
    return 1 - simulation->measure().momentum.x / before;
}

// Fluid that slides freely along walls and solids keeps its velocity; that sticks, does not.
TEST(Slip, LetsAFlowGoOnForEver) {
    const std::string flow = R"(fluid.bodies=[{"max":[0.6,0.6,0.6],"velocity":[1,0,0]}])";
    const std::string plate =
        R"(solids=[{"shape":"plane","center":[0,0.05,0],"normal":[0,1,0],"slip":)";
    for (const char* formulation : {"wcsph", "delta_sph", "delta_plus", "transport_velocity"})
        for (const char* artificial : {"0", "0.1"}) {
            SCOPED_TRACE(std::string(formulation) + " " + artificial);
            Scene scene = validationScene(
                "half_channel",
                {std::string("simulation.formulation=") + formulation, "simulation.gravity=0,0,0",
                 "simulation.spacing=0.05", "simulation.jitter=0.1", "domain.max=0.6,0.6,0.6", flow,
                 std::string("fluid.artificial_viscosity=") + artificial, "walls.slip=-1"});
            EXPECT_LT(std::abs(drift(scene, 0.4)), 2e-3);
            choose(scene, {"walls.slip=0"});
            EXPECT_GT(drift(scene, 0.4), 0.2);
            choose(scene, {"walls.slip=-1", plate + "-1}]"});
            EXPECT_LT(std::abs(drift(scene, 0.4)), 5e-3);
            choose(scene, {plate + "0}]"});
            EXPECT_GT(drift(scene, 0.4), 0.1);
        }
}

// In three dimensions along edges too.
TEST(Slip, LetsAFlowGoOnInADuct) {
    const Scene scene = validationScene(
        "half_channel",
        {"simulation.dimensions=3", "simulation.formulation=delta_sph", "simulation.gravity=0,0,0",
         "simulation.spacing=0.05", "simulation.jitter=0.1", "domain.max=0.6,0.4,0.4",
         R"(fluid.bodies=[{"max":[0.6,0.4,0.4],"velocity":[1,0,0]}])", "walls.slip=-1"});
    EXPECT_LT(std::abs(drift(scene, 0.4)), 2e-3);
}

// Navier 1823: u = F / (2 nu) (y (L - y) + b L), in every way to say it.
TEST(Slip, ByALengthGivesNaviersFlow) {
    for (const char* how : {"walls.slip=0.1", "walls.slip_min=0,0.1,0"}) {
        SCOPED_TRACE(how);
        Scene scene = validationScene("slip_channel", {"fluid.viscosity=0.5", "walls.slip=0", how});
        const double lower = 0.1, upper = scene.walls.slip,  // m
            F = 0.05, nu = 0.5;
        const auto simulation = makeSimulation(scene);
        runUntil(*simulation, 4);
        // u = a + b y - F y^2 / (2 nu) with u = lower u' at 0 and u = -upper u' at 1.
        const double b = F / (2 * nu) * (1 + 2 * upper) / (1 + lower + upper);
        for (const Particle& p : simulation->particles())
            ASSERT_NEAR(p.velocity.x,
                        b * (lower + p.position.y) - F / (2 * nu) * p.position.y * p.position.y,
                        0.01 * 0.0175);
    }
}

}  // namespace
}  // namespace spindrift
