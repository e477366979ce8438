// What gauges read of fields that are known.
#include "measure/probes.h"

#include "core/error.h"
#include "meshes.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/make_simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace spindrift {
namespace {

// A pool H = 0.4 m deep on its lattice, 1 m wide, whose fields are linear.
Scene poolScene(int dimensions, const std::string& probes) {
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = dimensions == 2 ? 0.01f : 0.04f;
    scene.domain = {{1, 2, 3}, {2, 3, 3.4f}};
    scene.fluid.bodies = {Body{{.min{1, 2, 3}, .max{2, 2.4f, 3.4f}}}};
    setKnob(scene, "output.probes=" + probes);
    return scene;
}
double pressureAt(Vec3d x) { return 4000 * (2.4 - x.y) + 100 * x.x; }
std::vector<Particle> particlesOf(const Scene& scene) {
    std::vector<Particle> particles;
    for (const Vec3& p : placeParticles(scene).positions) {
        Particle one;
        one.id = int(particles.size());
        one.position = toDouble(p) + toDouble(scene.domain.min);
        one.velocity = {one.position.y, 2, -one.position.x};
        one.density = 1000 + one.position.y;
        one.pressure = pressureAt(one.position);
        particles.push_back(one);
    }
    return particles;
}
double reading(const Scene& scene, const std::string& column,
               const std::vector<Particle>& particles) {
    const Probes probes(scene);
    const std::vector<double> values = probes.read(particles);
    EXPECT_EQ(values.size(), probes.columns().size());
    return values[probes.column(column)];
}
double reading(const Scene& scene, const std::string& column) {
    return reading(scene, column, particlesOf(scene));
}

TEST(Probes, ColumnsHaveNamesAndUnits) {
    const Scene scene = poolScene(3,
                                  R"([{"name":"a","position":[1.5,2.2,3.2]},
             {"kind":"line","name":"b","from":[1,2,3],"to":[2,2,3],"count":2},
             {"kind":"height","name":"c","position":[1.5,0,3.2]},
             {"kind":"front","name":"d","axis":"x"}])");
    std::string all;
    const Probes probes(scene);
    for (const Column& c : probes.columns()) all += c.name + "|" + c.unit + " ";
    EXPECT_EQ(all,
              "a.pressure|Pa a.density|kg/m³ a.velocity_x|m/s a.velocity_y|m/s a.velocity_z|m/s "
              "b[0].pressure|Pa b[0].density|kg/m³ b[0].velocity_x|m/s b[0].velocity_y|m/s "
              "b[0].velocity_z|m/s "
              "b[1].pressure|Pa b[1].density|kg/m³ b[1].velocity_x|m/s b[1].velocity_y|m/s "
              "b[1].velocity_z|m/s "
              "c.height|m d.front|m ");
    EXPECT_FALSE(Probes(Scene{}).any());
    EXPECT_THROW(Probes(scene).column("e.pressure"), Error);
}

TEST(Probes, LinearFieldsExactlyAlsoAtTheFloorAndOverASensor) {
    for (int dimensions : {2, 3}) {
        const Scene scene =
            poolScene(dimensions, R"([{"name":"floor","position":[1.5,2,3.2],"order":"linear"},
            {"name":"disc","position":[2,2.2,3.2],"radius":0.05,"order":"linear"},
            {"name":"ball","position":[1.5,2.2,3.2],"radius":0.05,"order":"linear"},
            {"name":"corner","position":[2,2.01,3.2],"radius":0.03,"order":"linear"},
            {"kind":"line","name":"line","from":[1.1,2.1,3.2],"to":[1.9,2.3,3.2],"count":3,
              "order":"linear"}])");
        EXPECT_NEAR(reading(scene, "floor.pressure"), pressureAt({1.5, 2, 0}), 1e-2);
        EXPECT_NEAR(reading(scene, "floor.density"), 1002, 1e-4);
        EXPECT_NEAR(reading(scene, "floor.velocity_x"), 2, 1e-5);
        EXPECT_NEAR(reading(scene, "floor.velocity_z"), -1.5, 1e-5);
        EXPECT_NEAR(reading(scene, "disc.pressure"), pressureAt({2, 2.2, 0}), 1e-2)
            << "points beyond the wall count";
        EXPECT_NEAR(reading(scene, "corner.pressure"), pressureAt({2, 2.02, 0}), 1e-2)
            << "points below the floor count";
        EXPECT_NEAR(reading(scene, "ball.pressure"), pressureAt({1.5, 2.2, 0}), 1e-2);
        EXPECT_NEAR(reading(scene, "line[2].pressure"), pressureAt({1.9, 2.3, 0}), 1e-2);
    }
}

// Half in the air, half in the water: a mean over its points, the dry ones as 0.
TEST(Probes, ASensorIsAMean) {
    Scene scene =
        poolScene(2, R"([{"name":"s","position":[1,2.45,0],"radius":0.09,"order":"linear"}])");
    EXPECT_NEAR(reading(scene, "s.pressure"), pressureAt({1, 2.39, 0}) / 3, 1e-2);
    EXPECT_NEAR(reading(scene, "s.density"), 1002.39 / 3, 1e-3);
}

TEST(Probes, MeanNeverGoesBeyondTheParticlesValues) {
    const Scene scene = poolScene(2, R"([{"name":"m","position":[1.5,2,0]}])");
    EXPECT_LT(reading(scene, "m.pressure"), pressureAt({1.5, 2.005, 0}));
    EXPECT_GT(reading(scene, "m.pressure"), pressureAt({1.5, 2.02, 0}));
}

// Beside a thin solid, wherever it is by now, on either side that side's fluid alone is read.
TEST(Probes, ThinSolidsAreNotSeenThrough) {
    Scene scene;
    scene.simulation.dimensions = 2;
    scene.simulation.spacing = 0.02f;
    scene.domain.max = {0.4f, 0.4f, 0.2f};
    setKnob(scene, R"(solids=[{"shape":"block","min":[0.1,0,0],"max":[0.104,0.4,0.2]}])");
    setKnob(scene, R"(output.probes=[{"name":"left","position":[0.19,0.2,0]},
                                     {"name":"right","position":[0.215,0.2,0]}])");
    std::vector<Particle> particles;
    for (int i = 0; i < 400; ++i) {
        Particle p;
        p.position = {0.01 + 0.02 * (i % 20), 0.01 + 0.02 * (i / 20), 0.1};
        p.pressure = p.position.x < 0.2 ? 1000 : 300;
        particles.push_back(p);
    }
    const SolidPose moved{{0.202, 0.2, 0.1}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const Probes probes(scene);
    const std::vector<double> values = probes.read(particles, {moved});
    EXPECT_NEAR(values[probes.column("left.pressure")], 1000, 1e-6);
    EXPECT_NEAR(values[probes.column("right.pressure")], 300, 1e-6);
}

TEST(Probes, PeriodicSidesAreSeenThrough) {
    Scene scene = poolScene(2, R"([{"name":"side","position":[1,2.2,0]}])");
    EXPECT_NEAR(reading(scene, "side.pressure"), pressureAt({1.01, 2.2, 0}), 1.0);
    scene.domain.periodicX =
        true;  // 1 m further on the pressure is 100 Pa higher: half of the neighbours have that
    EXPECT_NEAR(reading(scene, "side.pressure"), pressureAt({1.5, 2.2, 0}), 1.0);
}

TEST(Probes, HeightIsTheSurfaceOfThePool) {
    for (int dimensions : {2, 3})
        for (const char* x : {"1", "1.5", "2"}) {  // at both walls too
            const Scene scene =
                poolScene(dimensions, std::string(R"([{"kind":"height","name":"h","position":[)") +
                                          x + ",0,3.2]}]");
            EXPECT_NEAR(reading(scene, "h.height"), 2.4, 0.05 * scene.simulation.spacing)
                << dimensions << " at " << x;
        }
    Scene sideways =
        poolScene(2, R"([{"kind":"height","name":"h","position":[0,2.1,0],"axis":"x"}])");
    sideways.fluid.bodies[0].max.x = 1.6f;
    EXPECT_NEAR(reading(sideways, "h.height"), 1.6, 0.0005);
}

TEST(Probes, HeightCountsThinFilmsOnTheFloorWavesAboveAirAndNoSpray) {
    Scene scene = poolScene(2, R"([{"kind":"height","name":"h","position":[1.5,0,0]}])");
    const std::vector<Particle> pool = particlesOf(scene);
    auto with = [&](double low, double high, double width, bool wet) {
        std::vector<Particle> all;
        if (wet) all = pool;
        Particle p = pool[0];
        for (double y = low + 0.005; y < high; y += 0.01)
            for (double x = 1.505 - width / 2; x < 1.5 + width / 2; x += 0.01)
                p.position.x = x, p.position.y = y, all.push_back(p);
        return reading(scene, "h.height", all);
    };
    EXPECT_NEAR(with(2.7, 2.72, 0.02, true), 2.4, 5e-4)
        << "a drop of four particles is no water level";
    EXPECT_NEAR(with(2.7, 2.8, 0.3, true), 2.8, 5e-4) << "the lip of a breaking wave is";
    EXPECT_NEAR(with(2, 2.02, 0.5, false), 2.02, 1e-3) << "two layers on the floor";
    EXPECT_EQ(with(2, 2, 0, false), 2) << "dry";
}

TEST(Probes, FrontLeavesHalfAPerCentOut) {
    Scene scene = poolScene(2, R"([{"kind":"front","name":"f","axis":"x"}])");
    std::vector<Particle> particles = particlesOf(scene);
    const size_t spray = particles.size() / 250;
    for (size_t i = 0; i < spray; ++i) particles[i].position.x = 5;
    EXPECT_NEAR(reading(scene, "f.front", particles), 1.995, 0.011);
}

// As one loop over all pairs finds them, in any order of points.
TEST(Probes, CellsFindEveryNeighbour) {
    const Scene scene = poolScene(3, "[]");
    const std::vector<Particle> particles = particlesOf(scene);
    std::vector<Vec3d> points;
    for (int k = 0; k < 60; ++k)
        points.push_back({1 + std::fmod(0.37 * k, 1), 2 + std::fmod(0.71 * k, 0.5),
                          3 + std::fmod(0.13 * k, 0.4)});
    const std::vector<Fields> fields = interpolate(particles, points, 0.09);
    for (size_t i = 0; i < points.size(); ++i) {
        int expected = 0;
        for (const Particle& p : particles) expected += length(p.position - points[i]) < 0.09;
        EXPECT_EQ(fields[i].neighbours, expected) << i;
    }
    Particle nowhere = particles[0];
    nowhere.position.x = std::nan("");
    EXPECT_EQ(interpolate({nowhere}, points, 0.09)[0].neighbours, 0);
}

// A box of 1 m with a little fluid, one solid, and probes.
Scene solidScene(int dimensions, const std::string& solid, const std::string& probes) {
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = 0.1f;
    scene.domain = {{1, 1, 1}, {2, 2, 2}};
    scene.fluid.bodies = {Body{{.min{1, 1.8f, 1}, .max{1.2f, 2, 2}}}};
    scene.compute.threads = 1;
    setKnob(scene, "solids=[{\"name\":\"thing\"," + solid + "}]");
    setKnob(scene, "output.probes=" + probes);
    return scene;
}
std::string hiddenIn(const Scene& scene) {
    return Probes(scene).hiddenBySolids(scene, *makeSimulation(scene));
}

struct Hidden {
    std::string solid;
    std::function<bool(Vec3)> inside;
    bool alsoFlat = true;
};

std::vector<Hidden> solidsOverProbes(const std::string& mesh) {
    const auto box = [](Vec3 low, Vec3 high) {
        return [=](Vec3 p) {
            return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y &&
                   p.z < high.z;
        };
    };
    const auto ball = [](Vec3 p) { return length(p - Vec3{1.5f, 1.5f, 1.5f}) < 0.35f; };
    const std::string block = R"("shape":"block","min":[1.3,1.3,1.3],"max":[1.8,1.6,1.7])";
    const std::string round = R"("center":[1.5,1.5,1.5],"radius":0.35)";
    return {
        {block, box({1.3f, 1.3f, 1.3f}, {1.8f, 1.6f, 1.7f})},
        {block + R"(,"keyframes":[[0,0.1,0.2,0],[1,0,0,0]])",
         box({1.4f, 1.5f, 1.3f}, {1.9f, 1.8f, 1.7f})},
        {block + R"(,"keyframes":[[0,0,0,0,90],[1,0,0,0,90]])",
         box({1.4f, 1.2f, 1.3f}, {1.7f, 1.7f, 1.7f})},
        {block + R"(,"velocity":[1,0,0],"spin":90)", box({1.3f, 1.3f, 1.3f}, {1.8f, 1.6f, 1.7f})},
        {block + R"(,"density":500)", box({1.3f, 1.3f, 1.3f}, {1.8f, 1.6f, 1.7f})},
        {R"("shape":"sphere",)" + round, ball, false},
        {R"("shape":"cylinder","axis":"z","height":0.6,)" + round,
         [](Vec3 p) {
             return std::hypot(p.x - 1.5f, p.y - 1.5f) < 0.35f && std::abs(p.z - 1.5f) < 0.3f;
         }},
        {R"("shape":"cylinder","axis":"x","height":0.6,)" + round,
         [](Vec3 p) {
             return std::hypot(p.y - 1.5f, p.z - 1.5f) < 0.35f && std::abs(p.x - 1.5f) < 0.3f;
         },
         false},
        {R"("shape":"wedge","min":[1.2,1,1.2],"max":[1.8,1.7,1.8])",
         [](Vec3 p) {
             return p.y > 1 && p.y < 1.7f - std::abs(p.x - 1.5f) * 0.7f / 0.3f &&
                    std::abs(p.z - 1.5f) < 0.3f;
         }},
        {R"("shape":"plane","center":[1,1.33,1],"normal":[0,3,0])",
         [](Vec3 p) { return p.y < 1.33f; }},
        {R"("shape":"mesh","scale":2,"offset":[1.1,1.2,1.1],"path":")" + mesh + "\"",
         box({1.3f, 1.4f, 1.3f}, {1.7f, 1.8f, 1.9f}), false},
    };
}

// Every shape, standing, moved, turned and floating, against points that are known to be in or out.
TEST(Probes, SayThatTheyAreInASolid) {
    const std::string mesh = dentedBoxSurface({0.1, 0.1, 0.1}, {0.3, 0.3, 0.4})
                                 .write(::testing::TempDir() + "hiding.obj");
    std::string probes = "[";
    std::vector<Vec3> points;
    for (int i = 0; i < 125; ++i) {
        const Vec3 p{1.13f + 0.18f * float(i % 5), 1.14f + 0.17f * float(i / 5 % 5),
                     1.11f + 0.19f * float(i / 25)};
        points.push_back(p);
        probes += fmt::format("{}{{\"name\":\"p{}\",\"position\":[{},{},{}]}}", i ? "," : "", i,
                              p.x, p.y, p.z);
    }
    probes += "]";
    for (const Hidden& h : solidsOverProbes(mesh))
        for (const int dimensions : {3, 2}) {
            if (dimensions == 2 && !h.alsoFlat) continue;
            const std::string said = hiddenIn(solidScene(dimensions, h.solid, probes));
            int inside = 0;
            for (size_t i = 0; i < points.size(); ++i) {
                const Vec3 p{points[i].x, points[i].y, dimensions == 2 ? 1.5f : points[i].z};
                const std::string words =
                    fmt::format("output.probes[{}] (p{}) is inside solids[0] (thing)", i, i);
                EXPECT_EQ(said.find(words) != std::string::npos, h.inside(p))
                    << h.solid << ", dimensions " << dimensions << " at " << i;
                inside += h.inside(p);
            }
            EXPECT_GT(inside, 2) << h.solid;
            EXPECT_LT(inside, 125) << h.solid;
        }
}

TEST(Probes, SayHowMuchOfALineAndWhenAGaugeIsInASolid) {
    const std::string pier = R"("shape":"block","min":[1.4,1,1],"max":[1.6,1.5,2])";
    const std::string line =
        R"([{"kind":"line","name":"l","from":[1.5,1.05,1.5],"to":[1.5,1.95,1.5],"count":10}])";
    EXPECT_EQ(
        hiddenIn(solidScene(3, pier, line)),
        "output.probes[0] (l) 5 of its 10 points are inside solids[0] (thing): no fluid can be "
        "read there; move one of the two");
    const auto gaugeAt = [&](float x) {
        return fmt::format(R"([{{"kind":"height","name":"g","position":[{},1,1.5]}}])", x);
    };
    EXPECT_NE(hiddenIn(solidScene(3, pier, gaugeAt(1.5f)))
                  .find("(g) finds no water and goes through solids[0] (thing)"),
              std::string::npos);
    EXPECT_EQ(hiddenIn(solidScene(3, pier, gaugeAt(1.4f))), "") << "in the pier's face";
    EXPECT_EQ(hiddenIn(solidScene(3, pier, gaugeAt(1.8f))), "") << "dry, but free";
    Scene under = solidScene(3, pier, gaugeAt(1.5f));
    under.fluid.bodies = {Body{{.min{1, 1, 1}, .max{2, 1.9f, 2}}}};
    EXPECT_EQ(hiddenIn(under), "") << "the water above it is read";
    EXPECT_EQ(hiddenIn(solidScene(3, pier, R"([{"kind":"front","name":"f"}])")), "");
    Scene around = solidScene(3, R"("shape":"block","min":[1.9,1,1],"max":[2.1,1.5,2])",
                              R"([{"name":"p","position":[1.05,1.2,1.5]}])");
    EXPECT_EQ(hiddenIn(around), "");
    around.domain.periodicX = true;
    EXPECT_NE(hiddenIn(around), "") << "its image on the other side";
}

}  // namespace
}  // namespace spindrift
