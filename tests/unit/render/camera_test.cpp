#include "render/camera.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace spindrift {
namespace {

constexpr float width = 1200, height = 800;

// Where a point appears, in pixels from the upper left corner.
std::array<float, 2> onPicture(const OrbitCamera& camera, Vec3 p) {
    const glm::vec4 clip =
        camera.projection(width / height) * camera.view() * glm::vec4(p.x, p.y, p.z, 1);
    return {(clip.x / clip.w + 1) * 0.5f * width, (1 - clip.y / clip.w) * 0.5f * height};
}

const OrbitCamera camera{{0.5f, 0.4f, 0.3f}, 35, 20, 3, 40};

TEST(OrbitCamera, LooksAtItsTargetFromItsDistance) {
    EXPECT_NEAR(length(camera.eye() - camera.target), 3, 1e-5);
    const auto middle = onPicture(camera, camera.target);
    EXPECT_NEAR(middle[0], width / 2, 1e-2);
    EXPECT_NEAR(middle[1], height / 2, 1e-2);
    EXPECT_GT(camera.eye().y, camera.target.y) << "a positive pitch looks down";
}

TEST(OrbitCamera, AxesArePerpendicularUnitVectors) {
    EXPECT_NEAR(dot(camera.right(), camera.up()), 0, 1e-6);
    EXPECT_NEAR(dot(camera.right(), camera.forward()), 0, 1e-6);
    EXPECT_NEAR(length(camera.up()), 1, 1e-6);
    EXPECT_GT(camera.up().y, 0);
}

TEST(OrbitCamera, RayOfAPixelMeetsWhatTheMatricesDrawThere) {
    const Vec3 point{0.9f, 0.1f, 0.7f};
    const auto pixel = onPicture(camera, point);
    const Ray ray = camera.ray(pixel[0], pixel[1], width, height);
    const Vec3 to = point - ray.origin;
    EXPECT_NEAR(length(to - dot(to, ray.direction) * ray.direction), 0, 1e-4);
    EXPECT_NEAR(length(camera.onPlane(pixel[0], pixel[1], width, height, point) - point), 0, 1e-4);
}

TEST(OrbitCamera, TurnsTheUprightAxesToWhatIsUp) {
    const Vec3 v{1, 2, 3};
    EXPECT_EQ(camera.turned(v), v) << "y is up";
    for (const Vec3 up :
         {Vec3{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
        OrbitCamera tipped = camera;
        tipped.upward = up;
        EXPECT_EQ(tipped.turned({0, 1, 0}), up);
        EXPECT_EQ(tipped.upright(tipped.turned(v)), v);
        const Vec3 across = tipped.turned({1, 0, 0}), toward = tipped.turned({0, 0, 1});
        EXPECT_EQ(dot(cross(across, up), toward), 1) << "no mirror";
        if (up.z == 0) { EXPECT_EQ(toward, (Vec3{0, 0, 1})) << "two dimensions are seen face on"; }
        EXPECT_GT(dot(tipped.up(), up), 0);
        EXPECT_GT(dot(tipped.eye() - tipped.target, up), 0) << "a positive pitch looks down";
    }
}

TEST(OrbitCamera, ZoomKeepsTheAnchorInPlace) {
    const Vec3 anchor{0.2f, 0.6f, 0.1f};
    OrbitCamera nearer = camera;
    nearer.zoom(0.7f, anchor);
    EXPECT_FLOAT_EQ(nearer.distance, 2.1f);
    const auto before = onPicture(camera, anchor), after = onPicture(nearer, anchor);
    EXPECT_NEAR(before[0], after[0], 0.05);
    EXPECT_NEAR(before[1], after[1], 0.05);
}

TEST(OrbitCamera, PanMovesTheTargetWithTheMouse) {
    OrbitCamera moved = camera;
    moved.pan(40, -25, height);
    const auto place = onPicture(moved, camera.target);
    EXPECT_NEAR(place[0], width / 2 + 40, 0.1);
    EXPECT_NEAR(place[1], height / 2 - 25, 0.1);
}

TEST(OrbitCamera, OrbitStopsAtThePoles) {
    OrbitCamera high = camera;
    high.orbit(400, 500);
    EXPECT_FLOAT_EQ(high.pitch, 89);
    EXPECT_NEAR(high.yaw, 75, 1e-4);
    EXPECT_NEAR(length(high.eye() - high.target), 3, 1e-5);
}

TEST(OrbitCamera, FittedBoxStaysInsideThePictureAndFillsIt) {
    for (const Vec3 size : {Vec3{1, 1, 1}, Vec3{3, 0.5f, 0.5f}, Vec3{0.1f, 2, 0.1f}}) {
        OrbitCamera fitted = camera;
        fitted.target = 0.5f * size;
        fitted.distance = fitDistance(fitted, size, width / height);
        float reach = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const auto at = onPicture(fitted, {corner & 1 ? size.x : 0, corner & 2 ? size.y : 0,
                                               corner & 4 ? size.z : 0});
            reach = std::max(
                {reach, std::abs(2 * at[0] / width - 1), std::abs(2 * at[1] / height - 1)});
        }
        EXPECT_LT(reach, 1);
        EXPECT_GT(reach, 0.7f);
    }
}

}  // namespace
}  // namespace spindrift
