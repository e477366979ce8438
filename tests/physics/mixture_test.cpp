// Fluids of different density: oil comes up through water, and pressure is the weight of what is
// above.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

Scene layers(double below, double above, const char* formulation) {
    Scene s;
    for (const std::string& knob :
         {std::string("compute.backend=cpu"), std::string("simulation.dimensions=2"),
          std::string("simulation.spacing=0.0125"), std::string("domain.max=[0.25,0.6,0.1]"),
          std::string("fluid.rest_density=1000"), std::string("fluid.viscosity=0.01"),
          std::string("fluid.bodies=[{},{}]"),
          std::string("simulation.formulation=") + formulation})
        setKnob(s, knob);
    s.fluid.bodies[0].max = {0.25f, 0.2f, 0.1f}, s.fluid.bodies[0].restDensity = float(below);
    s.fluid.bodies[1].min = {0, 0.2f, 0}, s.fluid.bodies[1].max = {0.25f, 0.4f, 0.1f},
    s.fluid.bodies[1].restDensity = float(above);
    return s;
}

TEST(Mixture, PressesWithTheWeightOfBothLayers) {
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (double above : {800.0, 250.0}) {
            Scene s = layers(1000, above, formulation);
            s.fluid.viscosity = 1, s.simulation.gravityRamp = 1;
            const auto simulation = makeSimulation(s);
            double pressure = 0,
                   samples = 0;  // at the floor, by its own height, mean over the last half second
            while (simulation->clock().time < 4) {
                simulation->step(20);
                if (simulation->clock().time < 3.5) continue;
                for (const Particle& p : simulation->particles())
                    if (p.position.y > 0.03 && p.position.y < 0.08)
                        pressure += p.pressure + 1000 * 9.81 * p.position.y, ++samples;
            }
            const double exact = 9.81 * 0.2 * (1000 + above);
            std::printf(
                "two layers, %s, %g on 1000: pressure at the floor %.1f Pa, weight %.1f Pa\n",
                formulation, above, pressure / samples, exact);
            EXPECT_NEAR(pressure / samples, exact, 0.02 * exact);
            for (const Particle& p : simulation->particles())
                EXPECT_TRUE((p.position.y > 0.2 - 0.02) == (p.density < 950) ||
                            std::abs(p.position.y - 0.2) < 0.02)
                    << p.position.y << " " << p.density;
        }
}

// Rayleigh and Taylor: the wrong way up does not last. Each particle stays of its fluid, hence each
// fluid keeps its mass.
TEST(Mixture, TheLightOneComesUp) {
    Scene s = layers(500, 1000, "wcsph");
    s.simulation.placement = StartPlaces::Relaxed;
    const auto simulation = makeSimulation(s);
    const std::vector<uint16_t> bodies = simulation->state().particles.bodies;
    auto heights = [&] {
        double y[2] = {0, 0}, n[2] = {0, 0};
        for (const Particle& p : simulation->particles())
            y[bodies[size_t(p.id)]] += p.position.y, ++n[bodies[size_t(p.id)]];
        EXPECT_NEAR(n[0], n[1], 0.05 * n[0]);
        return std::pair{y[0] / n[0], y[1] / n[1]};
    };
    const Measurement before = simulation->measure();
    const auto [lightBefore, heavyBefore] = heights();
    EXPECT_NEAR(heavyBefore - lightBefore, 0.2, 0.01);
    while (simulation->clock().time < 6) simulation->step(50);
    const auto [light, heavy] = heights();
    std::printf(
        "oil under water: %.3f m below at the start, %.3f m above after 6 s (0.2 when parted)\n",
        heavyBefore - lightBefore, light - heavy);
    EXPECT_GT(light - heavy, 0.15);
    // As the heavy one sinks: m g (0.2 + 0.2) of half the mass, less what the light one gains.
    const double sunk = before.potentialEnergy - simulation->measure().potentialEnergy;
    EXPECT_NEAR(sunk, 9.81 * 0.2 * 0.25 * 0.2 * (1000 - 500), 0.15 * sunk);
}

}  // namespace
}  // namespace spindrift
