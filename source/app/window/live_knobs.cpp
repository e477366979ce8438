#include "app/window/live_knobs.h"

#include "scene/particles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {

namespace {

constexpr size_t mostChanges = 200;

float nearer(float value, double wanted, double most) {
    return float(value + std::clamp(wanted - value, -most, most));
}

}  // namespace

bool isOfKind(const std::string& path, KnobKind kind) {
    if (kind == KnobKind::Physics)
        return !path.starts_with("view.") && !path.starts_with("window.");
    return kind == KnobKind::All || !(path.starts_with("view.camera.") || path == "view.path_of");
}

std::vector<std::string> changedKnobs(const Scene& a, const Scene& b, KnobKind kind) {
    std::vector<std::string> changed;
    visitLiveKnobs(a, b, [&](const std::string& path, const auto& x, const auto& y, const Knob&) {
        if (isOfKind(path, kind) && !(x == y)) changed.push_back(path);
    });
    return changed;
}

void copyKnobs(Scene& to, const Scene& from, KnobKind kind) {
    visitLiveKnobs(to, from, [&](const std::string& path, auto& x, const auto& y, const Knob&) {
        if (isOfKind(path, kind)) x = y;
    });
}

std::string joined(const std::vector<std::string>& paths) {
    std::string all;
    for (const std::string& path : paths) all += (all.empty() ? "" : ", ") + path;
    return all;
}

void KnobHistory::settle(const Scene& scene) {
    if (changedKnobs(settled_, scene, KnobKind::ButCamera).empty()) return;
    before_.push_back(std::exchange(settled_, scene));
    if (before_.size() > mostChanges) before_.erase(before_.begin());
}

std::vector<std::string> KnobHistory::undo(Scene& scene) {
    settle(scene);
    if (before_.empty()) return {};
    const std::vector<std::string> paths = changedKnobs(scene, before_.back(), KnobKind::ButCamera);
    copyKnobs(scene, before_.back(), KnobKind::ButCamera);
    before_.pop_back();
    settled_ = scene;
    return paths;
}

Scene towards(const Scene& wanted, const Scene& inForce, const FluidExtent& start, double passed) {
    constexpr double most = 0.05;  // change of the speed of sound in one go
    Scene next = wanted;
    const Vec3d size = start.high - start.low;
    const double before = soundSpeed(inForce, start), after = soundSpeed(wanted, start);
    // Pressure needs the time that sound takes up and down to fill the fluid anew.
    const double share =
        std::min(passed * before / (4 * std::max({size.x, size.y, size.z, 1e-9})), most);
    const double way = std::log(after / before),
                 speed = before * std::exp(std::clamp(way, -share, share));
    if (std::abs(way) > share && wanted.fluid.stiffness > 0)
        next.fluid.stiffness = float(wanted.fluid.stiffness * std::pow(speed / after, 2));
    else if (std::abs(way) > share)
        next.fluid.soundSpeed = float(speed);
    const double pressure = 0.1 * wanted.fluid.restDensity * before * before;
    next.fluid.backgroundPressure =
        nearer(inForce.fluid.backgroundPressure, wanted.fluid.backgroundPressure, share * pressure);
    next.walls.margin = nearer(inForce.walls.margin, wanted.walls.margin, 0.05 * share);
    return next;
}

}  // namespace spindrift
