// A tube full of fluid is squeezed: the fluid goes to the other end, nobody leaves through the
// wall, whatever the sizes of particles and the reach of contacts; slit, it bleeds through the
// slit.
#include "scene/json.h"
#include "scene/sample_object.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace spindrift {
namespace {

// Rings of particles around the tube; a point is inside if it lies in the polygon between the two
// beside it, seen along the tube.
class Rings {
public:
    explicit Rings(const ObjectSample& tube) {
        while (size_ < tube.size() && tube.positions[size_].x == tube.positions[0].x) ++size_;
    }
    bool inside(const std::vector<Vec3>& places, Vec3d p) const {
        auto middle = [&](size_t first) {
            double sum = 0;
            for (size_t k = 0; k < size_; ++k) sum += places[first + k].x / double(size_);
            return sum;
        };
        size_t ring = 0;
        while (ring + 2 * size_ < places.size() && middle(ring + size_) < p.x) ring += size_;
        const double from = middle(ring), share = (p.x - from) / (middle(ring + size_) - from);
        auto corner = [&](size_t k) {
            const Vec3d a = toDouble(places[ring + k % size_]),
                        b = toDouble(places[ring + size_ + k % size_]);
            return a + share * (b - a);
        };
        bool in = false;
        for (size_t k = 0; k < size_; ++k) {
            const Vec3d a = corner(k), b = corner(k + 1);
            const bool crosses = (a.z > p.z) != (b.z > p.z);
            if (crosses && p.y < a.y + (b.y - a.y) * (p.z - a.z) / (b.z - a.z)) in = !in;
        }
        return in;
    }

private:
    size_t size_ = 0;
};

Scene artery() {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/artery_small.json");
    scene.compute.backend = Backend::Cpu;
    return scene;
}

void runUntil(Simulation& simulation, double time) {
    simulation.stopAt(time);
    while (simulation.clock().time < time) simulation.step(1);
}

TEST(Artery, NobodyLeavesThroughTheWall) {
    for (const float ratio : {1.0f, 2.0f, 4.0f})
        for (const float influence : {1.25f, 1.5f, 1.75f}) {
            if ((ratio == 2) != (influence == 1.5f)) continue;  // the middle and the corners
            Scene scene = artery();
            scene.objects[0].spacing = ratio * scene.simulation.spacing,
            scene.contact.influence = influence;
            auto simulation = makeSimulation(scene);
            const Rings rings(sampleObjects(scene));
            auto farEnd = [&] {  // share of the fluid beyond the plates
                double n = 0;
                for (const Particle& p : simulation->particles()) n += p.position.x > 0.08;
                return n / simulation->fluidCount();
            };
            runUntil(*simulation, 0.05);
            const double before = farEnd();
            runUntil(*simulation, 0.3);
            const std::vector<Vec3> places = simulation->state().objects.positions;
            int escaped = 0;
            for (const Particle& p : simulation->particles())
                escaped += !rings.inside(places, p.position);
            std::printf(
                "wall / fluid %g, influence %g: %d of %d escaped, beyond the plates %.1f -> %.1f "
                "%%\n",
                ratio, influence, escaped, simulation->fluidCount(), 100 * before, 100 * farEnd());
            EXPECT_EQ(escaped, 0) << ratio << " " << influence;
            EXPECT_GT(farEnd(), before + 0.01) << ratio << " " << influence;
        }
}

// The mouse wants a plate on the other side of the tube; its hand is not strong enough to press the
// fluid through the wall.
TEST(Artery, HoldsWhenAPlateIsDraggedIntoIt) {
    constexpr int plate = 2;
    Scene scene = artery();
    scene.objects[0].spacing = 2 * scene.simulation.spacing;
    for (Solid& solid : scene.solids) solid.keyframes.clear();
    auto simulation = makeSimulation(scene);
    const Rings rings(sampleObjects(scene));
    const Vec3 middle = 0.5f * (scene.solids[plate].min + scene.solids[plate].max);
    simulation->hold({plate, middle + Vec3{0, 0, 0.06f}});
    double fastest = 0;
    for (double time = 0.02; time < 0.25; time += 0.02) {
        runUntil(*simulation, time);
        fastest = std::max(fastest, simulation->measure().maxSpeed);
    }
    const std::vector<Vec3> places = simulation->state().objects.positions;
    int escaped = 0;
    for (const Particle& p : simulation->particles()) escaped += !rings.inside(places, p.position);
    const Vec3d at = simulation->measure().solids[plate].position;
    const double moved = length(at - toDouble(middle));
    std::printf("%d of %d escaped, fastest %.2f m/s, the plate moved %.1f mm\n", escaped,
                simulation->fluidCount(), fastest, 1e3 * moved);
    EXPECT_EQ(escaped, 0);
    EXPECT_LT(fastest, 2);
    EXPECT_GT(moved, 0.002);
    EXPECT_LT(moved, 0.03);
}

TEST(Artery, BleedsThroughTheSlitOnly) {
    Scene scene = artery();
    setKnob(scene, R"(cuts=[{"time":0.1,"min":[0.09,0.012,0.06],"max":[0.12,0.02,0.12]}])");
    auto simulation = makeSimulation(scene);
    const Rings rings(sampleObjects(scene));
    std::set<int> out;
    for (double time = 0.01; time < 0.305; time += 0.01) {
        runUntil(*simulation, time);
        const std::vector<Vec3> places = simulation->state().objects.positions;
        for (const Particle& p : simulation->particles()) {
            if (rings.inside(places, p.position) || !out.insert(p.id).second) continue;
            EXPECT_GT(time, 0.1);
            EXPECT_TRUE(p.position.x > 0.08 && p.position.x < 0.13 && p.position.z > 0.06)
                << time << ": " << p.position.x << " " << p.position.y << " " << p.position.z;
        }
    }
    std::printf("%zu of %d bled\n", out.size(), simulation->fluidCount());
    EXPECT_GT(out.size(), 20u);
}

}  // namespace
}  // namespace spindrift
