#include "measure/stress.h"

#include "core/error.h"
#include "measure/health.h"
#include "scene/formulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// What compressed fluid gives back, J: of p = k ((rho/rho0)^gamma - 1), where that is not cut off
// at 0. The classic formulation's pressure has none, nor have pressures that are solved for.
double internalEnergy(const Scene& scene, double sound, Simulation& simulation) {
    if (factsOf(scene).isHistorical || factsOf(scene).solvesPressure) return 0;
    const int gamma =
        scene.fluid.equationOfState == EquationOfState::Linear ? 1 : scene.fluid.gamma;
    const std::vector<uint16_t> bodies = simulation.state().particles.bodies;
    double sum = 0;
    for (const Particle& p : simulation.particles()) {
        const double r =
            p.density / (bodies.empty()
                             ? scene.fluid.restDensity
                             : restDensity(scene, scene.fluid.bodies[bodies[size_t(p.id)]]));
        if (r <= 0 || (r < 1 && !carriesDensity(scene))) continue;
        sum += (gamma == 1 ? std::log(r) : (std::pow(r, gamma - 1) - 1) / (gamma - 1)) + 1 / r - 1;
    }
    return particleMass(scene) * sound * sound / gamma * sum;
}

// Of all the fluid, kg.
double massOf(const Scene& scene, Simulation& simulation) {
    const std::vector<uint16_t> bodies = simulation.state().particles.bodies;
    if (bodies.empty()) return particleMass(scene) * simulation.fluidCount();
    double mass = 0;
    for (const uint16_t body : bodies)
        mass += particleMass(scene) * restDensity(scene, scene.fluid.bodies[body]) /
                scene.fluid.restDensity;
    return mass;
}

// Of all forms that energy has in a scene, and what its gain is measured against, J.
struct Energy {
    const Scene& scene;
    Simulation& simulation;
    double sound = simulation.measure().soundSpeed;
    double M = massOf(scene, simulation);
    double start = total(simulation.measure()) + unseen();
    double scale = scaleOf(simulation.measure());

    double total(const Measurement& m) {
        return m.kineticEnergy + m.potentialEnergy + internalEnergy(scene, sound, simulation);
    }
    // What the sums below don't see at the start: a particle on a wall is pushed off to where walls
    // carry it, half a spacing; a squeezed wall pushes as its fluid does; forces are a few per cent
    // stronger than the slope of the internal energy, as gradients are exact on the lattice and its
    // density sum is not.
    double unseen() {
        const double squeezed = simulation.wallCount() > 0 ? 1 : 0.05;
        return M * length(toDouble(scene.simulation.gravity)) * scene.simulation.spacing / 2 +
               squeezed * internalEnergy(scene, sound, simulation);
    }
    double gain(const Measurement& m) { return (total(m) - start) / scale; }
    double scaleOf(const Measurement& m) {
        const double reach = length(toDouble(scene.domain.max - scene.domain.min)),
                     pull = scene.simulation.centralRate * reach;
        return m.kineticEnergy + internalEnergy(scene, sound, simulation) +
               M * (length(toDouble(scene.simulation.gravity)) * reach + pull * pull / 2 +
                    std::pow(sound / 50, 2) / 2);
    }
};

// "" while nothing is wrong.
std::string wrong(const StressCase& c, const Measurement& m, double gain) {
    const Scene& s = c.scene;
    if (!m.finite) return "values that are no numbers";
    if (c.energyIsConserved && gain > 0.01)
        return fmt::format("{:.1f} % of energy from nothing", 100 * gain);
    // A thin splash compressed to twice its density is no fluid any more.
    if (m.maxDensityError > 1)
        return fmt::format("density {:.1f} times that at rest", 1 + m.maxDensityError);
    if (m.meanDensity < 0.02 * s.fluid.restDensity) return "hardly any density left";
    return "";
}

std::string outside(const Scene& s, Simulation& simulation) {
    for (const Particle& p : simulation.particles())
        for (int k = 0; k < 3; ++k) {
            const double size = s.domain.max[k] - s.domain.min[k],
                         slack = 1e-5 * (size + std::abs(s.domain.max[k]));
            if (p.position[k] < s.domain.min[k] - slack || p.position[k] > s.domain.max[k] + slack)
                return fmt::format("particle {} left the box", p.id);
        }
    return "";
}

}  // namespace

StressResult stress(const StressCase& c) {
    Scene scene = c.scene;
    const auto simulation = c.start ? makeSimulation(scene, c.start(scene)) : makeSimulation(scene);
    HealthGuard guard(*simulation, scene);
    Energy energy{c.scene, *simulation};
    StressResult r;
    r.particles = simulation->fluidCount();
    const int stride = std::max(10, c.steps / 2000);
    while (r.steps < c.steps) {
        if (c.disturb) c.disturb(*simulation, scene, int(r.steps)), guard.apply(scene);
        simulation->step(int(std::min<int64_t>(stride, c.steps - r.steps)));
        Measurement m = simulation->measure();
        const HealthGuard::Finding found = guard.look(m);
        r.steps = m.steps, r.retries = guard.retries();
        if (found == HealthGuard::Finding::GaveUp) {
            r.verdict = Verdict::Stopped, r.what = guard.said();
            return r;
        }
        r.energyGain = std::max(r.energyGain, energy.gain(m));
        r.density = std::max(r.density, m.maxDensityError);
        r.what = wrong(c, m, r.energyGain);
        if (!r.what.empty()) break;
    }
    if (r.what.empty()) r.what = outside(scene, *simulation);
    r.verdict = r.what.empty() ? Verdict::Sound : Verdict::Broken;
    return r;
}

}  // namespace spindrift
