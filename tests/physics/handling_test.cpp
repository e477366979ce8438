// Each shipped scene survives somebody who drags its solids and stirs its fluid at random, through
// the calls that the mouse makes.
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> shippedScenes() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(SPINDRIFT_SOURCE_DIR "/configs"))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
}

// A coarse one of the same scene. Those of the original program say what a particle weighs, and the
// wall of the artery is as fine as its fluid.
Scene coarse(const std::string& name) {
    const bool small = name == "artery";
    Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR "/configs/") +
                            (small ? "test/artery_small" : name) + ".json");
    scene.compute.backend = Backend::Cpu;
    scene.compute.threads = 1;
    if (scene.simulation.formulation != Formulation::Classic && !small)
        while (countParticles(scene).fluid > 4000) scene.simulation.spacing *= 1.25f;
    return scene;
}

struct Dice {
    std::mt19937 random;
    double unit() { return (random() + 0.5) / 4294967296.0; }
    float between(double a, double b) { return float(a + (b - a) * unit()); }
    Vec3 inside(const Scene& scene) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = between(scene.domain.min[k], scene.domain.max[k]);
        return p;
    }
};

constexpr float Hand = 1;  // m/s, in a box of 1 m

// Takes hold of something else, or stirs elsewhere, or lets go.
void handle(Simulation& simulation, const Scene& scene, Dice& dice) {
    const float size = length(scene.domain.max - scene.domain.min);
    const int solids = int(scene.solids.size()), choice = int(dice.random() % 4);
    if (choice == 0) return simulation.hold({}), simulation.stir({});
    if (choice < 3 && solids > 0)
        return simulation.stir({}),
               simulation.hold({int(dice.random() % unsigned(solids)), dice.inside(scene)});
    Stir stir;
    stir.center = dice.inside(scene), stir.radius = size / 16;
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        stir.velocity[k] = dice.between(-Hand, Hand) * std::sqrt(size);
    simulation.hold({}), simulation.stir(stir);
}

// The fastest that anything has a reason to be, m/s.
double reason(const Scene& scene) {
    const double size = length(toDouble(scene.domain.max - scene.domain.min));
    double start = 0;
    for (const Body& body : scene.fluid.bodies)
        start = std::max<double>(start, length(body.velocity));
    return std::sqrt(start * start + 3 * Hand * Hand * size +
                     2 * length(toDouble(scene.simulation.gravity)) * size);
}

std::string amiss(const Scene& scene, Simulation& simulation) {
    const Measurement m = simulation.measure();
    if (!m.finite) return "no numbers";
    if (m.maxSpeed > 4 * reason(scene))
        return "somebody is as fast as " + std::to_string(m.maxSpeed) + " m/s, of " +
               std::to_string(reason(scene));
    const std::vector<SolidPose> poses = simulation.solidPoses();
    std::vector<Convex> shapes;
    for (const Solid& solid : scene.solids)
        shapes.push_back(convexOf(solid, scene.simulation.dimensions));
    const double dx = scene.simulation.spacing;
    for (const Particle& p : simulation.particles()) {
        const Vec3d x = p.position - toDouble(scene.domain.min), size = scene.domain.size();
        for (int k = 0; k < scene.simulation.dimensions; ++k)
            if (x[k] < -1e-4 * size[k] || x[k] > (1 + 1e-4) * size[k])
                return "particle " + std::to_string(p.id) + " left the box";
        for (size_t s = 0; s < shapes.size(); ++s) {
            const Vec3d arm = x - poses[s].middle;
            const Vec3d own{dot(arm, poses[s].axis[0]), dot(arm, poses[s].axis[1]),
                            dot(arm, poses[s].axis[2])};
            const double depth = -shapes[s].nearest(own).distance;
            // Of a mesh fluid sees what is between the nodes of a lattice.
            if (depth > (shapes[s].mesh ? 0.25 : 0.05) * dx)
                return "particle " + std::to_string(p.id) + " is " + std::to_string(depth / dx) +
                       " spacings in solid " + std::to_string(s);
        }
    }
    return "";
}

class Handled : public testing::TestWithParam<std::string> {};

TEST_P(Handled, AtRandom) {
    const Scene scene = coarse(GetParam());
    const auto simulation = makeSimulation(scene);
    const int particles = simulation->fluidCount();
    Dice dice{std::mt19937(7)};
    // As long as waves take to the other side, and half as long again; what takes longer less.
    const double size = length(toDouble(scene.domain.max - scene.domain.min)),
                 share = particles > 4100 || !scene.objects.empty() ? 0.3 : 1,
                 time = 1.5 * share * std::sqrt(size / 9.81);
    for (int k = 1; k <= 20; ++k) {
        handle(*simulation, scene, dice);
        simulation->stopAt(time * k / 20);
        for (int n = 0; simulation->clock().time < time * k / 20 && n < 20000; ++n)
            simulation->step();
        ASSERT_EQ(amiss(scene, *simulation), "") << "after " << time * k / 20 << " s";
        ASSERT_EQ(simulation->fluidCount(), particles);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Handled, testing::ValuesIn(shippedScenes()),
                         [](const auto& info) { return "Scene_" + info.param; });

}  // namespace
}  // namespace spindrift
