#include "scene/particles.h"

#include "scene/json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace spindrift {
namespace {

double closest(const std::vector<Vec3>& points) {
    double best = 1e9;
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t j = 0; j < i; ++j) best = std::min<double>(best, length(points[i] - points[j]));
    return best;
}

Scene oneBody(Body body) {
    Scene scene;
    scene.domain.max = {1, 1, 1};
    scene.fluid.bodies = {body};
    return scene;
}

TEST(Up, IsAgainstTheLargestPartOfGravityUnlessThatDrivesAFlow) {
    const auto upIn = [](Vec3 gravity, bool periodicX = false, int dimensions = 3) {
        Scene scene;
        scene.simulation.gravity = gravity;
        scene.simulation.dimensions = dimensions;
        scene.domain.periodicX = periodicX;
        return upward(scene);
    };
    const Vec3 y{0, 1, 0};
    for (int k = 0; k < 3; ++k)
        for (const float g : {-9.81f, 1e-3f}) {
            Vec3 gravity, up;
            gravity[k] = g, up[k] = g < 0 ? 1.0f : -1.0f;
            EXPECT_EQ(upIn(gravity), up);
            gravity[(k + 1) % 3] = 0.5f * g;
            EXPECT_EQ(upIn(gravity), up) << "tilted";
        }
    EXPECT_EQ(upIn({}), y);
    EXPECT_EQ(upIn({2, 0, 0}, true), y) << "a channel";
    EXPECT_EQ(upIn({0, 0, -2}, true), (Vec3{0, 0, 1}));
    EXPECT_EQ(upIn({0, -1, -2}, false, 2), y) << "z does not matter in two dimensions";
    EXPECT_EQ(upIn({-1, -1, -1}), y);
    Scene scene;
    const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; ++k) {
        scene.view.up = Up(int(Up::X) + k);
        EXPECT_EQ(upward(scene), axes[k]);
        scene.view.up = Up(int(Up::MinusX) + k);
        EXPECT_EQ(upward(scene), -1.0f * axes[k]);
    }
}

TEST(Particles, HistoricalCountsAndPlaces) {
    const std::vector<std::tuple<const char*, size_t, size_t>> files = {
        {"1.json", 16 * 22 * 16, 14408},
        {"2.json", 24 * 32 * 24, 22328},
        {"3.json", 32 * 48 * 32, 33752}};
    for (const auto& [file, fluid, walls] : files) {
        const Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR "/configs/") + file);
        const Placement placement = placeParticles(scene);
        EXPECT_EQ(placement.positions.size(), fluid) << file;
        EXPECT_EQ(placement.walls.size(), walls) << file;
        EXPECT_EQ(countParticles(scene).fluid, int64_t(fluid));
        EXPECT_EQ(countParticles(scene).walls, int64_t(walls));
    }
    // The block is centred on a lattice of 0.025 m; wall points span [0, 0.999 L].
    const Placement first = placeParticles(loadScene(SPINDRIFT_SOURCE_DIR "/configs/1.json"));
    EXPECT_FLOAT_EQ(first.positions.front().x, 0.5f - 7.5f * 0.025f);
    EXPECT_FLOAT_EQ(first.positions.back().y, 0.5f + 10.5f * 0.025f);
    EXPECT_EQ(first.walls.front(), (Vec3{0, 0, 0}));
    EXPECT_FLOAT_EQ(first.walls.back().z, 0.999f);
    EXPECT_FLOAT_EQ(first.walls[1].x, 0.999f / 49);
}

TEST(Particles, DefaultSceneIsAboutTwentyThousand) {
    const Placement placement = placeParticles(Scene{});
    EXPECT_EQ(placement.positions.size(), 25u * 27 * 30);
    EXPECT_EQ(placement.velocities.size(), placement.positions.size());
}

TEST(Particles, BlockIsCellCentredAndRelativeToTheDomain) {
    Body body;
    body.min = {-1, 2, 3};
    body.max = {-0.9f, 2.2f, 3.3f};
    body.velocity = {1, 2, 3};
    Scene scene = oneBody(body);
    scene.domain = {{-1, 2, 3}, {0, 3, 4}};
    const Placement placement = placeParticles(scene);
    ASSERT_EQ(placement.positions.size(), 5u * 10 * 15);
    EXPECT_NEAR(placement.positions[0].x, 0.01, 1e-6);
    EXPECT_NEAR(placement.positions[0].y, 0.01, 1e-6);
    EXPECT_NEAR(placement.positions.back().z, 0.29, 1e-6);
    EXPECT_EQ(placement.velocities[7], (Vec3{1, 2, 3}));
}

TEST(Particles, WallsContinueTheFluidsLattice) {
    Scene scene = oneBody(Body{{.max{1, 1, 1}}});
    scene.simulation.spacing = 0.1f;
    const Placement placement = placeParticles(scene);
    EXPECT_EQ(placement.positions.size(), 1000u);
    // A particle half a spacing inside sees 2.1 spacings beyond the face: two layers.
    EXPECT_EQ(placement.walls.size(), 14u * 14 * 14 - 1000);
    EXPECT_EQ(countParticles(scene).walls, int64_t(placement.walls.size()));
    std::vector<Vec3> all = placement.positions;
    all.insert(all.end(), placement.walls.begin(), placement.walls.end());
    EXPECT_NEAR(closest(all), 0.1, 1e-5);
    for (Vec3 w : placement.walls) {
        const float outside = std::max({-w.x, -w.y, -w.z, w.x - 1, w.y - 1, w.z - 1});
        EXPECT_NEAR(outside, outside < 0.1f ? 0.05 : 0.15, 1e-6);
    }
    scene.simulation.support = 3.5f;
    EXPECT_EQ(placeParticles(scene).walls.size(), 16u * 16 * 16 - 1000);
    scene.walls.kind = WallKind::Reflect;
    EXPECT_TRUE(placeParticles(scene).walls.empty());
    EXPECT_EQ(countParticles(scene).walls, 0);
}

TEST(Particles, ABlockNeverRoundsUpIntoTheWall) {
    Scene scene = oneBody(Body{{.max{0.51f, 0.2f, 0.2f}}});  // 25.5 spacings in a domain as wide
    scene.domain.max = {0.51f, 1, 1};
    for (Vec3 p : placeParticles(scene).positions) ASSERT_LT(p.x, 0.51f - 0.005f);
}

TEST(Particles, RoundBodiesAreSymmetricAndHaveTheirVolume) {
    Body sphere;
    sphere.shape = Shape::Sphere;
    sphere.radius = 0.2f;
    Body cylinder = sphere;
    cylinder.shape = Shape::Cylinder;
    cylinder.height = 0.3f;
    cylinder.axis = Axis::X;
    for (const auto& [body, volume] :
         {std::pair{sphere, 4.18879 * 0.008}, {cylinder, 3.14159 * 0.04 * 0.3}}) {
        const Scene scene = oneBody(body);
        const auto points = placeParticles(scene).positions;
        EXPECT_NEAR(double(points.size()) * 8e-6, volume, 0.02 * volume);
        EXPECT_GE(countParticles(scene).fluid, int64_t(points.size()));
        EXPECT_LE(countParticles(scene).fluid, int64_t(1.5 * double(points.size())));
        Vec3d sum{};
        Vec3 low{9, 9, 9}, high{-9, -9, -9};
        for (Vec3 p : points) {
            sum = sum + toDouble(p);
            for (int k = 0; k < 3; ++k)
                low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        }
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(sum[k] / double(points.size()), 0.5, 1e-6);
            EXPECT_NEAR(low[k] + high[k], 1, 1e-6);
        }
        const float length = body.shape == Shape::Cylinder ? 0.3f : 0.4f;
        EXPECT_NEAR(high.x - low.x, length - 0.02f, 1e-5);
    }
}

TEST(Particles, OverlappingBodiesKeepTheirDistance) {
    Body block{{.min{0.3f, 0.3f, 0.3f}, .max{0.5f, 0.5f, 0.5f}}}, sphere, cylinder;
    sphere.shape = Shape::Sphere;
    sphere.center = {0.502f, 0.501f, 0.499f};
    sphere.radius = 0.12f;
    cylinder.shape = Shape::Cylinder;
    cylinder.center = {0.55f, 0.5f, 0.6f};
    cylinder.radius = 0.1f;
    Scene scene = oneBody(block);
    const size_t blockOnly = placeParticles(scene).positions.size();
    scene.fluid.bodies = {block, sphere, cylinder};
    const auto points = placeParticles(scene).positions;
    EXPECT_GT(points.size(), blockOnly + 500);
    EXPECT_GE(closest(points), 0.98 * 0.02 - 1e-6);
}

TEST(Particles, AbsurdScenesAreCountedWithoutOverflow) {
    Scene scene;
    scene.simulation.spacing = 1e-5f;
    scene.domain.max = {1e4f, 1e4f, 1e4f};
    scene.fluid.bodies = {Body{{.max{1e4f, 1e4f, 1e4f}}}, Body{{.max{1e4f, 1e4f, 1e4f}}}};
    for (Formulation formulation : {Formulation::Wcsph, Formulation::Classic}) {
        scene.simulation.formulation = formulation;
        EXPECT_GT(countParticles(scene).fluid, int64_t(1e18));
        EXPECT_GT(countParticles(scene).walls, int64_t(1e12));
    }
}

}  // namespace
}  // namespace spindrift
