// What colours mean, without a picture.
#include "app/frame.h"
#include "app/solid_shapes.h"
#include "scene/json.h"

#include <gtest/gtest.h>

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
TEST(SolidShapes, HaveTheVolumeOfTheirSolids) {
    const double pi = 3.14159265358979;
    const std::vector<std::pair<std::string, double>> solids = {
        {R"([{"shape":"block","min":[0.1,0.2,0.3],"max":[0.4,0.6,0.5]}])", 0.3 * 0.4 * 0.2},
        {R"([{"shape":"wedge","min":[0.1,0.2,0.3],"max":[0.5,0.6,0.5]}])", 0.5 * 0.4 * 0.4 * 0.2},
        {R"([{"shape":"sphere","center":[0.5,0.4,0.3],"radius":0.2}])", 4 * pi / 3 * 0.008},
        {R"([{"shape":"cylinder","center":[0.5,0.4,0.3],"radius":0.2,"height":0.3,"axis":"x"}])",
         pi * 0.04 * 0.3},
        {R"([{"shape":"cylinder","center":[0.5,0.4,0.3],"radius":0.2,"height":0.3,"axis":"z"}])",
         pi * 0.04 * 0.3},
    };
    for (const auto& [json, volume] : solids) {
        Scene scene;
        setKnob(scene, "solids=" + json);
        const SolidShape shape = shapeOf(scene, scene.solids[0]);
        double sum = 0;
        for (size_t i = 0; i + 2 < shape.corners.size(); i += 3) {
            const Vec3d a = toDouble(shape.corners[i].position),
                        b = toDouble(shape.corners[i + 1].position),
                        c = toDouble(shape.corners[i + 2].position);
            const Vec3d twice = cross(b - a, c - a), n = toDouble(shape.corners[i].normal);
            sum += (dot(twice, n) > 0 ? 1 : -1) * dot(a, twice) / 6;
        }
        EXPECT_NEAR(sum / volume, 1, 0.01) << json;
        EXPECT_FALSE(shape.corners.empty());
    }
}

}  // namespace
}  // namespace spindrift
