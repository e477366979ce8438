// Solids that float: what fluid gives them it loses, they weigh what they should, fall, tumble and
// slide as mechanics says, and the mouse can drag them.
#include "physics/cube.h"
#include "scene/mass.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace spindrift {
namespace {

// Steps of half a millisecond, unless the knobs say otherwise.
Scene sceneOf(const std::vector<std::string>& knobs) {
    std::vector<std::string> all{"time.mode=fixed", "time.step=0.0005"};
    all.insert(all.end(), knobs.begin(), knobs.end());
    return dryCubeWith(all);
}

SolidMeasurement solidAfter(Simulation& simulation, int steps) {
    simulation.step(steps);
    return simulation.measure().solids[0];
}

// A cube of half density: its middle comes to rest where the water's level is then.
TEST(Floating, CubeOfHalfDensityIsHalfSubmerged) {
    for (const char* formulation : {"wcsph", "delta_sph"}) {
        const Scene scene =
            sceneOf({std::string("simulation.formulation=") + formulation, "domain.max=0.4,0.4,0.4",
                     "simulation.spacing=0.02", "time.mode=cfl", "fluid.dissipation=1",
                     R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.2,0.4]}])",
                     R"(solids=[{"shape":"block","min":[0.14,0.18,0.14],"max":[0.26,0.30,0.26],)"
                     R"("density":500}])"});
        auto simulation = makeSimulation(scene);
        simulation->stopAt(2.0);
        while (simulation->clock().time < 2.0) simulation->step(50);
        const double cube = 0.12 * 0.12 * 0.12, level = (0.4 * 0.2 * 0.4 + cube / 2) / (0.4 * 0.4);
        EXPECT_NEAR(simulation->measure().solids[0].position.y, level, 0.02) << formulation;
        EXPECT_LT(length(simulation->measure().solids[0].velocity), 0.05) << formulation;
    }
}

// Fluid runs into a solid, all alone in space: nothing of the momentum of both is lost, nor of the
// angular momentum but for where pairs are viscous.
TEST(Floating, FluidAndSolidKeepTheirMomentum) {
    const std::pair<const char*, const char*> pairs[] = {{"wcsph", "symplectic_euler"},
                                                         {"delta_sph", "predictor_corrector"}};
    for (const auto& [formulation, integrator] : pairs) {
        const Scene scene = sceneOf(
            {std::string("simulation.formulation=") + formulation,
             std::string("time.integrator=") + integrator, "simulation.gravity=0,0,0",
             "walls.kind=reflect", "time.mode=cfl", "domain.min=-1,-1,-1", "domain.max=6,5,5",
             "fluid.viscosity=1", "compute.precision=double",
             R"(fluid.bodies=[{"shape":"block","min":[1.5,1.8,1.8],"max":[1.9,2.2,2.2],)"
             R"("velocity":[1,0,0]}])",
             R"(solids=[{"shape":"block","min":[2,1.9,1.7],"max":[2.3,2.4,2.2],"density":700}])"});
        auto simulation = makeSimulation(scene);
        const double mass = massOf(scene, scene.solids[0]).mass;
        auto momentum = [&] {
            const Measurement m = simulation->measure();
            return m.momentum + mass * m.solids[0].velocity;
        };
        const Vec3d before = momentum();
        simulation->step(1000);
        EXPECT_GT(mass * simulation->measure().solids[0].velocity.x, 5) << "it was hit";
        EXPECT_GT(length(simulation->measure().solids[0].spin), 0.05) << "beside its middle";
        EXPECT_LT(length(momentum() - before) / length(before), 1e-5)
            << formulation << " " << integrator;
    }
}

// What lies on the floor of a tank, or beside its wall, and how far up it is after a while. Gravity
// grows, so that the water does not fall first.
struct Submerged {
    std::string form;  // of the solid, about (0.2, y, 0.2)
    double density;
    int dimensions, across;  // spacings in 0.1 m
    std::string formulation = "wcsph";
};
void runUntil(Simulation& simulation, double time) {
    simulation.stopAt(time);
    while (simulation.clock().time < time) simulation.step();
}
std::unique_ptr<Simulation> tankWith(const Submerged& s) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    const std::string knobs[] = {
        "simulation.formulation=" + s.formulation,
        "simulation.dimensions=" + std::to_string(s.dimensions),
        "simulation.spacing=" + std::to_string(0.1 / s.across),
        "simulation.gravity_ramp=0.1",
        "domain.max=0.4,0.5,0.4",
        "fluid.dissipation=1",
        R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.4,0.4]}])",
        "solids=[{" + s.form + ",\"density\":" + std::to_string(s.density) + "}]"};
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return makeSimulation(scene);
}
// m, once gravity has grown.
double rise(const Submerged& s) {
    auto simulation = tankWith(s);
    runUntil(*simulation, 0.2);
    const double before = simulation->measure().solids[0].position.y;
    runUntil(*simulation, 0.5);
    return simulation->measure().solids[0].position.y - before;
}
const std::string OnTheFloor = R"("shape":"sphere","center":[0.2,0.1,0.2],"radius":0.1)";
const std::string BesideTheWall = R"("shape":"sphere","center":[0.1,0.2,0.2],"radius":0.1)";

// Without the pressure of gaps they stick: the floor's is several times the buoyancy.
TEST(Floating, LightBallsRiseFromTheFloorAndOffWalls) {
    for (const std::string& form : {OnTheFloor, BesideTheWall})
        for (int across : {3, 4, 6, 8})
            for (double density : {100.0, 500.0, 900.0})
                EXPECT_GT(rise({form, density, 2, across}), 0.004)
                    << form << density << " " << across;
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (int across : {3, 4})
            EXPECT_GT(rise({OnTheFloor, 900, 3, across, formulation}), 0.01)
                << formulation << across;
}

// Heavier ones stay where they are, and the water carries what it should of them: the weight of the
// water that they displace, though there is none below them.
TEST(Floating, HeavySolidsOnTheFloorFeelTheirBuoyancy) {
    struct Case {
        std::string form;
        double height, volume, area;
    };
    const Case cases[] = {
        {R"("shape":"block","min":[0.1,0,0.1],"max":[0.3,0.2,0.3])", 0.1, 0.008, 0.04},
        {R"("shape":"wedge","min":[0.1,0,0.1],"max":[0.3,0.1,0.3])", 0.05, 0.002, 0.01},
        {R"("shape":"cylinder","axis":"y","center":[0.2,0.05,0.2],"radius":0.1,"height":0.1)", 0.05,
         0.001 * std::numbers::pi, 0},
    };
    for (const Case& c : cases)
        for (int dimensions : {2, 3}) {
            const double displaced = dimensions == 2 ? c.area : c.volume;
            if (displaced == 0) continue;
            for (double density : {1100, 2000}) {
                SCOPED_TRACE(c.form + std::to_string(dimensions) + " " + std::to_string(density));
                auto tank = tankWith({c.form, density, dimensions, 4});
                runUntil(*tank, 0.3);
                const SolidMeasurement s = tank->measure().solids[0];
                EXPECT_NEAR(s.position.y, c.height, 0.001);
                EXPECT_NEAR(s.pressureForce.y / (9.81e3 * displaced), 1, 0.02);
            }
        }
}

TEST(Floating, FallsAndTumblesFreely) {
    Scene scene = sceneOf(
        {"walls.kind=reflect",
         R"(solids=[{"shape":"block","min":[0.4,0.7,0.4],"max":[0.6,0.9,0.7],"density":2000,)"
         R"("velocity":[0.5,0,0],"spin":360,"spin_axis":"y"}])"});
    auto simulation = makeSimulation(scene);
    const SolidMeasurement s = solidAfter(*simulation, 400);
    EXPECT_NEAR(s.position.y, 0.8 - 0.5 * 9.81 * 0.04, 0.001);
    EXPECT_NEAR(s.position.x, 0.6, 1e-5);
    EXPECT_NEAR(s.spin.y, 2 * std::numbers::pi, 1e-5);
    // The vertices show the turn: 72 degrees after 0.2 s.
    std::vector<Vertex> now(size_t(simulation->fluidCount() + simulation->solidParticleCount())),
        start = now;
    makeSimulation(scene)->writeVertices({start.data()}, ColorBy::Plain,
                                         simulation->solidParticleCount());
    simulation->writeVertices({now.data()}, ColorBy::Plain, simulation->solidParticleCount());
    const Vertex &a = start[size_t(simulation->fluidCount())],
                 &b = now[size_t(simulation->fluidCount())];
    const double angle = 0.4 * std::numbers::pi, x = a.x - 0.5, z = a.z - 0.55;
    EXPECT_NEAR(b.x - s.position.x, x * std::cos(angle) + z * std::sin(angle), 1e-4);
    EXPECT_NEAR(b.z - s.position.z, z * std::cos(angle) - x * std::sin(angle), 1e-4);
}

// A top that turns about no axis of its own: its axis goes round the angular momentum at L / I
// (Euler), and its energy stays.
TEST(Floating, TopPrecesses) {
    Scene scene =
        sceneOf({"walls.kind=reflect", "simulation.gravity=0,0,0",
                 R"(solids=[{"shape":"cylinder","axis":"z","center":[0.5,0.5,0.5],"radius":0.15,)"
                 R"("height":0.1,"density":1000}])"});
    const Mass mass = massOf(scene, scene.solids[0]);
    auto simulation = makeSimulation(scene);
    RunState state = simulation->state();
    const Vec3d momentum = mass.inertia[2].z * Vec3d{0, 0, 8} + mass.inertia[0].x * Vec3d{2, 0, 0};
    state.solids[0].angularMomentum = momentum;
    simulation->restart(state);
    const double rate = length(momentum) / mass.inertia[0].x,
                 turn = 0.5 * std::numbers::pi;  // a quarter of a precession
    const SolidMeasurement s = solidAfter(*simulation, int(std::round(turn / rate / 0.0005)));
    const Vec3d along = (1 / length(momentum)) * momentum, axis{0, 0, 1};
    const double share = dot(axis, along);
    const Vec3d expected = share * along + cross(along, axis);  // Rodrigues, by 90 degrees
    const SolidMotion now = simulation->state().solids[0];
    const auto [w, x, y, z] = now.turn;
    EXPECT_LT(
        length(Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)} - expected),
        0.01);
    EXPECT_LT(length(now.angularMomentum - momentum), 1e-9);
    EXPECT_NEAR(dot(s.spin, momentum), mass.inertia[2].z * 64 + mass.inertia[0].x * 4,
                0.01 * mass.inertia[2].z * 64);  // twice its energy
}

// A block slides to a halt after v^2 / (2 mu g), and stays upright and on the floor.
TEST(Floating, BlockSlidesToAHalt) {
    const Scene scene =
        sceneOf({"walls.kind=reflect", "domain.max=3,1,1",
                 R"(solids=[{"shape":"block","min":[0.4,0,0.4],"max":[0.8,0.2,0.7],"density":1000,)"
                 R"("velocity":[2,0,0],"friction":0.4}])"});
    auto simulation = makeSimulation(scene);
    const SolidMeasurement s = solidAfter(*simulation, 1600);  // it takes 0.51 s
    EXPECT_NEAR(s.position.x, 0.6 + 4 / (2 * 0.4 * 9.81), 0.01);
    EXPECT_NEAR(s.position.y, 0.1, 0.001);
    EXPECT_LT(length(s.velocity) + length(s.spin), 0.005);
}

// Springs go with the step, which may become longer while the run goes on.
TEST(Floating, BlockStaysOnTheFloorWhenStepsBecomeLonger) {
    Scene scene = sceneOf(
        {"walls.kind=reflect",
         R"(solids=[{"shape":"block","min":[0.4,0,0.4],"max":[0.8,0.2,0.7],"density":1000}])"});
    auto simulation = makeSimulation(scene);
    simulation->step(200);
    scene.time.step = 0.01f;
    simulation->apply(scene);
    const SolidMeasurement s = solidAfter(*simulation, 100);
    EXPECT_NEAR(s.position.y, 0.1, 0.03);  // softer by the square of twenty
    EXPECT_LT(length(s.velocity) + length(s.spin), 0.01);
}

// Solids that meet: momentum is kept, and a stack of them stands.
TEST(Floating, SolidsPushEachOther) {
    Scene scene = sceneOf(
        {"walls.kind=reflect", "simulation.gravity=0,0,0", "walls.restitution=1",
         R"(solids=[{"shape":"block","min":[0.2,0.4,0.4],"max":[0.4,0.6,0.6],"density":1000,)"
         R"("velocity":[1,0,0],"friction":0},)"
         R"({"shape":"block","min":[0.5,0.4,0.4],"max":[0.7,0.6,0.6],"density":1000,)"
         R"("friction":0}])"});
    auto simulation = makeSimulation(scene);
    simulation->step(500);
    const Measurement m = simulation->measure();
    EXPECT_NEAR(m.solids[0].velocity.x + m.solids[1].velocity.x, 1, 1e-4);
    EXPECT_NEAR(m.solids[1].velocity.x, 1, 0.05);  // all of it: as heavy, and elastic
    scene = sceneOf(
        {"walls.kind=reflect",
         R"(solids=[{"shape":"block","min":[0.4,0,0.4],"max":[0.7,0.2,0.7],"density":500},)"
         R"({"shape":"block","min":[0.45,0.2,0.45],"max":[0.65,0.35,0.65],"density":3000}])"});
    simulation = makeSimulation(scene);
    simulation->step(1000);
    EXPECT_NEAR(simulation->measure().solids[1].position.y, 0.275, 0.003);
    EXPECT_LT(length(simulation->measure().solids[1].velocity), 0.005);
}

// What the mouse holds comes to where it is wanted, floating or not, and a run that goes on knows
// where it was left.
TEST(Floating, MouseDragsThem) {
    for (const char* density : {"0", "800"}) {
        const Scene scene = sceneOf(
            {"time.mode=cfl", R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,1]}])",
             std::string(
                 R"(solids=[{"shape":"sphere","center":[0.3,0.3,0.5],"radius":0.12,"density":)") +
                 density + "}]"});
        auto simulation = makeSimulation(scene);
        simulation->step(20);
        simulation->hold({0, {0.7f, 0.3f, 0.5f}});
        simulation->stopAt(1.5);
        while (simulation->clock().time < 1.5) simulation->step(20);
        const Vec3d middle = simulation->measure().solids[0].position;
        EXPECT_NEAR(middle.x, 0.7, 0.02) << density;
        for (const Particle& p : simulation->particles())
            EXPECT_GT(length(p.position - middle), 0.12 - 1e-3);
        simulation->hold({});
        const RunState left = simulation->state();
        EXPECT_NEAR(makeSimulation(scene, left)->measure().solids[0].position.x, middle.x, 1e-5)
            << density;
        simulation->step(50);
        if (scene.solids[0].density == 0) {
            EXPECT_NEAR(simulation->measure().solids[0].position.x, middle.x, 1e-6);
        }
    }
}

// A hand as strong as that of the mouse drags a block through water into the wall, or into another
// block: fluid between them gets away before it is crushed.
TEST(Floating, WhatIsDraggedIntoAWallLeavesRoomForFluid) {
    const std::string block = R"(solids=[{"shape":"block","min":[0.3,0.1,0],"max":[0.4,0.34,1]})",
                      other = R"({"shape":"block","min":[0.8,0,0],"max":[1,0.6,1]})";
    for (const std::string& solids : {block + "]", block + "," + other + "]"}) {
        const Scene scene =
            cubeWith({"simulation.dimensions=2", "simulation.spacing=0.02", "fluid.sound_speed=30",
                      R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,1]}])", solids});
        auto simulation = makeSimulation(scene);
        simulation->hold({0, {1.2f, 0.22f, 0.5f}});
        double fastest = 0, squeezed = 0;
        for (int k = 1; k <= 60; ++k) {
            runUntil(*simulation, 0.01 * k);
            const Measurement m = simulation->measure();
            fastest = std::max(fastest, m.maxSpeed);
            squeezed = std::max(squeezed, m.maxDensityError);
        }
        EXPECT_LT(fastest, 10) << solids;
        EXPECT_LT(squeezed, 0.15) << solids;
        const double wall = scene.solids.size() > 1 ? 0.8 : 1;
        EXPECT_NEAR(simulation->measure().solids[0].position.x, wall - 0.07, 0.03) << solids;
    }
}

// A beach that reaches through the walls is lifted, but not through the water on it, and comes back
// as far as that lets it.
TEST(Floating, DraggedPlanesDoNotCrushFluid) {
    const Scene scene =
        cubeWith({"simulation.dimensions=2", "simulation.spacing=0.02", "fluid.sound_speed=30",
                  R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,1]}])",
                  R"(solids=[{"shape":"plane","center":[0.5,0,0.5],"normal":[-0.4,1,0]}])"});
    auto simulation = makeSimulation(scene);
    double squeezed = 0, time = 0, highest = 0;
    for (const float height : {1.2f, 0.0f}) {
        simulation->hold({0, {0.5f, height, 0.5f}});
        for (int k = 0; k < 50; ++k) {
            runUntil(*simulation, time += 0.01);
            const Measurement m = simulation->measure();
            squeezed = std::max(squeezed, m.maxDensityError);
            highest = std::max(highest, m.solids[0].position.y);
        }
    }
    EXPECT_GT(highest, 0.2) << "it was lifted";
    EXPECT_LT(squeezed, 0.3);
    EXPECT_NEAR(simulation->measure().solids[0].position.y, 0, 0.05) << "it came down again";
}

// A cylinder that is thrown into a box of fluid at rest gives its momentum to both, the fluid's
// share by its added mass (Lamb 1932; 1.07 in this box). A tenth to ten times as dense.
TEST(Floating, WhatIsThrownTakesItsAddedMassAlong) {
    for (const char* formulation : {"delta_sph", "delta_plus"})
        for (double ratio : {0.1, 0.3, 1.0, 3.0, 10.0}) {
            Scene scene = sceneOf(
                {std::string("simulation.formulation=") + formulation, "simulation.dimensions=2",
                 "simulation.gravity=0,0,0", "simulation.spacing=0.02", "time.mode=cfl",
                 "domain.max=1,1,1", "fluid.sound_speed=40", "fluid.artificial_viscosity=0",
                 R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,1,1]}])",
                 R"(solids=[{"shape":"sphere","center":[0.5,0.5,0.5],"radius":0.1,)"
                 R"("velocity":[0,0.1,0],"density":)" +
                     std::to_string(1000 * ratio) + "}]"});
            auto simulation = makeSimulation(scene);
            double speed = 0;
            constexpr int First = 20,
                          Last = 40;  // 5 ms each; a mean over what is left of the sound
            for (int k = 1; k <= Last; ++k) {
                simulation->stopAt(0.005 * k);
                while (simulation->clock().time < 0.005 * k) simulation->step();
                if (k > First) speed += simulation->measure().solids[0].velocity.y / (Last - First);
            }
            EXPECT_NEAR(speed / (0.1 * ratio / (ratio + 1.071)), 1, 0.07)
                << formulation << " " << ratio;
        }
}

// A plate that the mouse takes from its keyframes stays where it is left, also in a run that goes
// on; one that turns on and on turns there.
TEST(Floating, WhatIsDraggedLeavesItsKeyframes) {
    for (const char* motion : {R"("keyframes":[[0,0,0,0],[1,0.5,0,0]])", R"("spin":360)"}) {
        const Scene scene = sceneOf(
            {std::string(R"(solids=[{"shape":"block","min":[0.1,0.4,0.4],"max":[0.2,0.6,0.6],)") +
             motion + "}]"});
        auto simulation = makeSimulation(scene);
        runUntil(*simulation, 0.1);
        simulation->hold({0, {0.4f, 0.5f, 0.5f}});
        runUntil(*simulation, 0.5);
        simulation->hold({});
        runUntil(*simulation, 0.6);
        auto goesOn = makeSimulation(scene, simulation->state());
        runUntil(*simulation, 0.9);
        runUntil(*goesOn, 0.9);
        for (Simulation* s : {simulation.get(), goesOn.get()}) {
            const SolidMeasurement solid = s->measure().solids[0];
            EXPECT_NEAR(solid.position.x, 0.4, 0.01) << motion;
            EXPECT_EQ(length(solid.velocity), 0) << motion;
            EXPECT_EQ(length(solid.spin) > 0,
                      std::string(motion).find("spin") != std::string::npos);
        }
    }
}

TEST(Floating, MassesAreThoseOfTheShapes) {
    auto massOfSolid = [](const std::string& solid, int dimensions = 3) {
        Scene scene = sceneOf(
            {"solids=[" + solid + "]", "simulation.dimensions=" + std::to_string(dimensions)});
        return massOf(scene, scene.solids[0]);
    };
    Mass m = massOfSolid(R"({"shape":"block","min":[0,0,0],"max":[1,2,3],"density":10})");
    EXPECT_NEAR(m.mass, 60, 1e-9);
    EXPECT_NEAR(m.inertia[0].x, 60.0 / 12 * (4 + 9), 1e-9);
    EXPECT_NEAR(m.inertia[2].z, 60.0 / 12 * (1 + 4), 1e-9);
    m = massOfSolid(R"({"shape":"sphere","radius":0.5,"density":10})");
    EXPECT_NEAR(m.mass, 10 * std::numbers::pi / 6, 1e-6);
    EXPECT_NEAR(m.inertia[1].y, 0.4 * m.mass * 0.25, 1e-6);
    m = massOfSolid(R"({"shape":"cylinder","axis":"x","radius":0.5,"height":2,"density":10})");
    EXPECT_NEAR(m.inertia[0].x, 0.5 * m.mass * 0.25, 1e-6);
    EXPECT_NEAR(m.inertia[1].y, m.mass * (3 * 0.25 + 4) / 12, 1e-6);
    // A wedge by adding up small blocks.
    m = massOfSolid(R"({"shape":"wedge","min":[0,0,0],"max":[2,1,3],"density":1})");
    double mass = 0, moment = 0, xx = 0, yy = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = 2.0 * (i + 0.5) / n - 1, y = (j + 0.5) / n;
            if (y > 1 - std::abs(x)) continue;
            const double part = 2.0 / n * 1.0 / n * 3;
            mass += part, moment += part * y, xx += part * x * x, yy += part * y * y;
        }
    EXPECT_NEAR(m.mass, mass, 0.01);
    EXPECT_NEAR(0.5 + m.centre.y, moment / mass, 0.003);
    EXPECT_NEAR(m.inertia[2].z, xx + yy - moment * moment / mass, 0.005);
    m = massOfSolid(R"({"shape":"sphere","radius":0.5,"density":1000})", 2);
    EXPECT_NEAR(m.mass, 1000 * std::numbers::pi * 0.25, 1e-3);  // of a metre of depth
    EXPECT_NEAR(m.inertia[2].z, 0.5 * m.mass * 0.25, 1e-4);
}

}  // namespace
}  // namespace spindrift
