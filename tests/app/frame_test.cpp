// What colours mean, without a picture.
#include "app/frame.h"
#include "app/scene_choice.h"
#include "app/solid_shapes.h"
#include "scene/convex.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace spindrift {
namespace {

TEST(RunRange, HoldsAllButTheMostExtremeMoments) {
    RunRange range;
    for (int i = 0; i < 3; ++i) range.add(0.5 + i, {float(-i), float(i)});
    EXPECT_EQ(range.range().min, -2);
    EXPECT_EQ(range.range().max, 2);
    EXPECT_EQ(range.since(), 0.5);
    for (int i = 0; i < 20000; ++i) range.add(10 + i, {0, i == 7 ? 1000.0f : 10});  // a splash
    EXPECT_EQ(range.range().max, 10);
    EXPECT_EQ(range.range().min, 0);
}

TEST(RunRange, ReachesWhatLasts) {
    RunRange range;
    for (int i = 0; i < 5000; ++i) range.add(i, {0, i < 4000 ? 1.0f : 5.0f});
    EXPECT_EQ(range.range().max, 5);
}

TEST(Fluids, AreNamedAndToldApart) {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/oil_and_water.json");
    const std::vector<Swatch> fluids = fluidsOf(scene);
    ASSERT_EQ(fluids.size(), 2u);
    EXPECT_EQ(fluids[0].name, "oil, 700 kg/m³");
    EXPECT_EQ(fluids[1].name, "water, 1000 kg/m³");
    scene.fluid.bodies[0].name = "kerosene";
    scene.fluid.bodies.push_back(scene.fluid.bodies[0]);
    scene.fluid.bodies.back().restDensity = 800, scene.fluid.bodies.back().name = "";
    const std::vector<Swatch> more = fluidsOf(scene);
    ASSERT_EQ(more.size(), 3u);
    EXPECT_EQ(more[0].name, "kerosene, 700 kg/m³");
    for (size_t i = 1; i < more.size(); ++i) EXPECT_NE(more[i].color, more[i - 1].color);
}

// Outward triangles without a gap: by the divergence theorem their integral of x.n / 3 is the
// volume.
double volumeOf(const SolidShape& shape) {
    double sum = 0;
    for (size_t i = 0; i + 2 < shape.corners.size(); i += 3) {
        const Vec3d a = toDouble(shape.corners[i].position),
                    b = toDouble(shape.corners[i + 1].position),
                    c = toDouble(shape.corners[i + 2].position);
        const Vec3d twice = cross(b - a, c - a), n = toDouble(shape.corners[i].normal);
        sum += (dot(twice, n) > 0 ? 1 : -1) * dot(a, twice) / 6;
    }
    return sum;
}

TEST(SolidShapes, HaveTheVolumeOfTheirSolids) {
    struct Case {
        std::string json;
        double volume;
        int dimensions = 3;
    };
    const double pi = 3.14159265358979;
    const std::string block = R"([{"shape":"block","min":[0.1,0.2,0.3],"max":[0.4,0.6,0.5]}])",
                      wedge = R"([{"shape":"wedge","min":[0.1,0.2,0.3],"max":[0.5,0.6,0.5]}])",
                      plane = R"([{"shape":"plane","center":[0.8,0.45,0.3],"normal":)";
    const std::vector<Case> solids = {
        {block, 0.3 * 0.4 * 0.2},
        {block, 0.3 * 0.4 * 0.6, 2},  // as deep as the domain
        {wedge, 0.5 * 0.4 * 0.4 * 0.2},
        {wedge, 0.5 * 0.4 * 0.4 * 0.6, 2},
        {plane + "[0,1,0]}]", 0.5 * 1.6 * 0.9 * 0.6},  // half of the domain
        {plane + "[-0.3,1,0.1]}]", 0.5 * 1.6 * 0.9 * 0.6},
        {plane + "[-0.3,1,0]}]", 0.5 * 1.6 * 0.9 * 0.6, 2},
        {R"([{"shape":"sphere","center":[0.5,0.4,0.3],"radius":0.2}])", 4 * pi / 3 * 0.008},
        {R"([{"shape":"cylinder","center":[0.5,0.4,0.3],"radius":0.2,"height":0.3,"axis":"x"}])",
         pi * 0.04 * 0.3},
        {R"([{"shape":"cylinder","center":[0.5,0.4,0.3],"radius":0.2,"height":0.3,"axis":"z"}])",
         pi * 0.04 * 0.3},
    };
    for (const auto& [json, volume, dimensions] : solids) {
        SCOPED_TRACE(json + std::to_string(dimensions));
        Scene scene;
        scene.simulation.dimensions = dimensions;
        setKnob(scene, "solids=" + json);
        const SolidShape shape = shapeOf(scene, scene.solids[0]);
        EXPECT_NEAR(volumeOf(shape) / volume, 1, 0.01);
        EXPECT_FALSE(shape.corners.empty());
    }
}

TEST(SolidShapes, HaveNoTwoFacesInOnePlace) {
    Scene scene;
    setKnob(scene, R"(solids=[{"shape":"plane","center":[0,0,0],"normal":[0,1,0]}])");
    EXPECT_EQ(shapeOf(scene, scene.solids[0]).corners.size(), 6u) << "it lies on the floor";
}

// Where a point appears: from -1 to 1 in the picture, across and up.
std::array<float, 2> onPicture(const OrbitCamera& camera, float aspect, Vec3 p) {
    const glm::vec4 clip = camera.projection(aspect) * camera.view() * glm::vec4(p.x, p.y, p.z, 1);
    return {clip.x / clip.w, clip.y / clip.w};
}

TEST(FirstView, ShowsWholeSolidsOfEachShippedScene) {
    for (const std::string& name : shippedScenes()) {
        const Scene scene = loadScene(findScene(name));
        for (const Solid& solid : scene.solids) {
            const Vec3d middle = convexOf(solid, scene.simulation.dimensions).middle;
            for (const SolidShape::Corner& corner : shapeOf(scene, solid).corners)
                for (const float aspect : {1.0f, 1.6f}) {
                    const Vec3 at = toFloat(middle) + corner.position - scene.domain.min;
                    const auto [x, y] = onPicture(cameraOf(scene, aspect), aspect, at);
                    ASSERT_LT(std::max(std::abs(x), std::abs(y)), 1) << name << " " << solid.name;
                }
        }
    }
}

}  // namespace
}  // namespace spindrift
