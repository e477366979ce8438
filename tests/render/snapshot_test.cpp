// The same scene gives the same picture; anything that should be seen changes it.
#include "picture.h"

#include <gtest/gtest.h>

#include <functional>

namespace spindrift {
namespace {

std::vector<Vertex> cube() {
    std::vector<Vertex> v;
    for (int i = 0; i < 125; ++i)
        v.push_back({0.1f + 0.2f * float(i % 5), 0.1f + 0.2f * float(i / 5 % 5),
                     0.1f + 0.2f * float(i / 25), float(i) / 125});
    return v;
}

DrawSettings studio(int count) {
    DrawSettings settings = frontView(count);
    settings.camera.yaw = 35;
    settings.camera.pitch = 20;
    settings.ground = settings.outline = true;
    settings.legend = LegendText{"velocity", "m/s", "fixed"};
    return settings;
}

TEST(Snapshot, SameSceneTwiceIsTheSamePictureBitByBit) {
    for (int samples : {1, 4}) {
        const Image first = picture(cube(), studio(125), samples);
        picture({}, studio(0), samples);
        EXPECT_EQ(first, picture(cube(), studio(125), samples));
    }
}

struct Change {
    const char* name;
    std::function<void(std::vector<Vertex>&, DrawSettings&)> make;
};

TEST(Snapshot, EveryChangeThatShouldBeSeenIsSeen) {
    const std::vector<Change> changes = {
        {"another colour", [](auto& v, auto&) { v[124].value = 0; }},
        {"another map", [](auto&, auto& s) { s.map = ColorMap::Turbo; }},
        {"another range", [](auto&, auto& s) { s.rangeMax = 0.5f; }},
        {"plain", [](auto&, auto& s) { s.plain = true; }},
        {"a moved camera", [](auto&, auto& s) { s.camera.orbit(2, 0); }},
        {"a moved particle", [](auto& v, auto&) { v[124].y += 0.05f; }},
        {"one particle missing", [](auto& v, auto& s) { v.pop_back(), s.fluidCount = 124; }},
        {"smaller particles", [](auto&, auto& s) { s.diameter = 0.15f; }},
        {"no outline", [](auto&, auto& s) { s.outline = false; }},
        {"no ground", [](auto&, auto& s) { s.ground = false; }},
        {"no legend", [](auto&, auto& s) { s.legend.reset(); }},
        {"another unit", [](auto&, auto& s) { s.legend->unit = "km/h"; }},
        {"a ring",
         [](auto&, auto& s) {
             s.rings.push_back({{0.5f, 0.5f, 1}, 0.3f, {1, 1, 0}});
         }},
    };
    const Image before = picture(cube(), studio(125));
    for (const Change& change : changes) {
        std::vector<Vertex> vertices = cube();
        DrawSettings settings = studio(125);
        change.make(vertices, settings);
        EXPECT_GE(changed(before, picture(vertices, settings)), 10) << change.name;
    }
}

TEST(Snapshot, BoundaryParticlesShowOnlyWhenAsked) {
    DrawSettings settings = frontView(1);
    const std::vector<Vertex> wall = {{0.3f, 0.5f, 0.5f, 1}, {0.7f, 0.5f, 0.5f, 0}},
                              solid = {wall[0], {0.7f, 0.5f, 0.5f, 1}};
    const Image hidden = picture(wall, settings);
    EXPECT_EQ(changed(hidden, picture({wall[0]}, settings)), 0);
    settings.wallCount = 1;
    EXPECT_GE(changed(hidden, picture(wall, settings)), 10);
    EXPECT_GE(changed(picture(wall, settings), picture(solid, settings)),
              10);  // those of solids are larger
}

// What differs by its round-off only, in a range of one value.
TEST(Snapshot, RangeOfOneValueHasOneColour) {
    std::vector<Vertex> zero = cube(), half = cube();
    for (size_t i = 0; i < zero.size(); ++i)
        zero[i].value = 0, half[i].value = 0.5f + 1e-7f * float(i % 3);
    DrawSettings settings = studio(125);
    settings.legend.reset();
    const Image lowest = picture(zero, settings);
    settings.rangeMin = settings.rangeMax = 0.5f;
    EXPECT_EQ(changed(lowest, picture(half, settings)), 0);
}

TEST(Snapshot, LegendIsDrawnWithBarAndText) {
    DrawSettings settings = frontView(0);
    settings.legend = LegendText{"velocity", "m/s", "fixed"};
    settings.rangeMax = 4;
    const Image bare = picture({}, frontView(0), 4, 800, 600),
                with = picture({}, settings, 4, 800, 600);
    int yellow = 0, white = 0;
    for (int y = 400; y < 600; ++y)
        for (int x = 0; x < 400; ++x) {
            const Rgb c = pixel(with, x, y);
            yellow += c.r > 230 && c.g > 200 && c.b < 60;  // viridis' upper end
            white += c.r > 200 && c.g > 200 && c.b > 200;  // letters
        }
    EXPECT_GT(changed(bare, with), 5000);
    EXPECT_GT(yellow, 20);
    EXPECT_GT(white, 50);
}

TEST(Snapshot, OtherSizesWorkAndAbsurdOnesAreErrors) {
    const Image large = picture(cube(), studio(125), 4, 1001, 333);
    EXPECT_EQ(large.width, 1001);
    EXPECT_EQ(large.height, 333);
    EXPECT_ANY_THROW(rendererOf(0, 100));
    EXPECT_ANY_THROW(rendererOf(1 << 20, 100));
}

}  // namespace
}  // namespace spindrift
