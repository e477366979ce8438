// A pool at rest stays at rest, carries its weight and doesn't drift.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace spindrift {
namespace {

// The surface that an incompressible pool of this many particles would have, m above the floor.
double waterLevel(const Scene& s, size_t particles) {
    const Vec3 size = s.domain.max - s.domain.min;
    return double(particles) * particleMass(s) / s.fluid.restDensity / (size.x * size.z);
}

// Root mean squares of p - rho g depth in units of rho g level, without the layer at the surface:
// particle by particle, and of the means over horizontal layers one spacing thick.
struct PressureError {
    double particles = 0, layers = 0;
};
PressureError pressureError(const Scene& s, const std::vector<Particle>& particles, double level) {
    const double weight = s.fluid.restDensity * -s.simulation.gravity.y, dx = s.simulation.spacing;
    std::map<int, std::pair<double, int>> layers;
    PressureError error;
    int count = 0;
    for (const Particle& p : particles) {
        const double height = p.position.y - s.domain.min.y,
                     difference = p.pressure - weight * (level - height);
        if (level - height < dx) continue;
        auto& [sum, n] = layers[int(height / dx)];
        sum += difference;
        ++n;
        error.particles += difference * difference;
        ++count;
    }
    for (const auto& [height, layer] : layers)
        error.layers += std::pow(layer.first / layer.second, 2);
    error.particles = std::sqrt(error.particles / count) / (weight * level);
    error.layers = std::sqrt(error.layers / double(layers.size())) / (weight * level);
    return error;
}

struct Settled {
    double residual;
    PressureError error;
    Vec3d drift;
    double spacing;
};

// Runs the pool for 20 sqrt(H/g) and looks at the ten samples after that.
Settled settle(float support) {
    Scene scene =
        loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/test/still_pool_small.json");
    scene.simulation.support = support;
    auto simulation = makeSimulation(scene);
    const Measurement before = simulation->measure();
    const double level = waterLevel(scene, size_t(simulation->fluidCount())),
                 g = -scene.simulation.gravity.y;
    const double scale =
        simulation->fluidCount() * double(particleMass(scene)) * g * level;  // M g H
    while (simulation->measure().time < 20 * std::sqrt(level / g)) simulation->step(50);

    Settled s{0, {}, {}, scene.simulation.spacing};
    for (int k = 0; k < 10; ++k) {
        simulation->step(20);
        const PressureError error = pressureError(scene, simulation->particles(), level);
        s.residual = std::max(s.residual, simulation->measure().kineticEnergy / scale);
        s.error.particles = std::max(s.error.particles, error.particles);
        s.error.layers = std::max(s.error.layers, error.layers);
    }
    s.drift = simulation->measure().centerOfMass - before.centerOfMass;
    std::printf(
        "R = %.1f dx: residual Ek %.2e M g H, pressure rms %.2f %% (layers %.2f %%), drift %.1e "
        "%.1e %.1e m\n",
        support, s.residual, 100 * s.error.particles, 100 * s.error.layers, s.drift.x, s.drift.y,
        s.drift.z);
    return s;
}

TEST(StillPool, StaysStillWithHydrostaticPressure) {
    const Settled s = settle(Scene{}.simulation.support);
    EXPECT_LT(s.residual, 1e-4);
    EXPECT_LT(s.error.layers, 0.03);
    EXPECT_LT(s.error.particles,
              0.05);  // the scatter of single particles that density by summation has
    EXPECT_LT(std::hypot(s.drift.x, s.drift.z), 0.05 * s.spacing);
    EXPECT_LT(std::abs(s.drift.y), 0.1 * s.spacing);
}

}  // namespace
}  // namespace spindrift
