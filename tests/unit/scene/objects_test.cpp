// Elastic objects as particles and bonds: how many, how heavy, how stiff, and what is refused.
#include "core/error.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "scene/sample_object.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>

namespace spindrift {
namespace {

Scene sceneOf(const std::string& objects, const std::vector<std::string>& more = {}) {
    Scene scene;
    scene.domain.max = {1, 1, 1};
    scene.simulation.spacing = 0.05f;
    setKnob(scene, "fluid.bodies=[{\"shape\":\"block\",\"min\":[0,0,0],\"max\":[1,0.5,1]}]");
    setKnob(scene, "objects=" + objects);
    for (const std::string& knob : more) setKnob(scene, knob);
    return scene;
}

double massOf(const ObjectSample& s) {
    return std::accumulate(s.masses.begin(), s.masses.end(), 0.0);
}

// What a small homogeneous strain stores in the bonds, J.
double energyOf(const ObjectSample& s, const std::function<Vec3d(Vec3d)>& displacement) {
    double energy = 0;
    for (const Bond& b : s.bonds) {
        const Vec3d p = toDouble(s.positions[size_t(b.a)]), q = toDouble(s.positions[size_t(b.b)]);
        const double along =
            dot(displacement(q) - displacement(p), q - p) / double(b.length);  // for small ones
        energy += 0.5 * double(b.stiffness) * along * along;
    }
    return energy;
}

TEST(ObjectSampling, HasTheMassOfTheMaterial) {
    EXPECT_NEAR(
        massOf(sampleObjects(sceneOf(
            R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.5,0.8,0.4],"density":500}])"))),
        500 * 0.4 * 0.2 * 0.3, 1e-3);
    EXPECT_NEAR(massOf(sampleObjects(sceneOf(
                    R"([{"shape":"sheet","min":[0.1,0.6,0.1],"max":[0.5,0.6,0.4],"thickness":0.01,)"
                    R"("density":500}])"))),
                500 * 0.4 * 0.01 * 0.3, 1e-5);
    const double ring = 2 * 3.14159265 * 0.2 * 0.01 * 0.6;
    EXPECT_NEAR(massOf(sampleObjects(
                    sceneOf(R"([{"shape":"tube","center":[0.5,0.5,0.5],"radius":0.2,"height":0.6,)"
                            R"("thickness":0.01,"density":500}])"))) /
                    (500 * ring),
                1, 0.02);
    EXPECT_NEAR(massOf(sampleObjects(sceneOf(
                    R"([{"shape":"block","min":[0.1,0.6,0],"max":[0.5,0.8,0],"density":500}])",
                    {"simulation.dimensions=2"}))),
                500 * 0.4 * 0.2, 1e-3);
}

TEST(ObjectSampling, IsAsStiffAsTheMaterial) {
    const double E = 1e5, e = 1e-4;
    const ObjectSample block = sampleObjects(sceneOf(
        R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.5,0.8,0.4],"youngs_modulus":1e5}])"));
    // Poisson's ratio 1/4: C11 = 1.2 E, C44 = 0.4 E; the same whichever way it is turned.
    const double volume = 0.4 * 0.2 * 0.3;
    EXPECT_NEAR(energyOf(block,
                         [&](Vec3d x) {
                             return Vec3d{e * x.x, 0, 0};
                         }) /
                    (0.5 * 1.2 * E * e * e * volume),
                1, 1e-3);
    EXPECT_NEAR(energyOf(block,
                         [&](Vec3d x) {
                             return Vec3d{e * x.y, 0, 0};
                         }) /
                    (0.5 * 0.4 * E * e * e * volume),
                1, 1e-3);
    const double c = std::cos(0.5), s = std::sin(0.5);
    EXPECT_NEAR(energyOf(block,
                         [&](Vec3d x) {
                             return (e * (c * x.x + s * x.z)) * Vec3d{c, 0, s};
                         }) /
                    (0.5 * 1.2 * E * e * e * volume),
                1, 1e-3);
    // A layer, Poisson's ratio 1/3: C11 = 9/8 E, C44 = 3/8 E.
    const ObjectSample sheet = sampleObjects(
        sceneOf(R"([{"shape":"sheet","min":[0.1,0.6,0.1],"max":[0.5,0.6,0.4],"thickness":0.01,)"
                R"("youngs_modulus":1e5}])"));
    const double sheetVolume = 0.4 * 0.3 * 0.01;
    EXPECT_NEAR(energyOf(sheet,
                         [&](Vec3d x) {
                             return Vec3d{e * x.x, 0, 0};
                         }) /
                    (0.5 * 1.125 * E * e * e * sheetVolume),
                1, 1e-3);
    EXPECT_NEAR(energyOf(sheet,
                         [&](Vec3d x) {
                             return Vec3d{e * x.z, 0, 0};
                         }) /
                    (0.5 * 0.375 * E * e * e * sheetVolume),
                1, 1e-3);
}

// An octahedron, whose eight triangles are cut until they are as fine as the spacing.
TEST(ObjectSampling, ShellsAreNetsOfTriangles) {
    const std::string path = testing::TempDir() + "octahedron.obj";
    std::ofstream(path)
        << "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
           "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    const Scene scene =
        sceneOf(R"([{"shape":"shell","path":")" + path +
                R"(","scale":0.2,"offset":[0.5,0.75,0.5],"thickness":0.01,"density":500,)"
                R"("youngs_modulus":1e5}])");
    const ObjectSample s = sampleObjects(scene);
    EXPECT_EQ(s.size(), 66u);  // edges of 0.28 m, cut twice: 8 x 16 triangles
    EXPECT_EQ(s.bonds.size(), 192u);
    EXPECT_EQ(countObjectParticles(scene), 96);
    const double area = 8 * std::sqrt(3.0) / 4 * 2 * 0.2 * 0.2;
    EXPECT_NEAR(massOf(s), 500 * 0.01 * area, 1e-4);
    // Blown up evenly a layer stores E / (1 - nu) e^2 t A.
    const double e = 1e-3;
    EXPECT_NEAR(energyOf(s,
                         [&](Vec3d x) {
                             return e * (x - Vec3d{0.5, 0.75, 0.5});
                         }) /
                    (1e5 / (1 - 1.0 / 3) * e * e * 0.01 * area),
                1, 1e-3);
}

TEST(ObjectSampling, KnowsWhoIsHeldAndWhoIsAtTheSurface) {
    const ObjectSample s =
        sampleObjects(sceneOf(R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,0.8,0.3]}])",
                              {R"(grips=[{"min":[0,0,0],"max":[0.11,1,1]}])"}));
    EXPECT_EQ(s.size(), 125u);
    EXPECT_EQ(std::count(s.atSurface.begin(), s.atSurface.end(), 1), 125 - 27);
    EXPECT_EQ(std::count(s.grips.begin(), s.grips.end(), 0), 25);
    EXPECT_EQ(double(s.size()),
              countObjectParticles(
                  sceneOf(R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,0.8,0.3]}])")));
}

TEST(ObjectSampling, FluidBeginsOutside) {
    const Scene scene =
        sceneOf(R"([{"shape":"block","min":[0.3,0.1,0.3],"max":[0.6,0.4,0.6],"spacing":0.04}])");
    const ObjectSample objects = sampleObjects(scene);
    const Placement placed = placeParticles(scene);
    EXPECT_GT(placed.positions.size(), 3000u);
    for (const Vec3& p : placed.positions)
        for (const Vec3& q : objects.positions)
            ASSERT_GT(length(p - q), 0.97f * 1.5f * (0.025f + 0.02f));
}

TEST(ObjectChecks, SayWhatIsWrong) {
    auto refusal = [](const std::string& objects,
                      const std::vector<std::string>& more = {}) -> std::string {
        try {
            checkScene(sceneOf(objects, more), "a.json");
        } catch (const Error& error) { return error.what(); }
        return "";
    };
    const std::string block = R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,0.8,0.3]}])";
    EXPECT_EQ(refusal(block), "");
    EXPECT_NE(refusal(R"([{"shape":"sheet","min":[0.1,0.6,0.1],"max":[0.3,0.8,0.3]}])")
                  .find("flat along one axis"),
              std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,1.8,0.3]}])")
                  .find("out of the domain"),
              std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,0.61,0.3]}])")
                  .find("thicken it"),
              std::string::npos);
    EXPECT_NE(
        refusal(R"([{"shape":"block","min":[0.1,0.1,0.1],"max":[0.9,0.9,0.9],"spacing":0.7}])")
            .find("support radii"),
        std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"tube","radius":0.1,"thickness":0.3}])").find("no room"),
              std::string::npos);
    const std::string ball =
        R"(solids=[{"shape":"sphere","center":[0.3,0.75,0.3],"radius":0.1,"density":500}])";
    EXPECT_NE(refusal(R"([{"shape":"block","min":[0.1,0.6,0.1],"max":[0.3,0.8,0.3]}])", {ball})
                  .find("begins inside solids[0]"),
              std::string::npos);
    EXPECT_EQ(refusal(R"([{"shape":"block","min":[0.5,0.6,0.1],"max":[0.7,0.8,0.3]}])", {ball}),
              "");
    EXPECT_NE(refusal("[]", {R"(cuts=[{"time":1}])"}).find("no objects to cut"), std::string::npos);
    EXPECT_NE(refusal("[]", {R"(grips=[{"min":[0,0,0]}])"}).find("no objects to hold"),
              std::string::npos);
    EXPECT_NE(
        refusal(
            block,
            {R"(grips=[{"min":[0,0,0],"max":[1,1,1],"velocity":[1,0,0],"keyframes":[[0,0,0,0]]}])"})
            .find("leave velocity out"),
        std::string::npos);
    EXPECT_NE(refusal(block, {"time.mode=local"}).find("time.mode"), std::string::npos);
    EXPECT_NE(refusal(block, {"time.integrator=velocity_verlet"}).find("symplectic_euler"),
              std::string::npos);
}

}  // namespace
}  // namespace spindrift
