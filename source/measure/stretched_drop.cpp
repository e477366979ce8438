#include "measure/exact.h"
#include "measure/free_surface_flows.h"
#include "measure/stepping.h"

#include <cmath>

namespace spindrift {
namespace {

// Semi-axes, m, of a disc of as many particles, and the mean of pressure / rho less that of
// `exact` among those in the middle, m²/s².
struct Outline {
    double a = 0, b = 0, error = 0;
};
Outline outlineOf(const std::vector<Particle>& particles, double rho,
                  const OscillatingDrop& exact) {
    Outline s;
    double n = double(particles.size()), inside = 0;
    for (const Particle& p : particles) {
        const double x = p.position.x, y = p.position.y;
        s.a += 4 * x * x / n, s.b += 4 * y * y / n;
        const double depth = 1 - std::pow(x / exact.a, 2) - std::pow(y * exact.a, 2);
        if (depth < 0.9) continue;
        s.error += p.pressure / rho - depth * exact.pressure(), inside += 1;
    }
    return {std::sqrt(s.a), std::sqrt(s.b), s.error / inside};
}

}  // namespace

// --- Monaghan 1994: a disc without gravity that its own motion stretches to twice its length ---

void runStretchedDrop(const Scene& scene, ValidationRun& run) {
    constexpr int Looks = 76;
    constexpr double End = 0.76;
    Stepping sim(scene, run);
    OscillatingDrop exact;
    exact.pull = 0;
    const double rho = scene.fluid.restDensity;
    const Outline start = outlineOf(sim->particles(), rho, exact);
    const double energy = sim->measure().kineticEnergy;
    Curve ours{"middle", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    double errors = 0, squares = 0, last = 0;
    Outline now = start;
    for (int k = 1; k <= Looks; ++k) {
        sim.until(k * End / Looks);
        const double time = sim.time();
        exact.advance(time - last), last = time;
        now = outlineOf(sim->particles(), rho, exact);
        errors += now.error * now.error, squares += std::pow(exact.pressure(), 2);
        ours.x.push_back(time), ours.y.push_back(exact.pressure() + now.error);
        known.x.push_back(time), known.y.push_back(exact.pressure());
    }
    run.chart = {"", "t s", "p / (rho s^2 R^2)", {known, ours}};
    run.metrics = {{"pressure in the middle, rms", "%", 100 * std::sqrt(errors / squares),
                    targetAt(run.resolution, 50, 5.0)},
                   {"longer semi-axis", "%", 100 * (now.a / start.a / exact.a - 1),
                    targetAt(run.resolution, 50, 0.1)},
                   {"shorter semi-axis", "%", 100 * (now.b / start.b * exact.a - 1),
                    targetAt(run.resolution, 50, 0.1)},
                   {"kinetic energy", "%", 100 * (sim->measure().kineticEnergy / energy - 1), {}}};
}

}  // namespace spindrift
