// Shapes, what their particles are, and how solids move.
#include "core/error.h"
#include "scene/check.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/motion.h"
#include "scene/particles.h"
#include "scene/sample_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <numeric>

namespace spindrift {
namespace {

Solid solidOf(Shape shape) {
    Solid s;
    s.shape = shape;
    s.min = {0.2f, 0.2f, 0.2f}, s.max = {0.8f, 0.5f, 0.8f};
    s.center = {0.5f, 0.5f, 0.5f}, s.radius = 0.3f, s.height = 0.4f;
    return s;
}
// m^2 of surface, in two dimensions m of outline.
double surfaceOf(Shape shape, int dimensions) {
    const double pi = std::numbers::pi, slope = std::hypot(0.3, 0.3);
    if (dimensions == 2)
        return shape == Shape::Block   ? 2 * (0.6 + 0.3)
               : shape == Shape::Wedge ? 0.6 + 2 * slope
                                       : 2 * pi * 0.3;
    if (shape == Shape::Block) return 2 * (0.6 * 0.6 + 2 * 0.6 * 0.3);
    if (shape == Shape::Wedge) return 0.6 * (0.6 + 2 * slope) + 0.6 * 0.3;
    return shape == Shape::Sphere ? 4 * pi * 0.09 : 2 * pi * 0.3 * 0.4 + 2 * pi * 0.09;
}

TEST(Solids, ParticlesLieInLayersBehindTheSurface) {
    for (int dimensions : {2, 3})
        for (Shape shape : {Shape::Block, Shape::Sphere, Shape::Cylinder, Shape::Wedge}) {
            SCOPED_TRACE(testing::Message() << dimensions << " dimensions, shape " << int(shape));
            Scene scene;
            scene.simulation.dimensions = dimensions;
            scene.simulation.spacing = 0.01f;
            scene.domain.max = {1, 1, 1};
            Solid solid = solidOf(shape);
            if (dimensions == 2) solid.axis = Axis::Z;
            const Convex convex = convexOf(solid, dimensions);
            const SolidSample sample = sampleSolid(scene, solid);
            const std::vector<Vec3>& points = sample.positions;
            int first = 0;
            for (Vec3 p : points) {
                Vec3d at = toDouble(p) - convex.middle;
                if (dimensions == 2) {
                    EXPECT_FLOAT_EQ(p.z, 0.5f);
                    at.z = 0;
                }
                const double depth = -convex.nearest(at).distance / 0.01;
                EXPECT_GT(depth, 0.49);
                first += depth < 0.51;
            }
            // The first layer is a bit smaller than the surface, which lies half a spacing outside
            // it.
            const double expected = surfaceOf(shape, dimensions) / std::pow(0.01, dimensions - 1);
            EXPECT_NEAR(first, expected, 0.08 * expected);
            // Each layer's volume is its own: all of it but what lies two layers deep.
            auto volume = [&](double shrink) {
                Solid inner = solid;
                const Vec3 by{float(shrink), float(shrink), float(shrink)};
                inner.min = inner.min + by, inner.max = inner.max - by;
                const double h = solid.height - 2 * shrink, r = solid.radius - shrink,
                             pi = std::numbers::pi;
                const Vec3d side = toDouble(inner.max - inner.min);
                const double depth = dimensions == 2 ? 1 : side.z;
                if (shape == Shape::Block) return side.x * side.y * depth;
                if (shape == Shape::Sphere)
                    return dimensions == 2 ? pi * r * r : 4 * pi / 3 * r * r * r;
                if (shape == Shape::Cylinder) return pi * r * r * (dimensions == 2 ? 1 : h);
                const double inRadius = 2 * 0.3 * 0.15 / (0.3 + std::hypot(0.3, 0.3)),
                             scale = 1 - shrink / inRadius;
                return 0.5 * 0.6 * 0.3 * scale * scale * depth;
            };
            const double all = std::accumulate(sample.volumes.begin(), sample.volumes.end(), 0.0),
                         layers = volume(0) - volume(0.02);
            EXPECT_NEAR(all * std::pow(0.01, dimensions), layers, 0.02 * layers);
            scene.solids = {solid};
            EXPECT_LE(int64_t(points.size()), countParticles(scene).walls);
        }
}

TEST(Solids, FluidStartsOutside) {
    Scene scene;
    scene.domain.max = {1, 1, 1};
    scene.fluid.bodies = {Body{{.max{1, 1, 1}}}};
    for (Shape shape : {Shape::Block, Shape::Sphere, Shape::Cylinder, Shape::Wedge}) {
        scene.solids = {solidOf(shape)};
        const Convex convex = convexOf(scene.solids[0], 3);
        const Placement p = placeParticles(scene);
        for (Vec3 x : p.positions)
            EXPECT_GT(convex.nearest(toDouble(x) - convex.middle).distance, 0);
        ASSERT_EQ(p.solidSizes.size(), 1u);
        EXPECT_EQ(size_t(p.solidSizes[0]), sampleSolid(scene, scene.solids[0]).positions.size());
        EXPECT_EQ(p.walls[0], sampleSolid(scene, scene.solids[0]).positions[0]);
        const double volume = 1 - double(p.positions.size()) * std::pow(0.02, 3),
                     pi = std::numbers::pi;
        const double exact = shape == Shape::Block    ? 0.108
                             : shape == Shape::Wedge  ? 0.054
                             : shape == Shape::Sphere ? 4 * pi / 3 * 0.027
                                                      : pi * 0.09 * 0.4;
        EXPECT_NEAR(volume, exact, 0.08 * exact);
    }
}

TEST(Solids, DistancesInsideAreExact) {
    const Convex wedge = convexOf(solidOf(Shape::Wedge), 3);
    EXPECT_NEAR(wedge.nearest({0, -0.1, 0}).distance, -0.05, 1e-6);  // of the floor
    EXPECT_NEAR(wedge.nearest({0, 0.14, 0}).distance, -0.01 * std::sqrt(0.5),
                1e-6);  // under the ridge, slopes of 45 degrees
    EXPECT_NEAR(wedge.nearest({0.2, 0.1, 0}).normal.x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(convexOf(solidOf(Shape::Sphere), 3).nearest({0, 0.1, 0}).distance, -0.2, 1e-6);
    EXPECT_NEAR(convexOf(solidOf(Shape::Cylinder), 3).nearest({0.1, 0.15, 0}).distance, -0.05,
                1e-6);
}

// Where it is `s` after the key, and how it moves there.
struct Moved {
    double x, velocity, acceleration;
};
Moved at(const MotionKey& k, double s) {
    return {k.offset.x + s * (k.velocity.x + s / 2 * (k.acceleration.x + s / 3 * k.jerk.x)),
            k.velocity.x + s * (k.acceleration.x + s / 2 * k.jerk.x),
            k.acceleration.x + s * k.jerk.x};
}

// Corners stay where few keyframes make straight lines; finely sampled motion is the smooth one
// that it was sampled of, however it is sampled.
TEST(Solids, KeyframesAreCornersOrSamplesOfSmoothMotion) {
    Solid solid;
    solid.keyframes = {{0, {}, 0}, {1, {1, 0, 0}, 0}, {2, {1, 0, 0}, 0}, {3, {2, 0, 0}, 90}};
    std::vector<MotionKey> keys = motionOf(solid);
    for (size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(keys[k].acceleration.x, 0);
        EXPECT_EQ(keys[k].jerk.x, 0);
    }
    EXPECT_EQ(keys[0].velocity.x, 1);
    EXPECT_EQ(keys[1].velocity.x, 0);
    EXPECT_NEAR(keys[2].spin, std::numbers::pi / 2, 1e-12);
    EXPECT_EQ(keys[3].spin, 0);
    EXPECT_NEAR(largestSpeed(solid), 1 + std::numbers::pi / 2 * reachOf(solid), 1e-6);

    for (bool rates : {false, true})
        for (bool uneven : {false, true})
            for (int perPeriod : {12, 40, 1000}) {
                SCOPED_TRACE(testing::Message() << rates << uneven << " " << perPeriod);
                solid.keyframes.clear();
                const double pi = std::numbers::pi, step = 2 * pi / perPeriod;
                for (int i = 0; i <= perPeriod; ++i) {
                    const double t = step * (i + (uneven ? 0.2 * std::sin(3.0 * i) : 0));
                    solid.keyframes.push_back(
                        {t, {1 - std::cos(t), 0, 0}, 0, rates, {std::sin(t), 0, 0}, 0});
                }
                keys = motionOf(solid);
                for (size_t k = 1; k + 2 < keys.size(); ++k)
                    for (double share : {0.0, 0.3, 0.9}) {
                        const double s = share * (keys[k + 1].time - keys[k].time),
                                     t = keys[k].time + s;
                        EXPECT_NEAR(at(keys[k], s).x, 1 - std::cos(t), 0.1 * step * step) << k;
                        EXPECT_NEAR(at(keys[k], s).velocity, std::sin(t), 0.2 * step) << k;
                        EXPECT_NEAR(at(keys[k], s).acceleration, std::cos(t), 1.5 * step) << k;
                    }
            }
    // From rest on: velocity grows evenly from the first moment.
    solid.keyframes.clear();
    for (int i = 0; i <= 20; ++i) solid.keyframes.push_back({0.1 * i, {0.005 * i * i, 0, 0}, 0});
    for (const MotionKey& k : motionOf(solid)) {
        if (k.time > 1.95) continue;  // it stands still from there on
        EXPECT_NEAR(k.velocity.x, k.time, 1e-9);
        EXPECT_NEAR(k.acceleration.x, 1, 1e-9);
    }
}

TEST(Solids, MotionFromACsvIsKeyframes) {
    const std::string folder = testing::TempDir();
    std::ofstream(folder + "/places.csv") << "t, x, y, z, turn\n0, 0, 0, 0, 0\n1, 0.5, 0, 0, 90\n";
    std::ofstream(folder + "/speeds.csv") << "t,vx,vy,vz\n0,0,0,0\n1,1,0,0\n2,1,0,0\n";
    std::ofstream(folder + "/wrong.csv") << "t,x,y,z\n0,0,0,left\n";
    auto scene = [&](const std::string& file) {
        return parseScene(R"({"version": 2, "solids": [{"motion": ")" + file + R"("}]})",
                          folder + "/a.json");
    };
    const Scene places = scene("places.csv"), speeds = scene("speeds.csv");
    EXPECT_EQ(places.solids[0].keyframes, (Keyframes{{0, {0, 0, 0}, 0}, {1, {0.5f, 0, 0}, 90}}));
    EXPECT_EQ(places.solids[0].motion, "");
    EXPECT_EQ(speeds.solids[0].keyframes, (Keyframes{{0, {0, 0, 0}, 0, true, {0, 0, 0}, 0},
                                                     {1, {0.5, 0, 0}, 0, true, {1, 0, 0}, 0},
                                                     {2, {1.5, 0, 0}, 0, true, {1, 0, 0}, 0}}));
    EXPECT_NEAR(largestSpeed(speeds.solids[0]), 1, 1e-6);
    EXPECT_EQ(parseScene(writeScene(speeds), "").solids[0].keyframes, speeds.solids[0].keyframes);
    try {
        scene("wrong.csv");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("solids[0].motion"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("line 2: z is no number"), std::string::npos)
            << e.what();
    }
}

TEST(Solids, MistakesAreNamed) {
    auto complaint = [](const std::string& solid) -> std::string {
        Scene scene;
        try {
            setKnob(scene, "solids=[" + solid + "]");
            checkScene(scene, "a");
            return "";
        } catch (const Error& e) { return e.what(); }
    };
    const std::string block = R"("shape": "block", "min": [0.2, 0, 0], "max": [0.4, 0.2, 0.3])";
    EXPECT_EQ(complaint("{" + block + "}"), "");
    const std::pair<std::string, const char*> mistakes[] = {
        {R"({"shape": "block", "min": [0.2, 0, 0], "max": [0.2, 0.2, 0.3]})", "thicken it"},
        {R"({"shape": "sphere", "center": [5, 0, 0], "radius": 0.2})", "outside the domain"},
        {"{" + block + R"(, "keyframes": [[1, 0, 0, 0], [1, 1, 0, 0]]})", "does not come after"},
        {"{" + block + R"(, "keyframes": [[1, 0, 0]]})", "expected keyframes"},
        {"{" + block + R"(, "velocity": [1, 0, 0], "keyframes": [[1, 0, 0, 0]]})",
         "leave velocity and spin out"},
        {"{" + block + R"(, "name": "a/b"})", "can't begin a column's name"},
        {"{" + block + R"(, "name": "a"}, {)" + block + R"(, "name": "a"})",
         "is the name of solids[0] too"},
        {"{" + block + R"(, "spin": 1e5, "velocity": [1000, 0, 0], "radius": 3})", "unknown key"},
        {"{" + block + R"(, "keyframes": [[0, 0, 0, 0], [1e-6, 1, 0, 0]]})", "faster than 1e4"},
    };
    for (const auto& [solid, words] : mistakes)
        EXPECT_NE(complaint(solid).find(words), std::string::npos) << complaint(solid);
}

TEST(Solids, WhatFloatsIsRefusedWhereItCannot) {
    auto refusal = [](const std::string& solids,
                      const std::vector<std::string>& more = {}) -> std::string {
        Scene scene;
        scene.domain.max = {1, 1, 1};
        setKnob(scene, "solids=" + solids);
        for (const std::string& knob : more) setKnob(scene, knob);
        try {
            checkScene(scene, "a.json");
        } catch (const Error& error) { return error.what(); }
        return "";
    };
    const std::string ball =
        R"({"shape":"sphere","center":[0.7,0.7,0.5],"radius":0.1,"density":500})";
    EXPECT_EQ(refusal("[" + ball + "]"), "");
    EXPECT_NE(refusal("[" + ball + R"(,{"shape":"block","min":[0.6,0.7,0.4],"max":[0.8,0.9,0.6]}])")
                  .find("begins inside solids[1]"),
              std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"sphere","center":[0.95,0.7,0.5],"radius":0.1,"density":500}])")
                  .find("out of the domain"),
              std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"sphere","density":500,"keyframes":[[0,0,0,0],[1,1,0,0]]}])")
                  .find("leave one of the two out"),
              std::string::npos);
    EXPECT_NE(refusal("[" + ball + "]", {"time.mode=local"}).find("set time.mode to cfl"),
              std::string::npos);
    EXPECT_NE(refusal(R"([{"shape":"plane","center":[0,0.1,0],"normal":[0,1,0],"density":500}])")
                  .find("does not move"),
              std::string::npos);
}

}  // namespace
}  // namespace spindrift
