#include "measure/health.h"

#include "scene/formulation.h"
#include "scene/particles.h"
#include "scene/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spindrift {
namespace {

// Upper estimate of the speed of sound, m/s: as the simulation chooses it, for a fall through the
// whole domain, and where none is named at least under the earth's gravity, so that stirring
// calm fluid is no alarm.
double mostSoundSpeed(const Scene& scene) {
    const Vec3d size = toDouble(scene.domain.max - scene.domain.min);
    FluidExtent anywhere{{0, 0, 0}, size, 0};
    for (const Body& body : scene.fluid.bodies)
        anywhere.speed = std::max(anywhere.speed, double(length(body.velocity)));
    const double chosen = soundSpeed(scene, anywhere);
    if (scene.fluid.stiffness > 0 || scene.fluid.soundSpeed > 0) return chosen;
    return std::max(chosen, scene.fluid.speedRatio * std::sqrt(2 * 9.81 * length(size)));
}

// Of the cfl mode, s: a thousandth of what sound, viscosity and time.max_step allow.
double leastStep(const Scene& scene) {
    const double h = supportRadius(scene) / 2;
    double nu = 0;
    for (const Body& body : fluidsOf(scene.fluid))
        nu = std::max(nu, double(viscosity(scene, body)) / restDensity(scene, body));
    const double sound = scene.time.cfl * h / (4 * mostSoundSpeed(scene)),
                 viscous = nu > 0 ? 0.125 * h * h / nu : sound;
    const double most = scene.time.maxStep > 0 ? double(scene.time.maxStep) : sound;
    return 1e-3 * std::min({sound, viscous, most});
}

constexpr double MachLimit = 3;

// What is wrong, "" when nothing is; and what tells the particles to blame, the larger the worse.
struct Trouble {
    std::string what;
    double (*badness)(const Particle&) = nullptr;
};
bool isFinite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
bool isFinite(const Particle& p) {
    return isFinite(p.position) && isFinite(p.velocity) && std::isfinite(p.density);
}
double speedOf(const Particle& p) { return length(p.velocity); }
double densityOf(const Particle& p) { return p.density; }
double accelerationOf(const Particle& p) { return length(p.acceleration); }
double brokenness(const Particle& p) { return isFinite(p) ? 0 : 1; }

Trouble troubleOf(const Scene& scene, const Measurement& m, double squeezed) {
    const bool numbers = m.finite && std::isfinite(m.kineticEnergy) && std::isfinite(m.maxSpeed) &&
                         std::isfinite(m.meanDensity) && std::isfinite(m.time) &&
                         std::isfinite(m.dt);
    if (!numbers) return {"values that are no numbers", brokenness};
    if (m.maxSpeed * m.dt > supportRadius(scene))
        return {
            fmt::format("a particle moves {:.3g} m in one step, farther than its support radius",
                        m.maxSpeed * m.dt),
            speedOf};
    if (m.maxSpeed > MachLimit * std::max(mostSoundSpeed(scene), m.soundSpeed))
        return {fmt::format("a particle at {:.3g} m/s, {:g} times the speed of sound or more",
                            m.maxSpeed, MachLimit),
                speedOf};
    if (!factsOf(scene).isHistorical && m.maxDensityError > squeezed)
        return {fmt::format("a particle squeezed to {:.3g} times the rest density",
                            1 + m.maxDensityError),
                densityOf};
    if (scene.time.mode == TimeMode::Cfl && m.steps > 0 && m.longestStep < leastStep(scene))
        return {
            fmt::format(
                "accelerations that leave a step of {:.2g} s, a thousandth of what sound allows",
                m.longestStep),
            accelerationOf};
    return {};
}

const char* remedyFor(const Scene& scene) {
    return scene.time.mode == TimeMode::Fixed
               ? "lower time.step or set time.mode=cfl"
               : "lower time.cfl or raise fluid.artificial_viscosity";
}
std::string when(int64_t steps, double time) {
    return fmt::format("step {} ({:.4g} s)", steps, time);
}

// Steps between two states that are kept. To fetch one costs a twentieth of a step on a CPU
// (measured), some thirty steps on a GPU, whose particles the host has to put in order (estimated).
constexpr int64_t CpuInterval = 200, GpuInterval = 3000;

}  // namespace

std::string divergence(const Scene& scene, const Measurement& m, double squeezed) {
    const Trouble trouble = troubleOf(scene, m, squeezed);
    if (trouble.what.empty()) return "";
    return fmt::format("diverged at {}: {}; {}", when(m.steps, m.time), trouble.what,
                       remedyFor(scene));
}

HealthGuard::HealthGuard(Simulation& simulation, const Scene& scene)
    : simulation_(simulation),
      scene_(scene),
      interval_(simulation.cudaDevice() == hostMemory ? CpuInterval : GpuInterval) {
    squeezed_ = 1 + std::max(simulation.measure().maxDensityError, 0.0);
    kept_[0] = simulation.state();
}

void HealthGuard::apply(const Scene& scene) {
    scene_ = scene;
    simulation_.apply(shortened());
}

// Whatever limits the step, it becomes this share of what it was.
Scene HealthGuard::shortened() const {
    Scene s = scene_;
    if (share_ == 1) return s;
    s.time.step *= float(share_), s.time.cfl *= float(share_);
    const float shorter = float(share_ * stepBefore_);
    if (stepBefore_ > 0 && (s.time.maxStep <= 0 || s.time.maxStep > shorter))
        s.time.maxStep = shorter;
    return s;
}

HealthGuard::Finding HealthGuard::look(Measurement& m) {
    said_.clear();
    const std::string why = troubleOf(shortened(), m, squeezed_).what;
    if (why.empty()) {
        calmDown(m);
        keepIfDue(m);
        return Finding::Sound;
    }
    const bool again = tries_ < scene_.time.retries;
    again ? goBack(m, why) : giveUp(m, why);
    return again ? Finding::WentBack : Finding::GaveUp;
}

void HealthGuard::keep(RunState state) {
    if (kept_[1].clock.steps > 0) kept_[0] = std::move(kept_[1]);
    kept_[1] = std::move(state);
}

// What is kept must be good: not on its way into trouble, nor from before the place where there was
// some.
void HealthGuard::keepIfDue(const Measurement& m) {
    const bool calm = m.maxSpeed < mostSoundSpeed(scene_) &&
                      (factsOf(scene_).isHistorical || m.maxDensityError < squeezed_ / 2);
    if (calm && m.steps >= lastGood().clock.steps + interval_ && m.time > troubleTime_)
        keep(simulation_.state());
}

// Beyond the trouble by as much time as it had taken to come, and by more steps than are lost when
// it comes back: so every run ends.
void HealthGuard::calmDown(const Measurement& m) {
    if (!inTrouble() && share_ >= most_) return;
    if (m.time < 2 * troubleTime_ - backTime_ || m.steps < backSteps_ + 3 * interval_) return;
    tries_ = 0;
    const double calm = m.time - backTime_;
    backTime_ = troubleTime_ = m.time, backSteps_ = m.steps;
    if (share_ >= most_) return;
    share_ *= 2, soonAfter_ = m.time + 2 * calm;
    simulation_.apply(shortened());
    said_ = fmt::format("calm at {}: the time step grows to {:g} of what it was",
                        when(m.steps, m.time), share_);
    if (share_ == 1)
        said_ = fmt::format("calm at {}: the time step is what it was", when(m.steps, m.time));
}

void HealthGuard::goBack(Measurement& m, const std::string& why) {
    const RunState& state = inTrouble() ? kept_[0] : lastGood();
    if (!inTrouble() && m.time < soonAfter_)
        most_ = share_ / 2;  // longer steps have brought it back
    const std::string at = when(m.steps, m.time);
    troubleTime_ = std::isfinite(m.time) ? std::max(troubleTime_, m.time) : troubleTime_;
    stepBefore_ = state.clock.dt > 0 ? state.clock.dt : std::isfinite(m.dt) ? m.dt / share_ : 0;
    ++tries_, ++allRetries_;
    share_ /= 2;
    simulation_.apply(shortened());
    simulation_.restart(state);
    backTime_ = state.clock.time, backSteps_ = state.clock.steps;
    m = simulation_.measure();
    said_ = fmt::format("{} at {}: back to {}, on with {:g} of the time step, try {} of {}", why,
                        at, when(m.steps, m.time), share_, tries_, scene_.time.retries);
}

void HealthGuard::giveUp(const Measurement& m, const std::string& why) {
    blame(m);
    std::string who;
    for (const Particle& p : culprits_)
        who += fmt::format("{} {}", who.empty() ? "particle" : ",", p.id);
    const Vec3d at = culprits_.empty() ? Vec3d{0, 0, 0} : culprits_[0].position;
    said_ = fmt::format(
        "diverged at {} at ({:.4g}, {:.4g}, {:.4g}) m: {}; {}; {}{}", when(m.steps, m.time), at.x,
        at.y, at.z, why, who,
        tries_ > 0 ? fmt::format("shorter steps have not helped {} times; ", tries_) : "",
        remedyFor(scene_));
}

// At most five, none of them half as bad as the worst.
void HealthGuard::blame(const Measurement& m) {
    const auto badness = troubleOf(shortened(), m, squeezed_).badness;
    culprits_ = simulation_.particles();
    // What is no number is worst of all.
    auto key = [&](const Particle& p) {
        return isFinite(p) && std::isfinite(badness(p)) ? badness(p)
                                                        : std::numeric_limits<double>::max();
    };
    const size_t most = std::min<size_t>(5, culprits_.size());
    std::partial_sort(culprits_.begin(), culprits_.begin() + ptrdiff_t(most), culprits_.end(),
                      [&](const Particle& a, const Particle& b) {
                          return key(a) != key(b) ? key(a) > key(b) : a.id < b.id;
                      });
    culprits_.resize(most);
    while (culprits_.size() > 1 && key(culprits_.back()) < key(culprits_[0]) / 2)
        culprits_.pop_back();
    const Placement& good = lastGood().particles;
    for (Particle& p : culprits_) {
        if (isFinite(p.position)) continue;
        size_t index = size_t(p.id);
        if (!good.ids.empty())
            index =
                size_t(std::lower_bound(good.ids.begin(), good.ids.end(), p.id) - good.ids.begin());
        const bool hasCome =
            good.ids.empty() || (index < good.ids.size() && good.ids[index] == p.id);
        if (hasCome && index < good.positions.size())
            p.position = toDouble(good.positions[index]) + toDouble(scene_.domain.min);
    }
}

}  // namespace spindrift
