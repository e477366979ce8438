// A pool at rest stays at rest, carries its weight and doesn't drift.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace spindrift {
namespace {

// The surface that an incompressible pool of this many particles would have, m above the floor.
double waterLevel(const Scene& s, size_t particles) {
    const Vec3 size = s.domain.max - s.domain.min;
    return double(particles) * particleMass(s) / s.fluid.restDensity / (size.x * size.z);
}

// Root mean square of p - rho g (level - y) in units of rho g level, without the layer at the surface.
double pressureError(const Scene& s, const std::vector<Particle>& particles, double level) {
    const double weight = s.fluid.restDensity * -s.simulation.gravity.y;
    double sum = 0;
    int count = 0;
    for (const Particle& p : particles) {
        const double depth = level - (p.position.y - s.domain.min.y);
        if (depth < s.simulation.spacing) continue;
        sum += std::pow(p.pressure - weight * depth, 2);
        ++count;
    }
    return std::sqrt(sum / count) / (weight * level);
}

TEST(StillPool, StaysStillWithHydrostaticPressure) {
    const Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/test/still_pool_small.json");
    auto simulation = makeSimulation(scene);
    const Measurement before = simulation->measure();
    const double level = waterLevel(scene, size_t(simulation->fluidCount()));
    const double g = -scene.simulation.gravity.y;
    const double scale = simulation->fluidCount() * particleMass(scene) * g * level;   // M g H
    const double settled = 20 * std::sqrt(level / g);
    while (simulation->measure().time < settled) simulation->step(50);

    double residual = 0, error = 0;
    const int samples = 10;
    for (int k = 0; k < samples; ++k) {
        simulation->step(20);
        residual = std::max(residual, simulation->measure().kineticEnergy / scale);
        error += pressureError(scene, simulation->particles(), level) / samples;
    }
    const Measurement after = simulation->measure();
    const Vec3d drift = after.centerOfMass - before.centerOfMass;
    RecordProperty("residual_kinetic_energy", std::to_string(residual));
    RecordProperty("pressure_rms", std::to_string(error));
    std::printf("residual Ek %.2e M g H, pressure rms %.2f %%, drift %.2e %.2e %.2e m, density error %.4f\n",
                residual, 100 * error, drift.x, drift.y, drift.z, after.densityError);
    EXPECT_LT(residual, 1e-4);
    EXPECT_LT(error, 0.03);
    EXPECT_LT(std::hypot(drift.x, drift.z), 0.05 * scene.simulation.spacing);
    EXPECT_LT(std::abs(drift.y), scene.simulation.spacing);
}

}  // namespace
}  // namespace spindrift
