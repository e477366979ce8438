#include "measure/health.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Upper estimate of the speed of sound, m/s: as the simulation chooses it, but for a fall through
// the whole domain and at least under the earth's gravity, so that stirring calm fluid is no alarm.
double soundSpeed(const Scene& scene) {
    const Fluid& fluid = scene.fluid;
    if (fluid.stiffness > 0) return std::sqrt(fluid.stiffness * fluid.gamma / fluid.restDensity);
    if (fluid.soundSpeed > 0) return fluid.soundSpeed;
    const double gravity = std::max(9.81, double(length(scene.simulation.gravity)));
    double initial = 0;
    for (const Body& body : fluid.bodies)
        initial = std::max(initial, double(length(body.velocity)));
    const double fall = double(length(scene.domain.max - scene.domain.min));
    return fluid.speedRatio * std::sqrt(initial * initial + 2 * gravity * fall);
}

}  // namespace

std::string divergence(const Scene& scene, const Measurement& m) {
    const char* remedy = scene.time.mode == TimeMode::Fixed
                             ? "lower time.step or set time.mode=cfl"
                             : "lower time.cfl or raise fluid.artificial_viscosity";
    const auto report = [&](const std::string& what) {
        return fmt::format("diverged at step {} ({:.4g} s): {}; {}", m.steps, m.time, what, remedy);
    };
    const bool numbers = m.finite && std::isfinite(m.kineticEnergy) && std::isfinite(m.maxSpeed) &&
                         std::isfinite(m.meanDensity) && std::isfinite(m.time) &&
                         std::isfinite(m.dt);
    if (!numbers) return report("values that are no numbers");
    if (m.maxSpeed * m.dt > supportRadius(scene))
        return report(
            fmt::format("a particle moves {:.3g} m in one step, farther than its support radius",
                        m.maxSpeed * m.dt));
    constexpr double MachLimit = 3;
    if (m.maxSpeed > MachLimit * soundSpeed(scene))
        return report(fmt::format("a particle at {:.3g} m/s, {:g} times the speed of sound or more",
                                  m.maxSpeed, MachLimit));
    return "";
}

}  // namespace spindrift
