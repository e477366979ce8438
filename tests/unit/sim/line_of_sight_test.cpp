// What two points see of each other past thin solids.
#include "sim/neighbours/line_of_sight.h"

#include "meshes.h"
#include "scene/convex.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <random>

namespace spindrift {
namespace {

constexpr double Dx = 0.02, R = 2.6 * Dx;

Scene sceneWith(const std::string& solids) {
    Scene scene;
    scene.simulation.spacing = float(Dx);
    scene.domain.max = {1, 1, 1};
    setKnob(scene, "solids=[" + solids + "]");
    return scene;
}
std::function<double(Vec3d, Vec3d)> sightIn(const Scene& scene) {
    std::vector<SolidPose> poses;
    for (const Solid& solid : scene.solids)
        poses.push_back({convexOf(solid, 3).middle, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    return LineOfSight(scene).past(poses);
}

class Pairs {
public:
    // As far apart as fluid feels, beside the middle of the domain.
    std::pair<Vec3d, Vec3d> next(double across) {
        for (;;) {
            const Vec3d p = near(across), q = near(across);
            if (length(q - p) < R) return {p, q};
        }
    }

private:
    Vec3d near(double across) {
        return {0.5 + 0.8 * R * in_(random_), 0.5 + across * in_(random_),
                0.5 + across * in_(random_)};
    }
    std::mt19937 random_{1};
    std::uniform_real_distribution<double> in_{-1, 1};
};

// Over the rim of a plate at x = 0.5 whose sides are 0.2 m.
double shortestAround(Vec3d p, Vec3d q) {
    double least = 1e30;
    for (const double end : {0.4, 0.6})
        for (int i = 0; i <= 1600; ++i)
            for (const Vec3d rim :
                 {Vec3d{0.5, end, 0.4 + 0.000125 * i}, Vec3d{0.5, 0.4 + 0.000125 * i, end}})
                least = std::min(least, length(rim - p) + length(q - rim));
    return least;
}

TEST(LineOfSight, PlatesHideTheMoreTheLongerTheWayAroundThemIs) {
    for (const double t : {0.25, 1.0, 2.0, 3.0}) {
        const auto sees = sightIn(
            sceneWith(fmt::format(R"({{"shape":"block","min":[{},0.4,0.4],"max":[{},0.6,0.6]}})",
                                  0.5 - t * Dx / 2, 0.5 + t * Dx / 2)));
        Pairs pairs;
        int hidden = 0, partly = 0;
        for (int k = 0; k < 3000; ++k) {
            const auto [p, q] = pairs.next(0.12);
            const double share = sees(p, q), at = (0.5 - p.x) / (q.x - p.x);
            const Vec3d through = p + at * (q - p);
            EXPECT_NEAR(sees(q, p), share, 1e-9);
            if ((p.x - 0.5) * (q.x - 0.5) > 0 || std::abs(through.y - 0.5) > 0.1 ||
                std::abs(through.z - 0.5) > 0.1) {
                EXPECT_EQ(share, 1);
                continue;
            }
            const double straight = length(q - p), around = shortestAround(p, q);
            const double most = std::pow(std::max(0.0, (R - around) / (R - straight)), 4);
            EXPECT_NEAR(share, most, 1e-3);
            if (around > R) { EXPECT_EQ(share, 0); }
            hidden += share == 0, partly += share > 0;
        }
        EXPECT_GT(hidden, 500);
        EXPECT_GT(partly, 100);
    }
}

TEST(LineOfSight, NoWayLeadsAroundWhereAPlateStandsOnSomething) {
    const std::string standing = R"({"shape":"block","min":[0.495,0.1,0],"max":[0.505,0.6,1]})",
                      ground = R"({"shape":"block","min":[0.2,0,0],"max":[0.8,0.1,1]})";
    const Vec3d p{0.49, 0.11, 0.5}, q{0.51, 0.11, 0.5};
    EXPECT_GT(sightIn(sceneWith(standing))(p, q), 0.1);
    EXPECT_EQ(sightIn(sceneWith(standing + "," + ground))(p, q), 0);
    const Vec3d down{0, -0.1, 0};
    const std::string onFloor = R"({"shape":"block","min":[0.495,0,0],"max":[0.505,0.6,1]})";
    EXPECT_EQ(sightIn(sceneWith(onFloor))(p + down, q + down), 0);
}

// Deeper than their grace.
TEST(LineOfSight, OtherThinSolidsHideWhatIsBehindThem) {
    const std::string mesh = dentedBoxSurface({0.495, 0.4, 0.4}, {0.505, 0.6, 0.6})
                                 .write(testing::TempDir() + "/hiding.obj");
    for (const std::string& solid :
         {std::string(R"({"shape":"cylinder","axis":"x","center":[0.5,0.5,0.5],"radius":0.1,
                          "height":0.01})"),
          R"({"shape":"mesh","path":")" + mesh + "\"}"}) {
        const Scene scene = sceneWith(solid);
        const Convex shape = convexOf(scene.solids[0], 3);
        const auto sees = sightIn(scene);
        const double grace = 0.001;
        Pairs pairs;
        int hidden = 0;
        for (int k = 0; k < 3000; ++k) {
            const auto [p, q] = pairs.next(0.15);
            double deepest = 1;
            for (int i = 0; i <= 400; ++i)
                deepest = std::min(
                    deepest, shape.nearest(p + (i / 400.0) * (q - p) - shape.middle).distance);
            if (std::abs(deepest + grace) < (shape.mesh ? 2e-3 : 4e-4)) continue;  // nearly touches
            EXPECT_EQ(sees(p, q), deepest < -grace ? 0 : 1) << deepest;
            EXPECT_EQ(sees(q, p), sees(p, q));
            hidden += deepest < -grace;
        }
        EXPECT_GT(hidden, 400);
    }
}

}  // namespace
}  // namespace spindrift
