// Fluid drawn as a surface: it is where its particles are, smooth where it is flat, hidden by what
// is in front, and lets through what is behind.
#include "picture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

constexpr int middleX = 160, middleY = 120;

// A slab of fluid that faces the camera, `layers` deep, its front at z = 0.5; values by x.
std::vector<Vertex> slab(int layers) {
    std::vector<Vertex> particles;
    const float dx = 0.04f;
    for (int k = 0; k < layers; ++k)
        for (int i = 0; i < 20; ++i)
            for (int j = 0; j < 20; ++j) {
                const float x = 0.1f + dx * (float(i) + 0.5f), y = 0.1f + dx * (float(j) + 0.5f);
                particles.push_back({x, y, 0.5f - dx * (float(k) + 0.5f), x});
            }
    return particles;
}
DrawSettings surfaceOf(const std::vector<Vertex>& particles, bool surface = true) {
    DrawSettings settings = frontView(int(particles.size()));
    settings.diameter = 0.04f;
    settings.surface = surface;
    return settings;
}
// Standard deviation of green within the slab's middle.
double roughness(const Image& image) {
    double sum = 0, squares = 0, n = 0;
    for (int y = middleY - 25; y <= middleY + 25; ++y)
        for (int x = middleX - 25; x <= middleX + 25; ++x) {
            const double g = pixel(image, x, y).g;
            sum += g, squares += g * g, ++n;
        }
    return std::sqrt(std::max(0.0, squares / n - sum / n * sum / n));
}

TEST(FluidSurface, IsWhereTheParticlesAre) {
    const auto particles = slab(5);
    for (int samples : {1, 4}) {
        const Image bare = picture({}, frontView(0), samples),
                    spheres = picture(particles, surfaceOf(particles, false), samples),
                    surface = picture(particles, surfaceOf(particles), samples);
        const int covered = changed(spheres, bare), found = changed(surface, bare);
        EXPECT_GT(covered, 5000);
        // Its outline is half a spacing farther out.
        EXPECT_NEAR(found, covered, 0.12 * covered) << samples;
        EXPECT_GT(changed(surface, spheres), covered / 2) << "it's no picture of spheres";
    }
}

TEST(FluidSurface, IsSmoothWhereFluidIsFlat) {
    const auto particles = slab(5);
    DrawSettings spheres = surfaceOf(particles, false), surface = surfaceOf(particles);
    spheres.plain = surface.plain = true;
    const double before = roughness(picture(particles, spheres)),
                 after = roughness(picture(particles, surface));
    EXPECT_GT(before, 12);
    EXPECT_LT(after, 0.25 * before);
}

TEST(FluidSurface, HasTheColoursOfTheTable) {
    const auto particles = slab(5);
    const Image image = picture(particles, surfaceOf(particles));  // viridis, by x
    const Rgb left = pixel(image, middleX - 40, middleY),
              right = pixel(image, middleX + 40, middleY);
    EXPECT_GT(left.b, left.g + 20) << "purple";
    EXPECT_GT(right.g, right.b + 20) << "green to yellow";
}

TEST(FluidSurface, MoreFluidLetsLessThrough) {
    DrawSettings settings;
    double last = 1e9;
    for (int layers : {1, 3, 9}) {
        const auto particles = slab(layers);
        settings = surfaceOf(particles);
        settings.plain = true;
        // Behind it a solid of light grey.
        SolidShape plate;
        for (const Vec3 corner : {Vec3{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}})
            plate.corners.push_back({corner, {0, 0, 1}});
        Renderer& renderer = rendererOf(320, 240);
        renderer.setSolids({plate});
        settings.solids = {{{0.5f, 0.5f, 0.0f}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        const Image image = pictureBy(renderer, particles, settings);
        renderer.setSolids({});
        const double red = pixel(image, middleX, middleY).r;
        EXPECT_LT(red, last) << layers;
        last = red;
    }
}

TEST(FluidSurface, IsHiddenBySolidsInFront) {
    const auto particles = slab(5);
    SolidShape plate;
    for (const Vec3 corner : {Vec3{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}})
        plate.corners.push_back({corner, {0, 0, 1}});
    for (int samples : {1, 4}) {
        Renderer& renderer = rendererOf(320, 240, samples);
        renderer.setSolids({plate});
        DrawSettings settings = surfaceOf(particles), none = frontView(0);
        settings.solids = none.solids = {{{0.5f, 0.5f, 0.8f}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        const Rgb hidden = pixel(pictureBy(renderer, particles, settings), middleX, middleY),
                  alone = pixel(pictureBy(renderer, {}, none), middleX, middleY);
        EXPECT_EQ(hidden.g, alone.g);
        settings.solids[0].middle.z = 0.1f;
        const Rgb shown = pixel(pictureBy(renderer, particles, settings), middleX, middleY);
        EXPECT_GT(std::abs(shown.g - alone.g), 15) << "the plate is behind now";
        renderer.setSolids({});
    }
}

// What is picked and what hides lines is the surface.
TEST(FluidSurface, IsUnderThePixel) {
    const auto particles = slab(5);
    for (int samples : {1, 4}) {
        Renderer& renderer = rendererOf(320, 240, samples);
        pictureBy(renderer, particles, surfaceOf(particles));
        const std::optional<Vec3> at = renderer.surfaceAt(middleX, middleY);
        ASSERT_TRUE(at.has_value());
        EXPECT_NEAR(at->z, 0.5f, 0.02f);
        EXPECT_FALSE(renderer.surfaceAt(5, 5).has_value());
    }
}

TEST(FluidSurface, NoFluidIsNoSurface) {
    DrawSettings settings = frontView(0);
    const Image without = picture({}, settings);
    settings.surface = true;
    EXPECT_EQ(changed(picture({}, settings), without, 0), 0);
}

}  // namespace
}  // namespace spindrift
