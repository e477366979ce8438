// Relaxed places: even, in no order, up to the bodies' surfaces, the same for the same seed.
#include "scene/check.h"
#include "scene/json.h"
#include "scene/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace spindrift {
namespace {

using std::numbers::pi;

// A box of 1 m that water fills, or whatever the knobs make of it.
Scene relaxedScene(int dimensions, float spacing, const std::vector<std::string>& knobs) {
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = spacing;
    scene.domain.max = {1, 1, 1};
    scene.fluid.bodies = {Body{{.max{1, 1, 1}}}};
    setKnob(scene, "simulation.placement=relaxed");
    for (const std::string& knob : knobs) setKnob(scene, knob);
    checkScene(scene);
    return scene;
}
const std::vector<std::string> Periodic2 = {"domain.periodic_x=true", "domain.periodic_y=true"};
const std::vector<std::string> Periodic3 = {"domain.periodic_x=true", "domain.periodic_y=true",
                                            "domain.periodic_z=true"};

struct Evenness {
    double mean = 0, scatter = 0, closest = 1e9;
};  // of sum V W; its rms / mean; in spacings

// Of the particles that see no surface that is not `inside`; walls count as their particles do.
Evenness evennessOf(const Scene& scene, const Placement& p, double margin) {
    const double dx = scene.simulation.spacing, R = 2.6 * dx, L = 1;
    const int d = scene.simulation.dimensions;
    const double norm = d == 2 ? 7 / (pi * R * R) : 21 / (2 * pi * R * R * R);
    Evenness e;
    double squares = 0;
    int count = 0;
    for (const Vec3& at : p.positions) {
        double sum = 0;
        bool inside = true;
        for (int k = 0; k < d; ++k)
            inside &= scene.domain.periodic(k) || (at[k] > margin * R && at[k] < L - margin * R);
        if (!inside) continue;
        for (const Vec3& other : p.positions) {
            Vec3d r = toDouble(at - other);
            for (int k = 0; k < d; ++k)
                if (scene.domain.periodic(k)) r[k] -= L * std::rint(r[k] / L);
            const double distance = length(r), q = distance / R;
            if (&other != &at) e.closest = std::min(e.closest, distance / dx);
            if (q < 1) sum += std::pow(dx, d) * norm * std::pow(1 - q, 4) * (1 + 4 * q);
        }
        e.mean += sum, squares += sum * sum, ++count;
    }
    e.mean /= count;
    e.scatter = std::sqrt(std::max(squares / count - e.mean * e.mean, 0.0)) / e.mean;
    return e;
}
// 1 where all particles are in rows a spacing apart, near 0 where they are anywhere.
double orderAlong(const Placement& p, int axis, double spacing) {
    std::complex<double> sum = 0;
    for (const Vec3& x : p.positions) sum += std::polar(1.0, 2 * pi * double(x[axis]) / spacing);
    return std::abs(sum) / double(p.positions.size());
}

TEST(Relax, APeriodicBoxIsEvenAndInNoOrder) {
    for (int dimensions : {2, 3}) {
        const float dx = dimensions == 2 ? 0.025f : 0.0625f;
        const Scene scene = relaxedScene(dimensions, dx, dimensions == 2 ? Periodic2 : Periodic3);
        const Placement p = placeParticles(scene);
        EXPECT_EQ(p.positions.size(), dimensions == 2 ? 1600u : 4096u);
        const Evenness e = evennessOf(scene, p, 0);
        EXPECT_LT(e.scatter, 0.005) << dimensions;
        EXPECT_NEAR(e.mean, 1.01, 0.005);  // as on a lattice, which has 1.013 and 1.010
        EXPECT_GT(e.closest, 0.8) << dimensions;
        for (int k = 0; k < dimensions; ++k) EXPECT_LT(orderAlong(p, k, dx), 0.2);
        for (const Vec3& x : p.positions) ASSERT_TRUE(dimensions == 3 || x.z == 0.5f);
    }
}

TEST(Relax, WallsAndCornersArePackedToo) {
    const Scene scene = relaxedScene(2, 0.025f, {});
    const Placement p = placeParticles(scene);
    EXPECT_EQ(p.positions.size(), 1600u);
    EXPECT_LT(evennessOf(scene, p, 1).scatter, 0.005);
    EXPECT_GT(evennessOf(scene, p, 0).closest, 0.75);
    // Three spacings along each wall hold what three rows of the lattice do; the first particles
    // stand off the wall as those do.
    for (int k = 0; k < 2; ++k)
        for (bool upper : {false, true}) {
            int beside = 0;
            for (const Vec3& x : p.positions) {
                const double from = upper ? 1 - x[k] : x[k];
                beside += from < 3 * 0.025;
                EXPECT_GT(from, 0.2 * 0.025);
            }
            EXPECT_NEAR(beside, 120, 6);
        }
}

TEST(Relax, ADropIsPackedToItsSurface) {
    for (int dimensions : {2, 3}) {
        const double r = 0.3, dx = dimensions == 2 ? 0.02 : 0.05;
        const Scene scene = relaxedScene(
            dimensions, float(dx),
            {R"(fluid.bodies=[{"shape":"sphere","center":[0.5,0.5,0.5],"radius":0.3}])"});
        const Placement p = placeParticles(scene);
        const double volume =
            dimensions == 2 ? pi * r * r / (dx * dx) : 4 * pi / 3 * r * r * r / (dx * dx * dx);
        EXPECT_NEAR(double(p.positions.size()), volume, 0.005 * volume) << "as many as fit";
        EXPECT_GE(countParticles(scene).fluid, int64_t(p.positions.size()));
        double second = 0;
        std::vector<double> outermost(24);
        for (const Vec3& x : p.positions) {
            const Vec3d from = toDouble(x) - Vec3d{0.5, 0.5, 0.5};
            second += dot(from, from) / double(p.positions.size());
            EXPECT_LT(length(from), r) << "beyond the surface";
            const size_t sector = size_t(12 * (1 + std::atan2(from.y, from.x) / pi)) % 24;
            outermost[sector] = std::max(outermost[sector], length(from));
        }
        for (double most : outermost) EXPECT_GT(most, r - 0.85 * dx) << "not round";
        EXPECT_NEAR(second / (r * r), dimensions == 2 ? 1.0 / 2 : 3.0 / 5, 0.01);
        EXPECT_GT(evennessOf(scene, p, 0).closest, 0.7);
    }
}

TEST(Relax, OneSeedOnePlacementForAnyNumberOfThreads) {
    Scene scene = relaxedScene(2, 0.05f, Periodic2);
    scene.compute.threads = 1;
    const Placement first = placeParticles(scene);
    scene.compute.threads = 3;
    EXPECT_EQ(placeParticles(scene).positions, first.positions);
    scene.simulation.seed = 2;
    EXPECT_NE(placeParticles(scene).positions, first.positions);
}

// The joint of two bodies is no surface, and each keeps its own velocity.
TEST(Relax, BodiesSideBySideArePackedTogether) {
    const Scene scene = relaxedScene(
        2, 0.025f,
        {R"(fluid.bodies=[{"min":[0,0,0],"max":[0.5,1,1],"velocity":[1,0,0]},{"min":[0.5,0,0],)"
         R"("max":[1,1,1]}])"});
    const Placement p = placeParticles(scene);
    EXPECT_EQ(p.positions.size(), 1600u);
    EXPECT_LT(evennessOf(scene, p, 1).scatter, 0.005);
    EXPECT_EQ(std::count(p.velocities.begin(), p.velocities.end(), Vec3{1, 0, 0}), 800);
}

// A period that is no whole number of spacings has no gap.
TEST(Relax, OddPeriodsAreFilled) {
    std::vector<std::string> knobs = Periodic2;
    knobs.push_back("simulation.spacing=0.027");
    const Scene scene = relaxedScene(2, 0.025f, knobs);
    const Placement p = placeParticles(scene);
    EXPECT_EQ(int(p.positions.size()), int(std::lround(1 / (0.027 * 0.027))));
    EXPECT_GE(countParticles(scene).fluid, int64_t(p.positions.size()));
    EXPECT_LT(evennessOf(scene, p, 0).scatter, 0.005);
}

}  // namespace
}  // namespace spindrift
