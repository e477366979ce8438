// What is seen inside the fluid: a picture with a clip box is that of the particles in it, a slice
// has the table's colours, an orthographic view shows all as large as it is.
#include "picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace spindrift {
namespace {

constexpr float dx = 0.1f;

// A block from 0.2 to 0.8 m, values by x.
std::vector<Vertex> block() {
    std::vector<Vertex> v;
    for (int i = 0; i < 216; ++i) {
        const float x = 0.25f + dx * float(i % 6);
        v.push_back({x, 0.25f + dx * float(i / 6 % 6), 0.25f + dx * float(i / 36), x});
    }
    return v;
}

DrawSettings viewOf(int count, bool surface = false) {
    DrawSettings settings = frontView(count);
    settings.camera.yaw = 35, settings.camera.pitch = 20;
    settings.diameter = dx;
    settings.surface = surface;
    return settings;
}

std::vector<Vertex> those(const std::function<bool(const Vertex&)>& wanted) {
    std::vector<Vertex> found;
    for (const Vertex& v : block())
        if (wanted(v)) found.push_back(v);
    return found;
}
float along(const Vertex& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

TEST(Clip, PictureIsThatOfTheParticlesInTheBox) {
    for (const bool surface : {false, true})
        for (const int samples : {1, 4})
            for (int axis = 0; axis < 3; ++axis)
                for (const bool above : {false, true}) {
                    DrawSettings all = viewOf(216, surface), clipped = all;
                    (above ? clipped.clipHigh : clipped.clipLow)[axis] = 0.5f;
                    const auto kept =
                        those([&](const Vertex& v) { return above == (along(v, axis) < 0.5f); });
                    const Image cut = picture(block(), clipped, samples);
                    EXPECT_EQ(cut, picture(kept, viewOf(int(kept.size()), surface), samples))
                        << surface << samples << axis << above;
                    EXPECT_GT(changed(cut, picture(block(), all, samples)), 100);
                }
}

TEST(Clip, ThresholdsShowValuesBetweenThem) {
    for (const bool surface : {false, true}) {
        DrawSettings settings = viewOf(216, surface);
        settings.shownMin = 0.4f, settings.shownMax = 0.6f;
        const auto kept = those([](const Vertex& v) { return v.x > 0.4f && v.x < 0.6f; });
        EXPECT_EQ(picture(block(), settings), picture(kept, viewOf(int(kept.size()), surface)));
        EXPECT_EQ(kept.size(), 72u);
    }
}

// Solids and boundary particles stay, unless they are to be cut too.
TEST(Clip, CutsSolidsWhenAsked) {
    SolidShape plate;
    for (const Vec3 corner : {Vec3{-0.4f, -0.4f, 0}, {0.4f, -0.4f, 0}, {0, 0.4f, 0}})
        plate.corners.push_back({corner, {0, 0, 1}});
    plate.edges = {{Vec3{-0.4f, -0.4f, 0}, Vec3{0.4f, -0.4f, 0}}};
    Renderer& renderer = rendererOf(320, 240);
    renderer.setSolids({plate});
    DrawSettings settings = frontView(0);
    settings.wallCount = 1;
    settings.solids = {{{0.5f, 0.5f, 0.5f}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    const std::vector<Vertex> wall = {{0.2f, 0.9f, 0.5f, 1}};
    const Image whole = pictureBy(renderer, wall, settings);
    settings.clipLow.x = 0.5f;
    EXPECT_EQ(pictureBy(renderer, wall, settings), whole);
    settings.clipSolids = true;
    const Image cut = pictureBy(renderer, wall, settings);
    renderer.setSolids({});
    DrawSettings none = frontView(0);
    const Image empty = picture({}, none);
    int left = 0, right = 0;
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 320; ++x) {
            const Rgb a = pixel(cut, x, y), b = pixel(empty, x, y);
            const bool seen = std::abs(a.g - b.g) > 8;
            left += seen && x < 158, right += seen && x > 162;
        }
    EXPECT_EQ(left, 0) << "what was there is gone: plate, edge and boundary particle";
    EXPECT_GT(right, 1000);
}

int area(const Image& image, const Image& bare) { return changed(image, bare); }

DrawSettings orthographic(DrawSettings settings) {
    settings.camera.orthographic = true, settings.camera.depth = 4;
    return settings;
}

TEST(Orthographic, NothingGetsSmallerWithDistance) {
    const DrawSettings near = frontView(1), flat = orthographic(near);
    const Image bare = picture({}, frontView(0)),
                bareFlat = picture({}, orthographic(frontView(0)));
    const auto at = [](float z) { return std::vector<Vertex>{{0.5f, 0.5f, z, 0.5f}}; };
    const int middle = area(picture(at(0.5f), near), bare);
    EXPECT_GT(middle, 200);
    EXPECT_GT(area(picture(at(1.0f), near), bare), 1.3 * middle) << "it does in perspective";
    for (const float z : {0.0f, 0.5f, 1.0f})
        EXPECT_NEAR(area(picture(at(z), flat), bareFlat), middle, 0.03 * middle) << z;
}

TEST(Orthographic, WhatIsUnderAPixelIsThere) {
    for (const bool surface : {false, true})
        for (const int samples : {1, 4}) {
            Renderer& renderer = rendererOf(320, 240, samples);
            pictureBy(renderer, block(), orthographic([&] {
                          DrawSettings s = viewOf(216, surface);
                          s.camera.yaw = s.camera.pitch = 0;
                          s.camera.target = {0.55f, 0.55f, 0.5f};  // a particle's middle
                          return s;
                      }()));
            const auto at = renderer.surfaceAt(160, 120);
            ASSERT_TRUE(at.has_value());
            EXPECT_NEAR(at->z, 0.8f, 0.03f);
            EXPECT_NEAR(at->x, 0.55f, 0.01f);
            EXPECT_FALSE(renderer.surfaceAt(5, 5).has_value());
        }
}

TEST(Orthographic, SurfaceCoversWhatSpheresDo) {
    const Image bare = picture({}, orthographic(viewOf(0)));
    const int spheres = area(picture(block(), orthographic(viewOf(216))), bare),
              surface = area(picture(block(), orthographic(viewOf(216, true))), bare);
    EXPECT_GT(spheres, 5000);
    EXPECT_NEAR(surface, spheres, 0.15 * spheres);
}

TEST(Orthographic, CameraLooksAlongAxes) {
    for (const Vec3 up : {Vec3{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}})
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {1.0f, -1.0f}) {
                OrbitCamera camera;
                camera.upward = up;
                Vec3 from{0, 0, 0};
                from[axis] = side;
                camera.lookFrom(from);
                EXPECT_NEAR(dot(camera.forward(), from), -1, 1e-5f);
            }
}

// Values by x on the plane z = 0.5, from 0 to 1; fluid where x < 0.7.
SliceField plane() {
    SliceField field;
    field.corner = {0, 0, 0.5f}, field.across = {1, 0, 0}, field.along = {0, 1, 0};
    field.columns = 100, field.rows = 10;
    for (int i = 0; i < 1000; ++i) {
        const float x = (float(i % 100) + 0.5f) / 100;
        field.points.push_back({x, x < 0.7f ? 1.0f : 0.0f});
    }
    return field;
}
// Where a place on it is in a picture from the front, orthographic.
int columnOf(float x) {
    const float half = 3 * std::tan(20 * 3.14159265f / 180);
    return int(160 + (x - 0.5f) / half * 120);
}

TEST(Slice, HasTheColoursOfTheTable) {
    const SliceField field = plane();
    for (const ColorMap map : {ColorMap::Viridis, ColorMap::Coolwarm})
        for (const int samples : {1, 4}) {
            DrawSettings settings = orthographic(frontView(0));
            settings.map = map;
            const Image bare = picture({}, settings, samples);
            settings.slice = &field;
            const Image image = picture({}, settings, samples);
            const ColorTable table = colorTable(map);
            for (const float x : {0.1f, 0.3f, 0.5f, 0.65f}) {
                const Rgb c = pixel(image, columnOf(x), 120);
                const auto& wanted = table[size_t(x * 255)];
                EXPECT_NEAR(c.r, wanted[0], 5) << x;
                EXPECT_NEAR(c.g, wanted[1], 5) << x;
                EXPECT_NEAR(c.b, wanted[2], 5) << x;
            }
            const Rgb outside = pixel(image, columnOf(0.75f), 120),
                      nothing = pixel(bare, columnOf(0.75f), 120);
            EXPECT_EQ(outside.g, nothing.g) << "there is no fluid";
        }
}

TEST(Slice, IsHiddenByWhatIsInFront) {
    const SliceField field = plane();
    DrawSettings settings = orthographic(frontView(1));
    settings.slice = &field;
    const auto at = [](float z) { return std::vector<Vertex>{{0.3f, 0.5f, z, 1}}; };
    const Image behind = picture(at(0.2f), settings), before = picture(at(0.9f), settings);
    EXPECT_GT(changed(before, behind), 100);
    DrawSettings none = settings;
    none.fluidCount = 0;
    EXPECT_EQ(changed(behind, picture({}, none)), 0);
    settings.fluid = false;
    EXPECT_EQ(changed(picture(at(0.9f), settings), picture({}, none)), 0);
}

TEST(Slice, HasALineWhereAValueIsRound) {
    const SliceField field = plane();
    for (const float step : {0.1f, 0.2f}) {
        DrawSettings settings = orthographic(frontView(0));
        settings.slice = &field;
        const Image smooth = picture({}, settings, 4, 960, 720);
        settings.contourStep = step;
        const Image lined = picture({}, settings, 4, 960, 720);
        int lines = 0;
        bool inLine = false;
        std::vector<int> columns;
        for (int x = 0; x < 960; ++x) {
            const bool dark = pixel(lined, x, 360).g < 0.6 * pixel(smooth, x, 360).g;
            if (dark && !inLine) ++lines, columns.push_back(x);
            inLine = dark;
        }
        // Within the fluid, its end at 0.7 left out.
        EXPECT_NEAR(lines, step == 0.1f ? 6 : 3, 1) << step;
        ASSERT_GE(columns.size(), 2u);
        const float half = 3 * std::tan(20 * 3.14159265f / 180), perMetre = 360 / half;
        EXPECT_NEAR(float(columns[1] - columns[0]), step * perMetre, 3);
    }
}

// In the middle of the scale is the geometric mean.
TEST(LogarithmicScale, IsEvenInPowersOfTen) {
    DrawSettings settings = orthographic(frontView(1));
    settings.rangeMin = 0.01f, settings.rangeMax = 100;
    DrawSettings linear = settings;
    settings.logarithmic = true;
    const auto of = [](float value) { return std::vector<Vertex>{{0.5f, 0.5f, 0.5f, value}}; };
    linear.rangeMin = 0, linear.rangeMax = 1;
    for (const auto& [value, share] : {std::pair{0.01f, 0.0f},
                                       {0.1f, 0.25f},
                                       {1.0f, 0.5f},
                                       {10.0f, 0.75f},
                                       {100.0f, 1.0f},
                                       {0.0f, 0.0f},
                                       {-5.0f, 0.0f}})
        EXPECT_EQ(changed(picture(of(value), settings), picture(of(share), linear), 3), 0) << value;
}

TEST(OwnColors, AreThoseOfTheirTable) {
    DrawSettings settings = frontView(1), own = settings;
    const std::vector<Vertex> one = {{0.5f, 0.5f, 0.5f, 0.3f}};
    own.map = ColorMap::File, own.ownColors = colorTable(ColorMap::Turbo);
    EXPECT_GT(changed(picture(one, settings), picture(one, own)), 100);
    settings.map = ColorMap::Turbo;
    EXPECT_EQ(picture(one, settings), picture(one, own));
}

TEST(Themes, AreDarkAndLight) {
    DrawSettings settings = viewOf(0);
    settings.ground = settings.outline = true;
    settings.legend = LegendText{"velocity", "m/s", "fixed"};
    const Image dark = picture({}, settings, 4, 640, 480);
    settings.theme = Theme::Light;
    const Image light = picture({}, settings, 4, 640, 480);
    for (const auto& [x, y] : {std::pair{5, 5}, {320, 20}, {320, 240}, {630, 470}}) {
        EXPECT_LT(pixel(dark, x, y).g, 90) << x << " " << y;
        EXPECT_GT(pixel(light, x, y).g, 150) << x << " " << y;
    }
}

TEST(Marks, BarIsAsLongAsItSays) {
    DrawSettings settings = orthographic(frontView(0));
    const Image bare = picture({}, settings, 4, 1200, 800);
    for (const float distance : {0.01f, 0.7f, 3.0f, 12.0f, 500.0f}) {
        settings.camera.distance = distance;
        settings.scale = true;
        const Image image = picture({}, settings, 4, 1200, 800);
        int longest = 0;
        for (int y = 700; y < 800; ++y)
            for (int x = 600, run = 0; x < 1200; ++x) {
                run = pixel(image, x, y).r > 200 ? run + 1 : 0;
                longest = std::max(longest, run);
            }
        const double metres = longest * 2 * distance * std::tan(20 * 3.14159265 / 180) / 800;
        const double power = std::pow(10, std::floor(std::log10(metres * 1.02)));
        const double factor = metres / power;
        const double nearest = factor < 1.4 ? 1 : factor < 3 ? 2 : factor < 7 ? 5 : 10;
        EXPECT_NEAR(factor / nearest, 1, 0.02) << distance;
        EXPECT_GT(longest, 70);
    }
    settings.scale = false, settings.axes = true, settings.camera.distance = 3;
    EXPECT_GT(changed(bare, picture({}, settings, 4, 1200, 800)), 100);
}

// To where x, y and z point in the picture.
TEST(Marks, AxesPointWhereTheyPoint) {
    DrawSettings settings = orthographic(frontView(0));
    settings.axes = true;
    settings.camera.yaw = 0;
    const auto reach = [&](int axis) {
        const Image image = picture({}, settings, 4, 1200, 800);
        const Vec3 wanted = axisColors[size_t(axis)];
        int right = 0, up = 0;
        for (int y = 650; y < 800; ++y)
            for (int x = 1050; x < 1200; ++x) {
                const Rgb c = pixel(image, x, y);
                const Vec3 seen = (1 / 255.0f) * Vec3{float(c.r), float(c.g), float(c.b)};
                if (length(seen - wanted) > 0.06f) continue;
                const int dx = x - int(1200 - 62 * unitOf(1200, 800)),
                          dy = int(800 - 62 * unitOf(1200, 800)) - y;
                if (std::abs(dx) > std::abs(right)) right = dx;
                if (std::abs(dy) > std::abs(up)) up = dy;
            }
        return std::pair{right, up};
    };
    EXPECT_GT(reach(0).first, 25);
    EXPECT_LT(std::abs(reach(0).second), 5);
    EXPECT_GT(reach(1).second, 25);
    settings.camera.yaw = 90;
    EXPECT_LT(reach(2).first, -25);
}

TEST(Marks, ArrowsGoFromHereToThere) {
    DrawSettings settings = orthographic(frontView(0));
    const Image bare = picture({}, settings);
    settings.arrows = {{{0.2f, 0.5f, 0.5f}, {0.8f, 0.5f, 0.5f}}};
    const Image image = picture({}, settings);
    int first = 320, last = 0;
    for (int x = 0; x < 320; ++x)
        if (pixel(image, x, 120).r > 150) first = std::min(first, x), last = std::max(last, x);
    EXPECT_NEAR(first, columnOf(0.2f), 3);
    EXPECT_NEAR(last, columnOf(0.8f), 3);
    EXPECT_GT(changed(image, bare), 100);
    settings.arrows = {{{0.2f, 0.5f, 0.5f}, {0.2f, 0.5f, 0.5f}}};
    EXPECT_EQ(changed(picture({}, settings), bare, 0), 0) << "of fluid at rest";
}

}  // namespace
}  // namespace spindrift
