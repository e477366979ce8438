// Solids that begin turned: fluid, boundary particles and motion are where the turned shape is.
#include "core/error.h"
#include "physics/cube.h"
#include "scene/check.h"
#include "scene/convex.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

constexpr const char* Shapes[] = {
    R"({"shape":"block","min":[0.3,0.35,0.4],"max":[0.7,0.55,0.6])",
    R"({"shape":"block","min":[0.3,0.48,0.3],"max":[0.7,0.5,0.7])",
    R"({"shape":"wedge","min":[0.3,0.35,0.4],"max":[0.7,0.55,0.6])",
    R"({"shape":"sphere","center":[0.5,0.45,0.5],"radius":0.2)",
    R"({"shape":"cylinder","center":[0.5,0.45,0.5],"radius":0.15,"height":0.4,"axis":"x")",
    R"({"shape":"mesh","path":")" SPINDRIFT_SOURCE_DIR
    R"(/configs/bowl.obj","offset":[0.5,0.5,0.5])"};

Scene turnedIn(const std::string& shape, const std::string& axis, double degrees) {
    Scene scene = cubeWith({R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.8,1]}])",
                            "solids=[" + shape + R"(,"spin_axis":")" + axis + R"(","turn":)" +
                                std::to_string(degrees) + "}]"});
    if (scene.solids[0].shape == Shape::Mesh) scene.solids[0].scale = 0.5f;
    return scene;
}

Vec3d placeOf(const Vertex& v, const Scene& scene) {
    return Vec3d{v.x, v.y, v.z} + toDouble(scene.domain.min);
}

TEST(TurnedSolids, FluidAndBoundaryParticlesAreWhereTheShapeIs) {
    for (const char* shape : Shapes)
        for (const char* axis : {"x", "y", "z"})
            for (const double degrees : {30.0, 200.0}) {
                SCOPED_TRACE(testing::Message() << shape << " " << axis << " " << degrees);
                const Scene scene = turnedIn(shape, axis, degrees);
                EXPECT_NO_THROW(checkScene(scene));
                const Convex convex = convexOf(scene.solids[0], 3);
                const double angle = degrees * std::numbers::pi / 180;
                const int k = int(scene.solids[0].spinAxis), y = (k + 1) % 3, z = (k + 2) % 3;
                Vec3d p{0.1, 0.2, 0.3}, turned = p;
                turned[y] = std::cos(angle) * p[y] - std::sin(angle) * p[z];
                turned[z] = std::sin(angle) * p[y] + std::cos(angle) * p[z];
                EXPECT_LT(length(convex.turned(convex.middle + p) - convex.middle - turned), 1e-7);
                const bool thin = std::string(shape).find("0.48") != std::string::npos,
                           isMesh = scene.solids[0].shape == Shape::Mesh;  // distances on a grid
                auto simulation = makeSimulation(scene);
                std::vector<Vertex> at(
                    size_t(simulation->fluidCount() + simulation->solidParticleCount()));
                for (const int steps : {0, 5}) {
                    simulation->step(steps);
                    simulation->writeVertices({at.data()}, ColorBy::Plain,
                                              simulation->solidParticleCount());
                    double nearest = 1;
                    for (int i = 0; i < simulation->fluidCount(); ++i) {
                        const double away =
                            convex.nearestInSpace(placeOf(at[size_t(i)], scene)).distance;
                        ASSERT_GT(away, -1e-5) << i << " after " << steps;
                        nearest = std::min(nearest, away);
                    }
                    EXPECT_LT(nearest, 0.05) << "fluid begins beside it";
                    for (size_t i = size_t(simulation->fluidCount()); i < at.size(); ++i)
                        ASSERT_LT(convex.nearestInSpace(placeOf(at[i], scene)).distance, thin ? 1e-5
                                                                                         : isMesh
                                                                                             ? 5e-4
                                                                                             : 0)
                            << i << " after " << steps;
                }
                for (int axisOf = 0; axisOf < 3; ++axisOf)
                    EXPECT_LT(
                        length(simulation->solidPoses()[0].axis[axisOf] - convex.axis[axisOf]),
                        1e-6);
            }
}

// A quarter of a turn makes of a block the one that is drawn with its sides exchanged: what is left
// for fluid is the same, and so is what presses on it.
TEST(TurnedSolids, AQuarterTurnIsTheBlockDrawnSo) {
    for (const char* formulation : {"wcsph", "delta_sph", "incompressible"}) {
        SCOPED_TRACE(formulation);
        const std::string fluid = R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.8,1],)"
                                  R"("pressure":"hydrostatic"}])",
                          method = std::string("simulation.formulation=") + formulation;
        const auto lift = [&](const char* solid) {
            auto simulation = makeSimulation(cubeWith({method, fluid, solid}));
            double sum = 0;
            for (int k = 0; k < 100; ++k) {
                simulation->step(2);
                sum += simulation->measure().solids[0].pressureForce.y / 100;
            }
            return std::pair(sum, simulation->fluidCount());
        };
        const auto drawn =
            lift(R"(solids=[{"shape":"block","min":[0.4,0.2,0.3],"max":[0.6,0.6,0.7]}])");
        const auto turned =
            lift(R"(solids=[{"shape":"block","min":[0.3,0.3,0.3],"max":[0.7,0.5,0.7],"turn":90}])");
        EXPECT_NEAR(turned.second, drawn.second, 0.02 * drawn.second);
        EXPECT_NEAR(turned.first, drawn.first, 0.1 * 9810 * 0.2 * 0.4 * 0.4);
    }
}

TEST(TurnedSolids, MotionGoesOnFromThere) {
    // Keyframes turn it on; so does a spin; what floats begins so.
    for (const char* motion : {R"("keyframes":[[0,0,0,0,0],[1,0,0,0,90]])", R"("spin":90)",
                               R"("spin":90,"density":500)"}) {
        SCOPED_TRACE(motion);
        Scene scene = dryCubeWith(
            {std::string("simulation.gravity=0,0,0"),
             R"(solids=[{"shape":"block","min":[0.4,0.4,0.4],"max":[0.7,0.6,0.6],"turn":40,)" +
                 std::string(motion) + "}]"});
        auto simulation = makeSimulation(scene);
        const auto angle = [&] {
            const Vec3d x = simulation->solidPoses()[0].axis[0];
            return std::atan2(x.y, x.x) * 180 / std::numbers::pi;
        };
        EXPECT_NEAR(angle(), 40, 1e-3);
        simulation->stopAt(0.2);
        while (simulation->clock().time < 0.2) simulation->step();
        EXPECT_NEAR(angle(), 58, 0.1);
    }
}

TEST(TurnedSolids, APlaneIsTurnedByItsNormal) {
    Scene scene = cubeWith({R"(solids=[{"shape":"plane","center":[0,0.1,0],"normal":[0,1,0]}])"});
    scene.solids[0].turn = 10;
    try {
        checkScene(scene);
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("solids[0].turn: a plane is turned by its normal"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace spindrift
