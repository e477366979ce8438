// What pictures show of velocity's gradient: exact in fields that are linear, at every resolution,
// however particles lie; of second order in vortices.
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spindrift {
namespace {

std::vector<Vertex> verticesOf(const Scene& scene, ColorBy by, int steps = 0) {
    const auto simulation = makeSimulation(scene);
    if (steps > 0) simulation->step(steps);
    std::vector<Vertex> vertices(static_cast<size_t>(simulation->fluidCount()));
    simulation->writeVertices({vertices.data()}, by, 0);
    return vertices;
}

// A block in the middle of the domain, its particles off their lattice, that moves in a field.
Scene blockIn(Field field, int dimensions, float spacing) {
    Scene scene;
    scene.compute.backend = Backend::Cpu, scene.compute.threads = 1;
    scene.simulation.dimensions = dimensions, scene.simulation.spacing = spacing;
    scene.simulation.gravity = {0, 0, 0}, scene.simulation.jitter = 0.15f;
    scene.domain.max = {1, 1, 1};
    Body& body = scene.fluid.bodies[0];
    body.min = {0.2f, 0.2f, dimensions == 2 ? 0 : 0.2f};
    body.max = {0.8f, 0.8f, dimensions == 2 ? 1 : 0.8f};
    body.velocity = {3, 0, 0}, body.field = field;
    return scene;
}

// 3 m/s at 0.3 m from the middle.
constexpr double rate = 10;

struct Known {
    Field field;
    double vorticity, shearRate;  // 1/s, in two dimensions
};
constexpr Known knownFields[] = {{Field::Rotation, 2 * rate, 0},
                                 {Field::Shear, -rate, rate},
                                 {Field::Stretching, 0, 2 * rate},
                                 {Field::Uniform, 0, 0}};

TEST(VelocityGradient, OfLinearFieldsIsExact) {
    for (const Known& known : knownFields)
        for (const int dimensions : {2, 3})
            for (const float spacing : {0.1f, 0.05f, 0.03f})
                for (const char* formulation :
                     {"wcsph", "delta_sph"})  // with half lists, with whole
                    for (const Precision precision : {Precision::Float, Precision::Double}) {
                        Scene scene = blockIn(known.field, dimensions, spacing);
                        scene.compute.precision = precision;
                        setKnob(scene, std::string("simulation.formulation=") + formulation);
                        const double turn =
                            dimensions == 3 ? std::abs(known.vorticity) : known.vorticity;
                        for (const auto& [by, wanted] : {std::pair{ColorBy::Vorticity, turn},
                                                         {ColorBy::ShearRate, known.shearRate},
                                                         {ColorBy::Divergence, 0.0}})
                            for (const Vertex& v : verticesOf(scene, by))
                                ASSERT_NEAR(v.value, wanted, 2e-4 * rate)
                                    << fmt::format("field {}, {}D, spacing {}, {}, {} at {} {} {}",
                                                   int(known.field), dimensions, spacing,
                                                   formulation, int(by), v.x, v.y, v.z);
                    }
}

// Taylor-Green vortices, u = -U cos kx sin ky, v = U sin kx cos ky.
TEST(VelocityGradient, OfVorticesIsOfSecondOrder) {
    std::vector<double> errors;
    const double k = 2 * std::numbers::pi;
    for (const float spacing : {0.05f, 0.025f, 0.0125f}) {
        Scene scene;
        scene.compute.backend = Backend::Cpu, scene.compute.threads = 1;
        scene.simulation.dimensions = 2, scene.simulation.spacing = spacing;
        scene.simulation.gravity = {0, 0, 0};
        scene.domain = {{0, 0, 0}, {1, 1, 1}, true, true, false};
        Body& body = scene.fluid.bodies[0];
        body.min = {0, 0, 0}, body.max = {1, 1, 1};
        body.velocity = {1, 0, 0}, body.field = Field::TaylorGreen;
        double square = 0;
        const auto vertices = verticesOf(scene, ColorBy::Vorticity);
        for (const Vertex& v : vertices) {
            const double exact = 2 * k * std::cos(k * double(v.x)) * std::cos(k * double(v.y));
            square += std::pow(double(v.value) - exact, 2);
        }
        errors.push_back(std::sqrt(square / double(vertices.size())) / (2 * k));
    }
    for (size_t i = 1; i < errors.size(); ++i)
        EXPECT_GT(std::log2(errors[i - 1] / errors[i]), 1.8) << errors[i - 1] << " " << errors[i];
    EXPECT_LT(errors.back(), 0.005);
    RecordProperty("error", std::to_string(errors.back()));
}

TEST(VelocityGradient, LeavesTheRunAsItIs) {
    for (const char* formulation : {"wcsph", "delta_sph"}) {
        Scene scene = blockIn(Field::Shear, 3, 0.06f);
        setKnob(scene, std::string("simulation.formulation=") + formulation);
        const auto asked = makeSimulation(scene), alone = makeSimulation(scene);
        std::vector<Vertex> vertices(static_cast<size_t>(asked->fluidCount()));
        for (int k = 0; k < 12; ++k) {
            asked->step(3), alone->step(3);
            for (const ColorBy by : {ColorBy::Vorticity, ColorBy::Neighbours, ColorBy::Divergence})
                asked->writeVertices({vertices.data()}, by, 0);
        }
        const auto a = asked->particles(), b = alone->particles();
        for (size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].position, b[i].position) << i;
    }
}

// On a lattice so many are within 2.6 spacings: 80 in three dimensions, 20 in two; those at the
// block's corners have an eighth and a quarter of the space around them.
TEST(Neighbours, AreCounted) {
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (const auto& [dimensions, wanted, corner] : {std::tuple{3, 80, 19}, {2, 20, 7}}) {
            Scene scene = blockIn(Field::Uniform, dimensions, 0.04f);
            scene.simulation.jitter = 0;
            setKnob(scene, std::string("simulation.formulation=") + formulation);
            int most = 0, least = 1000;
            for (const Vertex& v : verticesOf(scene, ColorBy::Neighbours))
                most = std::max(most, int(v.value)), least = std::min(least, int(v.value));
            EXPECT_EQ(most, wanted) << formulation;
            EXPECT_EQ(least, corner) << formulation;
        }
}

TEST(Velocity, HasItsComponents) {
    Scene scene = blockIn(Field::Uniform, 3, 0.1f);
    scene.fluid.bodies[0].velocity = {1, -2, 3};
    for (const auto& [by, wanted] :
         {std::pair{ColorBy::VelocityX, 1}, {ColorBy::VelocityY, -2}, {ColorBy::VelocityZ, 3}})
        for (const Vertex& v : verticesOf(scene, by)) ASSERT_EQ(v.value, float(wanted));
}

// Where a drop meets a pool fluid has shorter steps than elsewhere.
TEST(TimeBins, AreOfLocalSteps) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.simulation.spacing = 0.05f;
    scene.time.mode = TimeMode::Local;
    scene.domain.max = {1, 1, 1};
    scene.fluid.bodies[0].max = {1, 0.3f, 1};
    scene.fluid.bodies.push_back(Body{{.min{0.4f, 0.5f, 0.4f}, .max{0.6f, 0.7f, 0.6f}}});
    scene.fluid.bodies[1].velocity = {0, -5, 0};
    const auto simulation = makeSimulation(scene);
    std::vector<Vertex> vertices(static_cast<size_t>(simulation->fluidCount()));
    bool both = false;
    for (int k = 0; k < 120 && !both; ++k) {
        simulation->step();
        const Range range = simulation->writeVertices({vertices.data()}, ColorBy::TimeBin, 0);
        EXPECT_GE(range.min, -1);
        for (const Vertex& v : vertices) both |= v.value == 1;
    }
    EXPECT_TRUE(both);
    scene.time.mode = TimeMode::Cfl;
    for (const Vertex& v : verticesOf(scene, ColorBy::TimeBin, 20)) ASSERT_EQ(v.value, 0);
}

}  // namespace
}  // namespace spindrift
