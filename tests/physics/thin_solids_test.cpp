// Fluid on the two sides of a thin solid does not feel each other, however thin it is, and presses
// it as the levels say.
#include "scene/json.h"
#include "scene/lattice.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace spindrift {
namespace {

constexpr double Dx = 0.02, G = 9.81, Rho = 1000;
constexpr const char* Formulations[] = {"wcsph", "delta_sph", "delta_plus"};

Scene sceneOf(const std::vector<std::string>& knobs, const std::string& formulation) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.simulation.dimensions = 2;
    scene.simulation.spacing = float(Dx);
    setKnob(scene, "simulation.formulation=" + formulation);
    setKnob(scene, "fluid.artificial_viscosity=0.1");
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}

// Water 0.4 m deep left of x = 0.2 m, and 0.2 m on the other side of a plate that is so thick; in
// three dimensions 0.2 m wide.
Scene twoLevels(double thickness, const std::string& formulation, const std::string& motion = "") {
    const double right = 0.2 + thickness;
    return sceneOf(
        {fmt::format("domain.max={},0.5,0.2", right + 0.2),
         fmt::format(R"(solids=[{{"shape":"block","min":[0.2,0,0],"max":[{},0.5,0.2]{}}}])", right,
                     motion),
         fmt::format(
             R"(fluid.bodies=[{{"shape":"block","min":[0,0,0],"max":[0.2,0.4,0.2],
             "pressure":"hydrostatic"}},
             {{"shape":"block","min":[{},0,0],"max":[{},0.2,0.2],"pressure":"hydrostatic"}}])",
             right, right + 0.2)},
        formulation);
}

struct Means {
    double force = 0, exact = 0;  // N/m
    double left = 0, right = 0;   // Pa beside the plate, more than hydrostatic pressure
};
// Over the second half of a second; levels are those that the fluid poured there makes.
Means watch(const Scene& scene, double thickness) {
    auto simulation = makeSimulation(scene);
    Means m;
    double area[2] = {0, 0};
    const double width = scene.simulation.dimensions == 3 ? double(scene.domain.max.z) : 1;
    for (const Particle& p : simulation->particles())
        area[p.position.x > 0.2] += particleVolume(scene) / width;
    int looks = 0;
    while (simulation->clock().time < 1) {
        simulation->step(10);
        if (simulation->clock().time < 0.5) continue;
        const Measurement now = simulation->measure();
        const double plate = now.solids[0].position.x, low = plate - thickness / 2,
                     high = plate + thickness / 2;
        const double level[2] = {area[0] / low, area[1] / (double(scene.domain.max.x) - high)};
        m.force += now.solids[0].pressureForce.x;
        m.exact += Rho * G * (level[0] * level[0] - level[1] * level[1]) / 2;
        ++looks;
        double sum[2] = {0, 0};
        int count[2] = {0, 0};
        for (const Particle& p : simulation->particles()) {
            const int side = p.position.x > plate;
            EXPECT_FALSE(p.position.x > low + 1e-4 && p.position.x < high - 1e-4);
            const double away = side ? p.position.x - high : low - p.position.x,
                         depth = level[side] - p.position.y;
            if (away > 2 * Dx || depth < 2 * Dx) continue;
            sum[side] += p.pressure - Rho * G * depth, ++count[side];
        }
        m.left += sum[0] / count[0], m.right += sum[1] / count[1];
    }
    m.force /= looks, m.exact /= looks, m.left /= looks, m.right /= looks;
    return m;
}

constexpr double Limit = 0.03;

void expectLevels(const Means& m) {
    EXPECT_NEAR(m.force / m.exact, 1, Limit) << m.force << " N/m, exact " << m.exact;
    EXPECT_NEAR(m.left / (Rho * G * 0.4), 0, Limit);
    EXPECT_NEAR(m.right / (Rho * G * 0.4), 0, Limit);
}

TEST(ThinSolids, BearTheLevelsOnTheirSides) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 0.6, 1.0, 1.5, 2.0, 3.0}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << spacings);
            const double thickness = spacings * Dx;
            expectLevels(watch(twoLevels(thickness, formulation), thickness));
        }
}

TEST(ThinSolids, BearThemInThreeDimensions) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 1.0, 2.0}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << spacings);
            const double thickness = spacings * Dx;
            Scene scene = twoLevels(thickness, formulation);
            scene.simulation.dimensions = 3;
            Means m = watch(scene, thickness);
            m.force /= double(scene.domain.max.z);
            expectLevels(m);
        }
}

TEST(ThinSolids, BearThemWhileTheyMove) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 1.0, 2.0}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << spacings);
            const double thickness = spacings * Dx;
            expectLevels(
                watch(twoLevels(thickness, formulation, R"(,"keyframes":[[0,0,0,0],[1,0.01,0,0]])"),
                      thickness));
        }
}

// Around both ends of a plate, wherever its lattice is to the fluid's.
TEST(ThinSolids, PoolsAroundThemStayCalm) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0})
            for (const bool upright : {false, true}) {
                SCOPED_TRACE(testing::Message()
                             << formulation << " " << spacings << " " << upright);
                const double length = 6 * Dx, t = spacings * Dx;
                const Scene scene = sceneOf(
                    {"domain.max=0.4,0.4,0.2",
                     fmt::format(
                         R"(solids=[{{"shape":"block","min":[0.14,0.1,0],"max":[{},{},0.2]}}])",
                         0.14 + (upright ? t : length), 0.1 + (upright ? length : t)),
                     R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.4,0.24,0.2],
                         "pressure":"hydrostatic"}])"},
                    formulation);
                auto simulation = makeSimulation(scene);
                double energy = 0;
                int looks = 0;
                while (simulation->clock().time < 0.4) {
                    simulation->step(10);
                    if (simulation->clock().time < 0.3) continue;
                    energy += simulation->measure().kineticEnergy, ++looks;
                }
                EXPECT_LT(energy / looks, 0.1);  // J/m
            }
}

// One that spans a periodic axis has no ends there: it carries 0.2 m of water over nothing.
TEST(ThinSolids, SpanPeriodicAxes) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 1.0, 2.0}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << spacings);
            const double low = 0.1, high = low + spacings * Dx;
            const Scene scene = sceneOf(
                {"domain.max=0.3,0.4,0.2", "domain.periodic_x=true",
                 fmt::format(R"(solids=[{{"shape":"block","min":[0,{},0],"max":[0.3,{},0.2]}}])",
                             low, high),
                 fmt::format(R"(fluid.bodies=[{{"shape":"block","min":[0,{},0],"max":[0.3,{},0.2],
                     "pressure":"hydrostatic"}}])",
                             high, high + 0.2)},
                formulation);
            auto simulation = makeSimulation(scene);
            double force = 0, energy = 0;
            int looks = 0;
            while (simulation->clock().time < 1) {
                simulation->step(10);
                if (simulation->clock().time < 0.5) continue;
                const Measurement m = simulation->measure();
                force += m.solids[0].pressureForce.y, energy += m.kineticEnergy, ++looks;
            }
            for (const Particle& p : simulation->particles())
                EXPECT_FALSE(p.position.y > low + 1e-4 && p.position.y < high - 1e-4);
            EXPECT_LT(energy / looks, 0.1);  // J/m
            EXPECT_NEAR(force / looks / (Rho * G * 0.2 * 0.3), -1, Limit);
        }
}

// A cup of three plates hangs in a tank, fuller than the tank: what is in it presses its walls
// outward, what is around it inward.
TEST(ThinSolids, CupsHoldWater) {
    for (const char* formulation : Formulations)
        for (const double spacings : {0.25, 1.0, 2.0}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << spacings);
            const double t = spacings * Dx, low = 0.2, high = 0.4, floor = 0.12;
            const Scene scene = sceneOf(
                {"domain.max=0.6,0.5,0.2", "simulation.gravity_ramp=0.4",
                 fmt::format(R"(solids=[{{"shape":"block","min":[{0},{2},0],"max":[0.2,0.44,0.2]}},
                     {{"shape":"block","min":[0.4,{2},0],"max":[{1},0.44,0.2]}},
                     {{"shape":"block","min":[0.2,{2},0],"max":[0.4,0.12,0.2]}}])",
                             low - t, high + t, floor - t),
                 R"(fluid.bodies=[{"shape":"block","min":[0.2,0.12,0],"max":[0.4,0.36,0.2]},
                     {"shape":"block","min":[0,0,0],"max":[0.2,0.18,0.2]},
                     {"shape":"block","min":[0.4,0,0],"max":[0.6,0.18,0.2]},
                     {"shape":"block","min":[0.2,0,0],"max":[0.4,0.12,0.2]}])"},
                formulation);
            auto simulation = makeSimulation(scene);
            auto held = [&] {
                int in = 0;
                for (const Particle& p : simulation->particles())
                    in += p.position.x > low && p.position.x < high && p.position.y > floor;
                return in;
            };
            const int all = simulation->fluidCount(), inside = held();
            const double volume = particleVolume(scene);
            while (simulation->clock().time < 0.7) simulation->step(10);
            Vec3d sum[3] = {};
            constexpr int Looks = 50;
            for (int k = 0; k < Looks; ++k) {
                simulation->step(20);
                const Measurement m = simulation->measure();
                for (int s = 0; s < 3; ++s)
                    sum[s] = sum[s] + (1.0 / Looks) * m.solids[size_t(s)].pressureForce;
            }
            EXPECT_EQ(held(), inside);
            const double deep = inside * volume / (high - low);
            const double around = ((all - inside) * volume - 0.6 * (floor - t)) /
                                  (0.6 - (high - low) - 2 * t);  // above the cup's underside
            const double side = Rho * G * (deep * deep - around * around) / 2,
                         down = Rho * G * (deep * (high - low) - around * (high - low + 2 * t));
            EXPECT_NEAR(sum[0].x / side, -1, Limit);
            EXPECT_NEAR(sum[1].x / side, 1, Limit);
            EXPECT_NEAR((sum[0].y + sum[1].y + sum[2].y) / down, -1, Limit);
        }
}

}  // namespace
}  // namespace spindrift
