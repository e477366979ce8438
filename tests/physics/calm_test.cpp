// Fluid that is to be at rest begins at rest, whatever solid it lies against: nobody is pushed off
// a slope that the lattice doesn't fit to.
#include "measure/poured.h"
#include "meshes.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

constexpr double Depth = 0.4, G = 9.81;  // m, m/s²

// Water 0.4 m deep in a tank, in three dimensions 0.2 m across, with a solid in it.
Scene tank(int dimensions, double width, const std::string& formulation, const std::string& solid) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.compute.threads = 1;
    setKnob(scene, "simulation.formulation=" + formulation);
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = dimensions == 2 ? 0.02f : 0.04f;
    scene.domain.max = {float(width), 0.8f, 0.2f};
    scene.fluid.bodies = {Body{{.max{float(width), float(Depth), 0.2f}}}};
    if (!solid.empty()) setKnob(scene, "solids=[" + solid + "]");
    return scene;
}

// The fastest that anybody is in the first 0.3 s, m/s.
double fastest(const Scene& scene) {
    auto simulation = makeSimulation(scene);
    EXPECT_TRUE(pouredAmiss(scene, *simulation).empty());
    double most = 0;
    while (simulation->clock().time < 0.3) {
        simulation->step(10);
        most = std::max(most, simulation->measure().maxSpeed);
    }
    return most;
}

// Water that is let go settles at 0.09 sqrt(g H) in an empty tank, and who has room below falls by
// half a spacing.
void expectCalm(const Scene& scene, const std::string& what) {
    const double allowed =
        0.09 * std::sqrt(G * Depth) + std::sqrt(G * double(scene.simulation.spacing));
    const double most = fastest(scene);
    std::printf("%s: %.2f m/s of %.2f\n", what.c_str(), most, allowed);
    EXPECT_LT(most, allowed) << what;
}

// A slope from the floor of a tank 0.6 m wide up out of the water.
std::string slope(double degrees) {
    const double half = 0.8 / std::tan(degrees * std::numbers::pi / 180);
    return fmt::format(R"({{"shape":"wedge","min":[0.6,0,0],"max":[{},0.8,0.2]}})", 0.6 + 2 * half);
}
double widthFor(double degrees) { return 0.7 + Depth / std::tan(degrees * std::numbers::pi / 180); }
std::string ball(double y) {
    return fmt::format(R"({{"shape":"sphere","center":[0.41,{},0.11],"radius":0.08}})", y);
}

TEST(Calm, BesideSlopesOfAnyAngle) {
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (double angle = 10; angle <= 80; angle += 7)
            expectCalm(tank(2, widthFor(angle), formulation, slope(angle)),
                       fmt::format("{}, {} degrees", formulation, angle));
}

TEST(Calm, AroundSolidsThatNoLatticeFits) {
    const std::string
        wedge = R"({"shape":"wedge","min":[0.211,0,0],"max":[0.607,0.252,0.2]})",
        raft = R"({"shape":"block","min":[0.311,0.133,0],"max":[0.507,0.252,0.2],"density":1000})";
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (const std::string& solid : {wedge, raft, ball(0.2), ball(0.4)})
            expectCalm(tank(2, 0.8, formulation, solid), formulation + " " + solid);
}

// A wedge as a mesh, from whose floor its slopes rise by some degrees.
std::string meshSlope(double degrees) {
    const double half = 0.8 / std::tan(degrees * std::numbers::pi / 180), x = 0.6 + half;
    const Surface wedge{{{0.6, 0, 0},
                         {0.6 + 2 * half, 0, 0},
                         {x, 0.8, 0},
                         {0.6, 0, 0.2},
                         {0.6 + 2 * half, 0, 0.2},
                         {x, 0.8, 0.2}},
                        {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
    return R"({"shape":"mesh","path":")" + wedge.write(testing::TempDir() + "/calm_slope.obj") +
           "\"}";
}

TEST(Calm, InThreeDimensions) {
    for (const double angle : {30.0, 55.0})
        for (const std::string& solid : {slope(angle), meshSlope(angle)})
            expectCalm(tank(3, widthFor(angle), "wcsph", solid), solid);
    for (const std::string& solid : {ball(0.08), ball(0.2)})
        expectCalm(tank(3, 0.8, "wcsph", solid), solid);
}

}  // namespace
}  // namespace spindrift
