// What stands in front hides what is behind, to the pixel, in whatever order it's drawn.
#include "picture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

constexpr int middleX = 160, middleY = 120;

// Values 0 and 1 are dark purple and yellow in viridis.
bool isYellow(Rgb c) { return c.g > c.b + 40; }

TEST(Spheres, NearHidesFarInBothOrders) {
    const Vertex near{0.5f, 0.5f, 0.8f, 1}, far{0.5f, 0.5f, 0.2f, 0};
    for (int samples : {1, 4}) {
        EXPECT_TRUE(isYellow(pixel(picture({near, far}, frontView(2), samples), middleX, middleY)));
        EXPECT_TRUE(isYellow(pixel(picture({far, near}, frontView(2), samples), middleX, middleY)));
    }
}

// Two spheres at the same depth, 0.1 m apart, meet in the plane between them: flat discs would show
// one of them whole.
TEST(Spheres, IntersectingSpheresMeetInThePlaneBetweenThem) {
    const Vertex left{0.45f, 0.5f, 0.5f, 1}, right{0.55f, 0.5f, 0.5f, 0};
    for (const std::vector<Vertex>& order : {std::vector{left, right}, std::vector{right, left}}) {
        const Image image = picture(order, frontView(2));
        for (int dx : {4, 8, 12, 16}) {
            EXPECT_TRUE(isYellow(pixel(image, middleX - dx, middleY))) << dx;
            EXPECT_FALSE(isYellow(pixel(image, middleX + dx, middleY))) << dx;
        }
    }
}

// A sphere half as far again behind sticks out where the front one has curved away.
TEST(Spheres, DepthFollowsTheCurve) {
    const Vertex front{0.5f, 0.5f, 0.5f, 1}, shifted{0.58f, 0.5f, 0.46f, 0};
    const Image image = picture({front, shifted}, frontView(2));
    EXPECT_TRUE(isYellow(pixel(image, middleX, middleY)));
    EXPECT_FALSE(isYellow(pixel(image, middleX + 17, middleY)));
}

TEST(Spheres, DiameterIsTheOneAskedFor) {
    DrawSettings settings = frontView(1);
    const Image with = picture({{0.5f, 0.5f, 0.5f, 1}}, settings),
                without = picture({}, frontView(0));
    // 0.2 m at 3 m in a picture of 240 px and 40 degrees.
    const double diameter = 0.2 / 3 * 120 / std::tan(20 * 3.14159265 / 180);
    EXPECT_NEAR(changed(with, without), 3.14159265 / 4 * diameter * diameter, 3.2 * diameter);
}

TEST(Spheres, NeverSmallerThanTheSmallestSize) {
    DrawSettings settings = frontView(1);
    settings.diameter = 1e-5f;
    settings.minimumPixels = 10;
    const int dots = changed(picture({{0.5f, 0.5f, 0.5f, 1}}, settings), picture({}, frontView(0)));
    EXPECT_NEAR(dots, 78, 30);
}

TEST(Spheres, EdgesAreSmoothWithSamples) {
    const std::vector<Vertex> one{{0.5f, 0.5f, 0.5f, 1}};
    // Pixels along a row through the edge: without samples the step is whole, with samples there's
    // one in between.
    const auto grey = [&](int samples) {
        const Image image = picture(one, frontView(1), samples),
                    bare = picture({}, frontView(0), samples);
        int between = 0;
        for (int y = 90; y < 150; ++y)
            for (int x = 130; x < 190; ++x) {
                const int rise = pixel(image, x, y).g - pixel(bare, x, y).g;
                between += rise > 5 && rise < 70;
            }
        return between;
    };
    EXPECT_GT(grey(4), grey(1) + 15);
}

TEST(Spheres, SurfaceUnderAPixelIsTheSpheresFront) {
    for (int samples : {1, 4}) {
        picture({{0.5f, 0.5f, 0.5f, 1}}, frontView(1), samples);
        const std::optional<Vec3> hit = rendererOf(320, 240, samples).surfaceAt(middleX, middleY);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(length(*hit - Vec3{0.5f, 0.5f, 0.6f}), 0, 0.01);
        EXPECT_FALSE(rendererOf(320, 240, samples).surfaceAt(10, 10));
    }
}

}  // namespace
}  // namespace spindrift
