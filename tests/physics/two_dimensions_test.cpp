// What is measured in two dimensions is per metre of depth: it does not depend on the spacing.
#include "core/error.h"
#include "measure/probes.h"
#include "physics/cube.h"
#include "scene/json.h"
#include "scene/mass.h"
#include "scene/particles.h"
#include "scene/sample_object.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>

namespace spindrift {
namespace {

constexpr double Rho = 1000, G = 9.81;

Scene flat(float spacing, std::vector<std::string> more) {
    more.insert(more.begin(), {"simulation.dimensions=2", "simulation.formulation=delta_sph"});
    Scene scene = cubeWith(more);
    scene.simulation.spacing = spacing;
    return scene;
}

// All that is so from the start: masses, energies and momenta are exact at any spacing.
TEST(TwoDimensions, MassesEnergiesAndMomentaAreThoseOfAMetreOfDepth) {
    for (const float spacing : {0.04f, 0.02f, 0.01f}) {
        const Scene scene =
            flat(spacing, {R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.4,1],)"
                           R"("velocity":[3,0,0]}])",
                           R"(solids=[{"shape":"block","min":[0.6,0.4,0],"max":[0.8,0.8,1],)"
                           R"("density":500,"spin":30},{"shape":"sphere","center":[0.7,0.2,0.5],)"
                           R"("radius":0.1,"density":500}])",
                           R"(objects=[{"min":[0.2,0.6,0],"max":[0.4,0.7,1],"density":800}])"});
        const auto simulation = makeSimulation(scene);
        const Measurement m = simulation->measure();
        const double mass = Rho * 0.4 * 0.4;  // kg/m
        EXPECT_EQ(m.dimensions, 2);
        EXPECT_NEAR(particleMass(scene) * simulation->fluidCount() / mass, 1, 1e-6);
        EXPECT_NEAR(m.kineticEnergy / (mass * 9 / 2), 1, 1e-5);
        EXPECT_NEAR(m.potentialEnergy / (mass * G * 0.2), 1, 1e-5);
        EXPECT_NEAR(m.momentum.x / (mass * 3), 1, 1e-5);
        const Mass box = massOf(scene, scene.solids[0]), disc = massOf(scene, scene.solids[1]);
        EXPECT_NEAR(box.mass, 500 * 0.2 * 0.4, 1e-4);
        EXPECT_NEAR(box.inertia[2].z / (box.mass * (0.04 + 0.16) / 12), 1, 1e-6);
        EXPECT_NEAR(disc.mass / (500 * std::numbers::pi * 0.01), 1, 1e-6);
        EXPECT_NEAR(simulation->state().solids[0].angularMomentum.z,
                    box.inertia[2].z * 30 * std::numbers::pi / 180, 1e-4);
        const ObjectSample objects = sampleObjects(scene);
        EXPECT_NEAR(std::accumulate(objects.masses.begin(), objects.masses.end(), 0.0),
                    800 * 0.2 * 0.1, 1e-3);
    }
}

// A tank's end wall bears rho g H^2 / 2 a metre of it, at a third of the height.
struct Wall {
    double force, torque;
};
Wall wallOf(float spacing) {
    const Scene scene =
        flat(spacing, {"domain.max=0.6,0.6,0.1", "fluid.artificial_viscosity=0.2",
                       R"(solids=[{"shape":"block","min":[0.4,0,0],"max":[0.6,0.6,0.1]}])",
                       R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.4,0.1],)"
                       R"("pressure":"hydrostatic"}])"});
    const auto simulation = makeSimulation(scene);
    while (simulation->clock().time < 0.3) simulation->step(50);
    Wall mean{0, 0};
    constexpr int Looks = 40;  // a mean over what is left of the sound
    for (int k = 0; k < Looks; ++k) {
        simulation->step(10);
        const SolidMeasurement wall = simulation->measure().solids[0];
        mean.force += wall.pressureForce.x / Looks, mean.torque += wall.torque.z / Looks;
    }
    return mean;
}

TEST(TwoDimensions, ForcesAndTorquesDoNotDependOnTheSpacing) {
    const double H = 0.4, force = Rho * G * H * H / 2, torque = force * (0.3 - H / 3);  // N/m, N
    double before = 0.04;  // what is missing of the force, half as much with half the spacing
    for (const float spacing : {0.02f, 0.01f}) {
        const Wall wall = wallOf(spacing);
        const double missing = 1 - wall.force / force;
        std::printf("spacing %.3f m: %.1f N/m of %.1f, %.2f N m/m of %.2f\n", double(spacing),
                    wall.force, force, wall.torque, torque);
        EXPECT_LT(std::abs(missing), before);
        EXPECT_NEAR(wall.torque / torque, 1, 0.05);
        before = std::abs(missing);
    }
}

// What fluid loses a solid that floats gains: both are of the same depth.
TEST(TwoDimensions, FluidAndWhatFloatsKeepTheirMomentumTogether) {
    for (const float spacing : {0.04f, 0.02f}) {
        const Scene scene = flat(
            spacing, {"simulation.gravity=0,0,0",
                      R"(solids=[{"shape":"block","min":[0.5,0.4,0],"max":[0.6,0.6,1],)"
                      R"("density":700}])",
                      R"(fluid.bodies=[{"shape":"block","min":[0.28,0.44,0],"max":[0.48,0.6,1],)"
                      R"("velocity":[2,0.5,0]}])"});
        const auto simulation = makeSimulation(scene);
        const auto momentum = [&] {
            const Measurement m = simulation->measure();
            return m.momentum + (700 * 0.1 * 0.2) * m.solids[0].velocity;
        };
        const Vec3d before = momentum();
        simulation->step(200);
        EXPECT_GT(simulation->measure().solids[0].velocity.x, 0.5) << "it was hit";
        EXPECT_LT(length(momentum() - before) / length(before), 1e-5) << spacing;
    }
}

}  // namespace
}  // namespace spindrift
