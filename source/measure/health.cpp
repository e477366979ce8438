#include "measure/health.h"

#include "scene/particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Upper estimate of the speed of sound, m/s: as the simulation chooses it, for a fall through the whole domain, and where nobody named
// one at least under the earth's gravity, so that stirring calm fluid is no alarm.
double mostSoundSpeed(const Scene& scene) {
    const Vec3d size = toDouble(scene.domain.max - scene.domain.min);
    FluidExtent anywhere{{0, 0, 0}, size, 0};
    for (const Body& body : scene.fluid.bodies) anywhere.speed = std::max(anywhere.speed, double(length(body.velocity)));
    const double chosen = soundSpeed(scene, anywhere);
    if (scene.fluid.stiffness > 0 || scene.fluid.soundSpeed > 0) return chosen;
    return std::max(chosen, scene.fluid.speedRatio * std::sqrt(2 * 9.81 * length(size)));
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
    if (m.maxSpeed > MachLimit * std::max(mostSoundSpeed(scene), m.soundSpeed))
        return report(fmt::format("a particle at {:.3g} m/s, {:g} times the speed of sound or more",
                                  m.maxSpeed, MachLimit));
    return "";
}

}  // namespace spindrift
