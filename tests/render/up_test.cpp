// Whatever direction gravity has, the picture is that of the same scene turned until it points
// down.
#include "app/frame.h"
#include "picture.h"
#include "render/image_compare.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace spindrift {
namespace {

constexpr Vec3 Ups[] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

std::string named(Vec3 up) { return fmt::format("up is {}, {}, {}", up.x, up.y, up.z); }

// A box so turned has corners that must be sorted again.
void setBox(Vec3 a, Vec3 b, Vec3& low, Vec3& high) {
    for (int k = 0; k < 3; ++k) low[k] = std::min(a[k], b[k]), high[k] = std::max(a[k], b[k]);
}

// Fluid at one end of a tank of three different sides, and a block at the other.
Scene tank(Vec3 up, int dimensions) {
    OrbitCamera axes;
    axes.upward = up;
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = 0.05f;
    scene.simulation.gravity = -9.81f * up;
    setBox({}, axes.turned({1, 0.6f, 0.4f}), scene.domain.min, scene.domain.max);
    Body& body = scene.fluid.bodies[0];
    setBox({}, axes.turned({0.3f, 0.5f, 0.2f}), body.min, body.max);
    if (dimensions == 2) body.min.z = scene.domain.min.z, body.max.z = scene.domain.max.z;
    Solid block;
    setBox(axes.turned({0.7f, 0.05f, 0.1f}), axes.turned({0.9f, 0.2f, 0.4f}), block.min, block.max);
    if (dimensions == 3) scene.solids = {block};
    scene.compute.threads = 1;
    return scene;
}

Image pictureOf(const Scene& scene, const std::vector<Ring>& rings = {}) {
    rendererOf(16, 16);  // makes the context
    Frame frame(320, 240, 4);
    const auto simulation = makeSimulation(scene);
    frame.update(*simulation, scene);
    frame.draw(scene, rings);
    return frame.image();
}

TEST(Up, IsAgainstGravityInThePicture) {
    for (int dimensions : {2, 3}) {
        const Image upright = pictureOf(tank({0, 1, 0}, dimensions));
        for (const Vec3 up : Ups) {
            if (dimensions == 2 && up.z != 0) continue;
            const ImageDifference d = compareImages(upright, pictureOf(tank(up, dimensions)));
            EXPECT_GT(d.ssim, 0.999) << named(up) << ", dimensions " << dimensions;
        }
    }
}

// The knob turns the picture only: a fall to the side.
TEST(Up, IsWhatItsKnobSays) {
    const Image first = pictureOf(tank({0, 0, 1}, 3));
    Scene lying = tank({0, 0, 1}, 3);
    lying.view.up = Up::Y;
    EXPECT_LT(compareImages(first, pictureOf(lying)).ssim, 0.95);
    lying.simulation.gravity = {0, -9.81f, 0};
    lying.view.up = Up::Z;
    EXPECT_GT(compareImages(first, pictureOf(lying)).ssim, 0.999);
}

}  // namespace
}  // namespace spindrift
