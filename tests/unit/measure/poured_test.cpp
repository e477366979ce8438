// What a mesh was filled with, against its volume.
#include "measure/poured.h"

#include "meshes.h"
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace spindrift {
namespace {

std::vector<Poured> pouredIn(const std::string& path, const std::string& more) {
    Scene scene;
    scene.simulation.spacing = 0.1f;
    scene.domain.max = {2, 2, 2};
    scene.compute.threads = 1;
    setKnob(scene, fmt::format(R"(fluid.bodies=[{{"shape":"mesh","path":"{}","scale":2,)"
                               R"("rest_density":800}},{{"max":[0.2,0.2,0.2]}}])",
                               path));
    setKnob(scene, more);
    return pouredIntoMeshes(scene, makeSimulation(scene)->particles());
}

TEST(Poured, IsWhatTheLatticeHoldsOfTheMesh) {
    const std::string box = boxSurface({0.25, 0.25, 0.25}, {0.75, 0.5, 0.75})
                                .write(::testing::TempDir() + "poured.obj");
    const auto whole = pouredIn(box, "name=whole");
    ASSERT_EQ(whole.size(), 1u) << "one body is a mesh";
    EXPECT_EQ(whole[0].body, 0u);
    EXPECT_NEAR(whole[0].volume, 0.5, 1e-9);
    EXPECT_NEAR(whole[0].wanted, 400, 1e-3);
    EXPECT_NEAR(whole[0].mass, 400, 1e-3) << "the box is whole spacings wide";
    const auto half = pouredIn(box, R"(solids=[{"min":[0.5,0,0.5],"max":[1.5,0.75,1.5]}])");
    EXPECT_NEAR(half[0].wanted, 400, 1e-3);
    EXPECT_NEAR(half[0].mass, 200, 45) << "an obstacle takes half of it";
}

std::vector<std::string> amissIn(const std::string& bodies) {
    Scene scene;
    scene.simulation.spacing = 0.1f;
    scene.domain.max = {1, 2, 1};
    scene.compute.threads = 1;
    setKnob(scene, "fluid.bodies=" + bodies);
    return pouredAmiss(scene, *makeSimulation(scene));
}

TEST(Poured, TellsWhichFluidHasMoreOrLessThanItsBodiesHold) {
    EXPECT_TRUE(amissIn(R"([{"max":[1,1.04,0.97]}])").empty()) << "layers fit";
    const auto round = amissIn(R"([{"shape":"sphere","center":[0.5,1,0.5],"radius":0.32}])");
    ASSERT_EQ(round.size(), 1u);
    EXPECT_NE(round[0].find("than its body holds"), std::string::npos) << round[0];
    // Layers of the one are as high as those of the other.
    const auto two = amissIn(R"([{"max":[1,0.237,1]},)"
                             R"({"min":[0,0.237,0],"max":[1,2,1],"rest_density":500}])");
    ASSERT_GE(two.size(), 1u);
    EXPECT_NE(two[0].find("than fluid.bodies[0] holds"), std::string::npos) << two[0];
}

}  // namespace
}  // namespace spindrift
