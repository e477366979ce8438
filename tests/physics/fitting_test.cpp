// A pool at rest stays at rest whatever part of a spacing its sides have over, and has its mass.
#include "measure/save_particles.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/lattice.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace spindrift {
namespace {

constexpr float Spacing = 0.02f;
// Energy that a still pool may win, as a share of that it has.
constexpr double Most = 0.005;

// Fluid up to a side of the box all around but above, sides in spacings.
Scene poolOf(int dimensions, double x, double y, double z, const std::vector<std::string>& knobs) {
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = Spacing;
    const Vec3 size{float(x * Spacing), float(y * Spacing), float(z * Spacing)};
    scene.domain.max = {size.x, 1.5f * size.y, size.z};
    scene.fluid.bodies = {Body{{.max = size}}};
    for (const std::string& knob : knobs) setKnob(scene, knob);
    if (scene.simulation.formulation == Formulation::TransportVelocity) scene.domain.max = size;
    return scene;
}

// The most that kinetic and potential energy grow above what they are at the start, as a share of
// it, in 0.2 s. In a box from 0 upwards all of it can move.
double gainOf(const Scene& scene) {
    auto simulation = makeSimulation(scene);
    auto energy = [&] {
        const Measurement m = simulation->measure();
        return m.kineticEnergy + m.potentialEnergy;
    };
    const double start = energy();
    double most = start;
    while (simulation->clock().time < 0.2) {
        simulation->step(10);
        const double now = energy();
        if (!(now < 100 * start)) return 100;
        most = std::max(most, now);
    }
    return most / start - 1;
}

// What its only body weighs, kg, in two dimensions kg/m.
double massOf(const Scene& scene) {
    const Body& body = scene.fluid.bodies[0];
    Vec3d size = toDouble(body.max - body.min);
    if (scene.simulation.dimensions == 2) size.z = 1;
    return size.x * size.y * size.z * scene.fluid.restDensity;
}

double pouredOf(const Scene& scene) {
    return double(placeParticles(scene).positions.size()) * particleMass(scene);
}

const std::vector<std::string> Formulations = {"wcsph", "delta_sph", "delta_plus",
                                               "transport_velocity"};

// Every twentieth of a spacing, on the axis along the floor and on that of gravity.
void expectStillPools(const std::string& placement, const std::string& formulation, int each) {
    for (const std::string periodic : {"false", "true"})
        for (int axis : {0, 1})
            for (int part = 0; part < 20; part += each) {
                const double side = 12 + 0.05 * part;
                SCOPED_TRACE(testing::Message() << placement << " " << formulation << ", periodic "
                                                << periodic << ", axis " << axis << ", " << side);
                const Scene scene =
                    poolOf(2, axis == 0 ? side : 12, axis == 1 ? side : 12, 1,
                           {"simulation.formulation=" + formulation,
                            "simulation.placement=" + placement, "domain.periodic_x=" + periodic});
                EXPECT_LT(gainOf(scene), Most);
                EXPECT_NEAR(pouredOf(scene) / massOf(scene), 1, 0.001);
            }
}
TEST(Fitting, PoolsOfAnySideAreStill) {
    for (const std::string& formulation : Formulations) expectStillPools("lattice", formulation, 1);
}
// Packing takes longer than the run; density that is summed up is what feels it most.
TEST(Fitting, PackedPoolsOfAnySideAreStill) {
    for (const std::string& formulation : Formulations)
        expectStillPools("relaxed", formulation, formulation == "wcsph" ? 1 : 7);
}

TEST(Fitting, PoolsOfAnySideAreStillInThreeDimensions) {
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (const auto& [x, y, z] :
             {std::array{8.35, 8.0, 8.85}, {8.0, 8.25, 8.15}, {8.75, 8.5, 8.0}}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << x << " " << y << " " << z);
            const Scene scene = poolOf(3, x, y, z, {"simulation.formulation=" + formulation});
            EXPECT_LT(gainOf(scene), Most);
            EXPECT_NEAR(pouredOf(scene) / massOf(scene), 1, 0.001);
        }
}

Body block(double x, double y, double toX, double toY) {
    return {{.min{float(x * Spacing), float(y * Spacing), 0},
             .max{float(toX * Spacing), float(toY * Spacing), 1}}};
}

// One that begins where another ends, beside or above it, of the same fluid or a lighter one.
TEST(Fitting, PoolsOfTwoBodiesAreStill) {
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (int part = 0; part < 20; ++part) {
            SCOPED_TRACE(testing::Message() << formulation << ", part " << part);
            const double over = 0.05 * part;
            Scene scene = poolOf(2, 16 + over, 12, 1, {"simulation.formulation=" + formulation});
            scene.fluid.bodies = {block(0, 0, 7.3, 12), block(7.3, 0, 16 + over, 12)};
            EXPECT_LT(gainOf(scene), Most);
            scene.fluid.bodies = {block(0, 0, 16 + over, 6 + over),
                                  block(0, 6 + over, 16 + over, 12.3)};
            EXPECT_LT(gainOf(scene), Most);
            scene.fluid.bodies[1].restDensity = 800;
            EXPECT_LT(gainOf(scene), Most);
        }
}

// Each on its own side of a shelf that parts them, wherever that is: the first layer of the upper
// one lies half a step above the shelf, the last of the lower one not nearer to it than that.
TEST(Fitting, BodiesThatAShelfPartsMeetItsFaces) {
    for (int part = 0; part < 20; ++part)
        for (const double thick : {0.25, 1.0, 2.5, 4.0}) {
            SCOPED_TRACE(testing::Message() << "part " << part << ", " << thick);
            const double low = 6 + 0.05 * part, high = low + thick;
            Scene scene = poolOf(2, 12, 30, 1, {"simulation.formulation=delta_sph"});
            scene.solids.resize(1);
            static_cast<Form&>(scene.solids[0]) = block(0, low, 12, high);
            scene.fluid.bodies = {block(0, 0, 12, low), block(0, high, 12, high + 8)};
            double above = 1e30, below = 0;
            for (const Vec3& p : placeParticles(scene).positions) {
                const double y = double(p.y) / double(Spacing);
                if (y > low + 0.5 * thick)
                    above = std::min(above, y - high);
                else
                    below = std::max(below, y);
            }
            const double step = latticeStep(scene).y / double(Spacing);
            EXPECT_NEAR(above, 0.5 * step, 1e-3);
            EXPECT_LT(below, low - 0.5 * step + 1e-3);
        }
}

// The floor's cells meet what stands on it, wherever that is, if whole layers fit beside it.
TEST(Fitting, FloorsMeetTheFacesOfWhatStandsOnThem) {
    for (int part = 0; part < 20; ++part)
        for (const double thick : {0.25, 1.0, 2.5, 6.0}) {
            SCOPED_TRACE(testing::Message() << "part " << part << ", " << thick);
            const double step = 1 + 0.0025 * part, face = 8 * step, back = face + thick;
            Scene scene = poolOf(2, back + face, 12, 1, {});
            scene.solids.resize(1);
            static_cast<Form&>(scene.solids[0]) = block(face, 0, back, 10);
            scene.fluid.bodies = {block(0, 0, face, 8), block(back, 0, back + face, 8)};
            const Placement placed = placeParticles(scene);
            double before = 1e30, behind = 1e30;  // from the faces to the cells beside them
            for (size_t i = size_t(placed.solidSizes[0]); i < placed.walls.size(); ++i) {
                const double x = double(placed.walls[i].x) / double(Spacing);
                if (placed.walls[i].y > 0 || placed.walls[i].y < -Spacing) continue;
                if (x < face + 0.1) before = std::min(before, face - x);
                if (x > back - 0.1) behind = std::min(behind, x - back);
            }
            EXPECT_NEAR(before, 0.5 * step, 1e-3);
            EXPECT_NEAR(behind, 0.5 * step, 1e-3);
        }
}

// And the walls' layers lie outside of the domain, wherever a block stands at their end.
TEST(Fitting, WallsStayOutsideBesideWhatStandsAtTheirEnds) {
    for (const double thick : {0.3, 0.75, 1.5, 2.25, 5.0})
        for (const double away : {0.0, 0.3, 3.1}) {
            SCOPED_TRACE(testing::Message() << thick << " thick, " << away << " from the wall");
            Scene scene = poolOf(2, 20, 20, 1, {});
            scene.solids.resize(1);
            static_cast<Form&>(scene.solids[0]) = block(away, 0, away + thick, 8);
            const Placement placed = placeParticles(scene);
            double nearest = 1e30;
            for (size_t i = size_t(placed.solidSizes[0]); i < placed.walls.size(); ++i) {
                const Vec3 p = placed.walls[i];
                const bool isSide = p.y > 10 * Spacing && p.y < 12 * Spacing;
                if (!isSide || p.x > 10 * Spacing) continue;
                EXPECT_LT(p.x, 0);
                nearest = std::min(nearest, -double(p.x) / double(Spacing));
            }
            EXPECT_NEAR(nearest, 0.5 * latticeStep(scene).x / double(Spacing), 0.03);
        }
}

// Up to a solid's face, also where the body goes on into the solid.
TEST(Fitting, PoolsBesideASolidAreStill) {
    for (const std::string formulation : {"wcsph", "delta_sph"})
        for (int part = 0; part < 20; ++part) {
            SCOPED_TRACE(testing::Message() << formulation << ", part " << part);
            const double face = 12 + 0.05 * part;
            Scene scene = poolOf(2, 18, 12, 1, {"simulation.formulation=" + formulation});
            scene.solids.resize(1);
            static_cast<Form&>(scene.solids[0]) = block(face, 0, 18, 18);
            for (const double end : {face, 18.0}) {
                scene.fluid.bodies = {block(0, 0, end, 12)};
                EXPECT_LT(gainOf(scene), Most);
                const double asked = face * 12 * std::pow(double(Spacing), 2);
                EXPECT_NEAR(pouredOf(scene) / (asked * scene.fluid.restDensity), 1, 0.001);
            }
        }
}

// Posts and blocks that no one step fits on all sides.
TEST(Fitting, PoolsAroundASolidAreStill) {
    for (const std::string placement : {"lattice", "relaxed"})
        for (const auto& [low, high] : {std::array{0.0, 18.0}, {3.0, 6.0}})
            for (int part = 0; part < 20; ++part) {
                SCOPED_TRACE(testing::Message()
                             << placement << ", from " << low << ", part " << part);
                Scene scene = poolOf(2, 20, 12, 1, {"simulation.placement=" + placement});
                scene.solids.resize(1);
                static_cast<Form&>(scene.solids[0]) = block(6 + 0.05 * part, low, 12, high);
                EXPECT_LT(gainOf(scene), Most);
            }
}

// Whoever goes on from a fitted run's particles has their mass, from either kind of file.
TEST(Fitting, ARunThatBeginsWithTheParticlesOfAFittedOneIsStill) {
    const Scene first = poolOf(2, 12.45, 12.6, 1, {});
    auto simulation = makeSimulation(first);
    while (simulation->clock().time < 0.1) simulation->step(10);
    for (const char* name : {"/fitted.csv", "/fitted.h5"}) {
        SCOPED_TRACE(name);
        const std::string path = testing::TempDir() + name;
        saveParticles(path, simulation->particles(), massesToSave(first, *simulation));
        Scene scene = first;
        scene.fluid.bodies = {Body{{.shape = Shape::File, .path = path}}};
        checkScene(scene);
        EXPECT_NEAR(particleMass(scene) / particleMass(first), 1, 1e-6);
        EXPECT_LT(gainOf(scene), Most);
        std::filesystem::remove(path);
    }
}

// Sides that are whole multiples have the particles that they always had, to the bit.
TEST(Fitting, WholeMultiplesOfTheSpacingAreNotTouched) {
    const Scene scene = poolOf(3, 8, 12, 10, {});
    const float dx = Spacing;
    EXPECT_EQ(latticeStep(scene), (Vec3d{dx, dx, dx}));
    EXPECT_EQ(particleMass(scene), scene.fluid.restDensity * dx * dx * dx);
    const std::vector<Vec3> places = placeParticles(scene).positions;
    ASSERT_EQ(places.size(), 8u * 12 * 10);
    for (size_t i = 0; i < places.size(); ++i) {
        const Vec3d at{double(i % 8), double(i / 8 % 12), double(i / 96)};
        EXPECT_EQ(places[i], toFloat(double(dx) * at + Vec3d{0.5 * dx, 0.5 * dx, 0.5 * dx}));
    }
}

}  // namespace
}  // namespace spindrift
