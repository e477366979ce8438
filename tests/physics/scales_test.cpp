// Froude similarity: a dam break of any size is the same flow, as nothing in the program is an
// absolute length.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

// A column 0.4 sizes high in a box a size wide, m, some sizes from the origin.
Scene damBreak(int dimensions, double size, double away) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.compute.threads = 1;
    scene.simulation.dimensions = dimensions;
    auto at = [&](double x, double y, double z) {
        return Vec3{float(size * (x + away)), float(size * (y + away)), float(size * (z + away))};
    };
    scene.simulation.spacing = float((dimensions == 2 ? 0.02 : 0.05) * size);
    scene.domain.min = at(0, 0, 0), scene.domain.max = at(1, 0.8, 0.3);
    scene.fluid.bodies = {Body{{.min = at(0, 0, 0), .max = at(0.3, 0.4, 0.3)}}};
    // Of the same Reynolds number.
    scene.fluid.viscosity = float(0.001 * std::pow(size, 1.5));
    scene.time.maxStep = float(0.01 * std::sqrt(size));
    return scene;
}

// Where the centre of mass is when the front runs up the far wall, in sizes from the box's corner.
Vec3d centreOf(const Scene& scene, double size) {
    auto simulation = makeSimulation(scene);
    const double end = 0.5 * std::sqrt(size);
    simulation->stopAt(end);
    for (int n = 0; simulation->clock().time < end && n < 20000; ++n) simulation->step();
    EXPECT_NEAR(simulation->clock().time, end, 1e-6 * end);
    return (1 / size) * (simulation->measure().centerOfMass - toDouble(scene.domain.min));
}

TEST(Scales, ADamBreakIsTheSameFromMicrometresToKilometres) {
    for (const int dimensions : {2, 3}) {
        const Vec3d one = centreOf(damBreak(dimensions, 1, 0), 1);
        EXPECT_GT(one.x, 0.4);  // 0.15 at the start
        for (const auto& [size, away] :
             {std::pair{1e-5, 0.0}, {1e-3, 0.0}, {1e-3, 50.0}, {1e2, -50.0}, {1e4, 0.0}}) {
            const Vec3d other = centreOf(damBreak(dimensions, size, away), size);
            std::printf("%dD, %g m: %.5f %.5f of %.5f %.5f\n", dimensions, size, other.x, other.y,
                        one.x, one.y);
            // In two dimensions this splash is chaotic: roundings come to a thousandth.
            const double near = dimensions == 2 ? 3e-3 : 1e-4;
            EXPECT_NEAR(other.x, one.x, near) << size;
            EXPECT_NEAR(other.y, one.y, near) << size;
        }
    }
}

}  // namespace
}  // namespace spindrift
