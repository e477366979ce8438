// Solids in the fluid: they are where their keyframes say, nobody gets into them, and what they
// feel is what the fluid feels.
#include "physics/cube.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

TEST(Solids, AreWhereTheirKeyframesSay) {
    const Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/solids_small.json");
    auto simulation = makeSimulation(scene);
    simulation->step(40);
    const Measurement now = simulation->measure();
    EXPECT_NEAR(now.solids[1].position.x, -0.025 + 0.1 * now.time / 0.2, 1e-5);
    EXPECT_EQ(now.solids[0].name, "paddle");
    EXPECT_EQ(now.solids[2].name, "solid2");
    EXPECT_NEAR(now.solids[2].position.y, 0.15, 1e-6);
    // The paddle turns about z by 180 degrees a second: a particle of its far edge says so.
    std::vector<Vertex> vertices(
        size_t(simulation->fluidCount() + simulation->solidParticleCount()));
    simulation->writeVertices({vertices.data()}, ColorBy::Plain, simulation->solidParticleCount());
    const Vertex& first = vertices[size_t(simulation->fluidCount())];
    const double angle = std::numbers::pi * now.time, x = -0.025,
                 y = -0.175;  // from its middle, at the start
    EXPECT_NEAR(first.x, 0.5 + x * std::cos(angle) - y * std::sin(angle), 1e-5);
    EXPECT_NEAR(first.y, 0.45 + x * std::sin(angle) + y * std::cos(angle), 1e-5);
    EXPECT_EQ(first.value, 1);
}

TEST(Solids, KeepEverybodyOutAtAnySpeed) {
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (
            const char* solid :
            {R"({"shape":"wedge","min":[0.2,0,0.2],"max":[0.8,0.3,0.8]})",
             R"({"shape":"sphere","center":[0.5,0.2,0.5],"radius":0.15})",
             R"({"shape":"cylinder","center":[0.5,0.2,0.5],"radius":0.15,"height":0.6,"axis":"x"})",
             R"({"shape":"block","min":[0.3,0.3,0.2],"max":[0.7,0.36,0.8]})"})
            for (float speed : {5.0f, 100.0f}) {
                SCOPED_TRACE(testing::Message() << formulation << " " << solid << " " << speed);
                Scene scene = cubeWith(
                    {std::string("simulation.formulation=") + formulation,
                     std::string("solids=[") + solid + "]",
                     R"(fluid.bodies=[{"shape":"block","min":[0.2,0.5,0.2],"max":[0.8,0.9,)"
                     R"(0.8]}])"});
                scene.fluid.bodies[0].velocity = {0, -speed, 0};
                auto simulation = makeSimulation(scene);
                simulation->step(150);
                const Convex shape = convexOf(scene.solids[0], 3);
                for (const Particle& p : simulation->particles())
                    ASSERT_GT(shape.nearest(p.position - shape.middle).distance, -1e-5) << p.id;
            }
}

// Fluid sticks to solids and to walls, also where its viscosity is set after the start.
TEST(Solids, ViscosityThatComesLaterIsTheSameFromThenOn) {
    Scene scene = cubeWith(
        {R"(solids=[{"shape":"sphere","center":[0.5,0.3,0.5],"radius":0.2}])", "walls.margin=0",
         R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.6,1],"velocity":[1,0,0]}])"});
    scene.fluid.viscosity = 5;
    auto first = makeSimulation(scene);
    const RunState start(placeParticles(scene));
    Scene inviscid = scene;
    inviscid.fluid.viscosity = 0;
    auto later = makeSimulation(inviscid, start);
    later->apply(scene);
    later->restart(start);
    for (Simulation* run : {first.get(), later.get()}) run->step(20);
    const std::vector<Particle> a = first->particles(), b = later->particles();
    for (size_t i = 0; i < a.size(); ++i)
        ASSERT_LT(length(a[i].velocity - b[i].velocity), 1e-12) << i;
}

// All that happens to the fluid's momentum comes from the solid: no gravity, no other walls.
TEST(Solids, FeelWhatTheFluidFeels) {
    for (const char* formulation : {"wcsph", "delta_sph"}) {
        SCOPED_TRACE(formulation);
        const Scene scene = cubeWith(
            {std::string("simulation.formulation=") + formulation, "simulation.gravity=0,0,0",
             "walls.kind=reflect", "time.cfl=0.1", "domain.max=3,1,1", "fluid.viscosity=1",
             R"(fluid.bodies=[{"shape":"block","min":[0.4,0.3,0.3],"max":[0.8,0.7,0.7]}])",
             R"(solids=[{"shape":"block","min":[0.2,0.2,0.2],"max":[0.4,0.8,0.8],)"
             R"("velocity":[0.4,0,0.2]}])"});
        auto simulation = makeSimulation(scene);
        Vec3d impulse;
        for (int k = 0; k < 500; ++k) {  // short ones: loads are those between two steps
            const SolidMeasurement load = simulation->measure().solids[0];
            simulation->step();
            const double dt = simulation->measure().dt;
            impulse = impulse - dt * (load.pressureForce + load.viscousForce);
        }
        const Vec3d gained = simulation->measure().momentum;
        EXPECT_GT(gained.x, 12);  // 64 kg, pushed at 0.4 m/s
        EXPECT_NEAR(impulse.x / gained.x, 1, 0.03);
        EXPECT_NEAR(impulse.z / gained.z, 1, 0.1);  // friction
        EXPECT_GT(gained.z, 0.2);
    }
}

// Archimedes: in still water a solid is pushed up by the weight of the water in its place.
TEST(Solids, AreLiftedByTheWeightOfTheirWater) {
    const Scene scene = cubeWith(
        {"simulation.formulation=delta_sph", "simulation.dimensions=2", "simulation.spacing=0.02",
         "fluid.artificial_viscosity=0.2", "fluid.speed_ratio=8", "time.cfl=0.5",
         R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.8,1],)"
         R"("pressure":"hydrostatic"}])",
         R"(solids=[{"shape":"sphere","center":[0.35,0.4,0.5],"radius":0.15},{"shape":"block",)"
         R"("min":[0.65,0.3,0],"max":[0.85,0.5,1]}])"});
    auto simulation = makeSimulation(scene);
    simulation->step(3000);
    double round = 0, square = 0;
    constexpr int Looks = 40;  // a mean over what is left of the sound
    for (int k = 0; k < Looks; ++k) {
        simulation->step(20);
        const Measurement m = simulation->measure();
        round += m.solids[0].pressureForce.y / Looks, square += m.solids[1].pressureForce.y / Looks;
    }
    const double weight = 1000 * 9.81;  // N/m, of a square metre
    EXPECT_NEAR(round / (weight * std::numbers::pi * 0.15 * 0.15), 1, 0.02);
    EXPECT_NEAR(square / (weight * 0.04), 1, 0.02);
}

// Of looks every 20 steps between two times, s.
template <class Look>
double meanOver(Simulation& simulation, double from, double until, const Look& look) {
    double sum = 0;
    int looks = 0;
    while (simulation.clock().time < until) {
        simulation.step(20);
        if (simulation.clock().time >= from) sum += look(simulation.measure()), ++looks;
    }
    return sum / looks;
}

// A dam bears the levels on its sides to where it stands on floor and walls: what stands in them
// behind its faces is the dam's, as far as fluid presses along the wall.
TEST(Solids, BearWhatPressesTheirFeet) {
    constexpr double Dx = 0.02, Rho = 1000, G = 9.81, Deep = 0.4, Shallow = 0.2, Wide = 0.2;
    for (const std::string formulation : {"delta_sph", "delta_plus"})
        for (const std::string motion : {"", R"(,"keyframes":[[0,0,0,0],[1,0.005,0,0]])"}) {
            SCOPED_TRACE(testing::Message() << formulation << motion);
            Scene scene;
            for (const std::string& knob :
                 {"simulation.formulation=" + formulation, std::string("simulation.spacing=0.02"),
                  std::string("fluid.artificial_viscosity=0.1"),
                  std::string("domain.max=0.48,0.5,0.2"),
                  R"(solids=[{"shape":"block","min":[0.2,0,0],"max":[0.28,0.5,0.2])" + motion +
                      "}]",
                  std::string(R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.2,0.4,0.2],
                      "pressure":"hydrostatic"},{"shape":"block","min":[0.28,0,0],
                      "max":[0.48,0.2,0.2],"pressure":"hydrostatic"}])")})
                setKnob(scene, knob);
            auto simulation = makeSimulation(scene);
            const double share = meanOver(*simulation, 0.3, 0.6, [&](const Measurement& now) {
                const double left = now.solids[0].position.x - 2 * Dx, right = left + 4 * Dx,
                             deep = Deep * 0.2 / left, shallow = Shallow * 0.2 / (0.48 - right);
                return now.solids[0].pressureForce.x /
                       (Rho * G * Wide * (deep * deep - shallow * shallow) / 2);
            });
            EXPECT_NEAR(share, 1, 0.03);
        }
}

// And along the wall alone: a block under water is pressed down by what is above it.
TEST(Solids, BearOnlyWhatIsAboveThem) {
    constexpr double Rho = 1000, G = 9.81, Above = 0.16, Side = 0.16;
    Scene scene;
    for (const char* knob :
         {"simulation.formulation=delta_sph", "simulation.spacing=0.04", "domain.max=0.4,0.5,0.4",
          "simulation.gravity_ramp=0.3", "fluid.artificial_viscosity=0.1",
          R"(solids=[{"shape":"block","min":[0.12,0,0.12],"max":[0.28,0.16,0.28]}])",
          R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.32,0.4]}])"})
        setKnob(scene, knob);
    auto simulation = makeSimulation(scene);
    const double force = meanOver(
        *simulation, 0.6, 1, [](const Measurement& now) { return now.solids[0].pressureForce.y; });
    EXPECT_NEAR(force / (-Rho * G * Above * Side * Side), 1, 0.03);
}

}  // namespace
}  // namespace spindrift
