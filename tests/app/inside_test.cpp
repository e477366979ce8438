// What a slice and arrows show of a fluid, without a picture.
#include "app/frame.h"
#include "app/inside.h"
#include "core/error.h"
#include "scene/check.h"
#include "scene/color_file.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

namespace spindrift {
namespace {

// Fluid in the lower half of a domain of 1 m, on a lattice.
Scene half(int dimensions, float spacing, Across axis) {
    Scene scene;
    scene.simulation.dimensions = dimensions, scene.simulation.spacing = spacing;
    scene.domain = {{2, 3, 4}, {3, 4, 5}};
    scene.view.slice.axis = axis;
    return scene;
}
std::vector<Vertex> fluidOf(const Scene& scene, const std::function<float(Vec3)>& value) {
    std::vector<Vertex> fluid;
    const float dx = scene.simulation.spacing;
    const int n = int(std::lround(1 / dx)), layers = scene.simulation.dimensions == 2 ? 1 : n;
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < n / 2; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec3 x{dx * (float(i) + 0.5f), dx * (float(j) + 0.5f),
                             layers == 1 ? 0.5f : dx * (float(k) + 0.5f)};
                fluid.push_back({x.x, x.y, x.z, value(x)});
            }
    return fluid;
}

struct Seen {
    Vec3 at;
    float value, cover;
};
std::vector<Seen> pointsOf(const SliceField& f) {
    std::vector<Seen> seen;
    for (int r = 0; r < f.rows; ++r)
        for (int c = 0; c < f.columns; ++c) {
            const auto& [value, cover] = f.points[size_t(r * f.columns + c)];
            seen.push_back({f.corner + ((float(c) + 0.5f) / float(f.columns)) * f.across +
                                ((float(r) + 0.5f) / float(f.rows)) * f.along,
                            value, cover});
        }
    return seen;
}

TEST(Slice, IsWhereFluidIs) {
    for (const auto& [dimensions, axis] :
         {std::pair{3, Across::X}, {3, Across::Y}, {3, Across::Z}, {2, Across::Z}})
        for (const float position : {0.0f, 0.3f, 0.45f, 1.0f}) {
            const float dx = 0.04f;
            Scene scene = half(dimensions, dx, axis);
            scene.view.slice.position = position;
            const auto points = pointsOf(sliceOf(scene, fluidOf(scene, [](Vec3) { return 7; })));
            int inside = 0;
            for (const Seen& p : points) {
                const float below = 0.5f - p.at.y;  // the surface is at 0.5
                if (below > dx) {
                    EXPECT_GT(p.cover, 0.5f) << p.at.x << " " << p.at.y << " " << p.at.z;
                    EXPECT_NEAR(p.value, 7, 1e-4f);
                    ++inside;
                }
                if (below < -dx) { EXPECT_LT(p.cover, 0.5f) << p.at.y; }
            }
            const bool above = axis == Across::Y && position == 1;
            EXPECT_EQ(inside > 100, !above) << int(axis) << " " << position;
            if (axis == Across::Z) {
                EXPECT_FLOAT_EQ(slicePlace(scene), 4 + (dimensions == 2 ? 0.5f : position));
            }
        }
}

// A weighted mean on an even lattice: linear fields to the lattice's unevenness, others to order 2.
TEST(Slice, FieldIsOfSecondOrder) {
    for (const int dimensions : {2, 3}) {
        std::vector<double> errors;
        for (const float dx : {0.1f, 0.05f, 0.025f}) {
            const Scene scene = half(dimensions, dx, Across::Z);
            const auto f = [](Vec3 x) { return std::sin(6 * x.x) * std::cos(5 * x.y); };
            double square = 0, count = 0;
            for (const Seen& p : pointsOf(sliceOf(scene, fluidOf(scene, f)))) {
                if (p.at.y > 0.2f || p.at.y < 0.16f) continue;  // clear of floor and surface
                if (p.at.x < 0.3f || p.at.x > 0.7f) continue;
                square += std::pow(p.value - f(p.at), 2), ++count;
            }
            errors.push_back(std::sqrt(square / count));
        }
        for (size_t i = 1; i < errors.size(); ++i)
            EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.35)
                << dimensions << ": " << errors[i - 1] << " " << errors[i];
    }
}

TEST(Slice, DoesNotSeePastThinSolids) {
    const Scene scene = half(3, 0.05f, Across::Z);
    const auto fluid = fluidOf(scene, [](Vec3 x) { return x.x < 0.5f ? 0.0f : 1.0f; });
    const Sees sees = [](Vec3d a, Vec3d b) { return (a.x < 0.5) == (b.x < 0.5); };
    int mixed = 0;
    for (const Seen& p : pointsOf(sliceOf(scene, fluid, sees)))
        if (p.cover > 0) { EXPECT_EQ(p.value, p.at.x < 0.5f ? 0 : 1) << p.at.x; }
    for (const Seen& p : pointsOf(sliceOf(scene, fluid)))
        mixed += p.cover > 0.5f && p.value > 0.1f && p.value < 0.9f;
    EXPECT_GT(mixed, 10) << "without a solid it does";
}

std::vector<Particle> moving(const Scene& scene, const std::vector<Vertex>& fluid) {
    std::vector<Particle> particles;
    for (const Vertex& v : fluid) {
        Particle p;
        p.position = toDouble(scene.domain.min) + Vec3d{v.x, v.y, v.z};
        p.velocity = {1 + v.x, 2, 0};
        particles.push_back(p);
    }
    return particles;
}

TEST(Arrows, AreAtCellsOfTheFluid) {
    for (const auto& [dimensions, axis] :
         {std::pair{3, Across::None}, {3, Across::Z}, {2, Across::None}, {2, Across::Z}}) {
        Scene scene = half(dimensions, 0.05f, axis);
        scene.view.arrows.count = 10;
        const auto fluid = fluidOf(scene, [](Vec3) { return 0; });
        const auto arrows = velocitiesOf(scene, moving(scene, fluid));
        const bool plane = dimensions == 2 || axis != Across::None;
        EXPECT_EQ(arrows.size(), plane ? 50u : 500u) << dimensions << int(axis);
        for (const CellVelocity& a : arrows) {
            EXPECT_LT(a.middle.y, 0.5f);
            if (plane) { EXPECT_NEAR(a.middle.z, 0.5f, 1e-6f); }
            EXPECT_NEAR(a.velocity.x, 1 + a.middle.x, 1e-4f);
            EXPECT_NEAR(a.velocity.y, 2, 1e-5f);
        }
        const std::vector<Vertex> drop = {fluid[0]};
        EXPECT_TRUE(velocitiesOf(scene, moving(scene, drop)).empty()) << "one particle is no flow";
        if (axis != Across::None) continue;
        scene.view.clip.max.x = 0.5f;
        EXPECT_EQ(velocitiesOf(scene, moving(scene, fluid)).size(), arrows.size() / 2);
    }
}

// As many on the picture whatever the resolution is.
TEST(Arrows, AreAsManyAtEveryResolution) {
    for (const float dx : {0.1f, 0.05f, 0.025f}) {
        Scene scene = half(3, dx, Across::Z);
        scene.view.arrows.count = 10;
        const auto fluid = fluidOf(scene, [](Vec3) { return 0; });
        EXPECT_EQ(velocitiesOf(scene, moving(scene, fluid)).size(), 50u) << dx;
    }
}

TEST(ClipBox, IsInSharesOfTheDomainAndOpenAtItsEnds) {
    Scene scene = half(3, 0.1f, Across::None);
    scene.domain.max = {4, 4, 5};
    for (const Vec3 far : {Vec3{-9, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, -9}})
        EXPECT_TRUE(clipBox(scene).holds(far));
    scene.view.clip.min.x = 0.25f;
    EXPECT_FALSE(clipBox(scene).holds({0.49f, 0, 0}));
    EXPECT_TRUE(clipBox(scene).holds({0.51f, -9, 9}));
}

TEST(LogarithmicRange, IsPositive) {
    Scene scene;
    scene.view.colorScale = ColorScale::Logarithmic;
    // Without a picture before there is one value, 0.
    scene.view.range = RangeMode::Fixed, scene.view.rangeMin = 0.5f, scene.view.rangeMax = 50;
    const auto refused = [](const Scene& s) {
        try {
            checkScene(s, "scene", {});
        } catch (const Error&) { return true; }
        return false;
    };
    EXPECT_FALSE(refused(scene));
    scene.view.rangeMin = 0;
    EXPECT_TRUE(refused(scene));
    scene.view.colorScale = ColorScale::Linear;
    EXPECT_FALSE(refused(scene));
}

struct BadView {
    std::vector<const char*> knobs;
    const char* named;
};

TEST(View, RefusesWhatCanNotBeDrawn) {
    const std::vector<BadView> cases = {
        {{"view.clip.min=[0.5,0,0]", "view.clip.max=[0.5,1,1]"}, "view.clip.max"},
        {{"view.threshold.on=true", "view.threshold.min=2"}, "view.threshold.max"},
        {{"view.color_by=time_bin"}, "view.color_by"},
        {{"view.color_map=file"}, "view.color_file"},
        {{"view.color_map=file", "view.color_file=/no/such.csv"}, "/no/such.csv"},
        {{"simulation.dimensions=2", "view.slice.axis=x"}, "view.slice.axis"},
    };
    for (const BadView& bad : cases) {
        Scene scene;
        for (const char* knob : bad.knobs) setKnob(scene, knob);
        try {
            checkScene(scene, "scene", {});
            ADD_FAILURE() << bad.knobs[0] << " is let through";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(bad.named), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
        // A run that goes on is drawn as far as it can be.
        EXPECT_NO_THROW(checkScene(scene, "panel", ParticleCount{100, 100})) << bad.knobs[0];
    }
}

std::string fileWith(const std::string& name, const std::string& text) {
    const std::string path = (std::filesystem::path(testing::TempDir()) / name).string();
    std::ofstream(path) << text;
    return path;
}

TEST(ColorFile, IsReadInEachWriting) {
    const std::vector<std::pair<std::string, std::string>> same = {
        {"a.csv", "r,g,b\n255,0,0\n0,0,255\n"},
        {"b.csv", "# mine\nr;g;b\n1;0;0\n0;0;1\n"},
        {"c.csv", "at,r,g,b\n-3,1,0,0\n5,0,0,1\n"},
        {"d.json", "[[255,0,0],[0,0,255]]"},
        {"e.json", "[[1,0,0],[0.5,0,0.5],[0,0,1]]"},
        {"f.json", R"([{"Name":"mine","RGBPoints":[0,1,0,0, 10,0,0,1]}])"},
    };
    for (const auto& [name, text] : same) {
        const auto table = readColors(fileWith(name, text));
        for (size_t i = 0; i < table.size(); ++i) {
            EXPECT_NEAR(table[i][0], 255 - int(i), 1) << name;
            EXPECT_EQ(table[i][1], 0) << name;
            EXPECT_NEAR(table[i][2], int(i), 1) << name;
        }
    }
    const auto bent = readColors(fileWith("g.csv", "at,r,g,b\n0,0,0,0\n0.25,1,1,1\n1,0,0,0\n"));
    EXPECT_NEAR(bent[64][0], 255, 2);
    EXPECT_NEAR(bent[255][0], 0, 1);
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"h.csv", "r,g\n1,2\n"},
             {"i.csv", "r,g,b\n1,1,1\n"},
             {"j.csv", "r,g,b\n1,1,1\n-1,0,0\n"},
             {"k.csv", "r,g,b\n1,1,1\n256,0,0\n"},
             {"l.csv", "at,r,g,b\n1,1,1,1\n1,0,0,0\n"},
             {"m.json", "[1,2,3]"},
             {"n.json", R"({"Points":[]})"},
             {"o.json", "[[1,2]]"},
         })
        EXPECT_THROW(readColors(fileWith(name, text)), Error) << name;
}

}  // namespace
}  // namespace spindrift
