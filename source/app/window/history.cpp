#include "app/window/history.h"

#include "app/window/live_knobs.h"

#include <algorithm>
#include <utility>

namespace spindrift {

namespace {

// s of the clock: as often as a film shows a picture, however little it costs.
constexpr double shortest = 1.0 / 30;

template <class T> int64_t bytesOf(const std::vector<T>& v) {
    return int64_t(v.capacity() * sizeof(T));
}

int64_t bytesOf(const RunState& s) {
    const Placement& p = s.particles;
    return bytesOf(p.positions) + bytesOf(p.velocities) + bytesOf(p.walls) + bytesOf(p.pressures) +
           bytesOf(p.solidSizes) + bytesOf(p.densities) + bytesOf(p.bodies) + bytesOf(p.solids) +
           bytesOf(p.ids) + bytesOf(p.heldBy) + bytesOf(s.densities) + bytesOf(s.pressures) +
           bytesOf(s.solids) + bytesOf(s.objects.positions) + bytesOf(s.objects.velocities) +
           bytesOf(s.objects.broken);
}

// What a simulation gives has room to grow.
void tighten(RunState& s) {
    for (std::vector<Vec3>* v : {&s.particles.positions, &s.particles.velocities,
                                 &s.objects.positions, &s.objects.velocities})
        v->shrink_to_fit();
    for (std::vector<int>* v : {&s.particles.ids, &s.particles.heldBy}) v->shrink_to_fit();
    for (std::vector<float>* v : {&s.densities, &s.pressures}) v->shrink_to_fit();
    s.objects.broken.shrink_to_fit();
}

// Its numbers, and those of its lists.
int64_t bytesOf(const Scene& scene) {
    int64_t bytes = sizeof(Scene);
    visitKnobs(scene, [&](const std::string&, const auto& value, const Knob&) {
        bytes += int64_t(sizeof value);
        if constexpr (requires { value.capacity(); })
            bytes += int64_t(value.capacity() * sizeof(value[0]));
    });
    return bytes;
}

int64_t bytesOf(const Moment& m) {
    return int64_t(sizeof m) + bytesOf(m.state) + bytesOf(m.measurement.solids) +
           bytesOf(m.measurement.faces);
}

bool isSame(const Scene& a, const Scene& b) {
    return a.simulation.formulation == b.simulation.formulation &&
           changedKnobs(a, b, KnobKind::Physics).empty();
}

// Most moments have the knobs of the one before.
std::shared_ptr<const Scene> sharedOf(const Scene& scene,
                                      const std::shared_ptr<const Scene>& before) {
    return before && isSame(*before, scene) ? before : std::make_shared<const Scene>(scene);
}

}  // namespace

void History::setBudget(double megabytes) {
    const double before = std::exchange(budget_, 1e6 * megabytes);
    if (budget_ == before) return;
    if (budget_ > before) interval_ = 0, isTooSmall_ = false;  // as many again as there is room for
    if (budget_ <= 0) return clear();
    thin();
}

bool History::isDue(double time, int64_t steps) const {
    if (!isOn() || isTooSmall_) return false;
    if (empty()) return true;
    if (steps <= back().state.clock.steps) return false;
    if (std::binary_search(keptAt_.begin(), keptAt_.end(), steps)) return true;
    return stepsToNext(steps) == never && time >= back().time() + interval_ &&
           passed_ >= std::max(cost_ / share, shortest);
}

int64_t History::stepsToNext(int64_t steps) const {
    const auto next = std::upper_bound(keptAt_.begin(), keptAt_.end(), steps);
    return next == keptAt_.end() ? never : *next - steps;
}

void History::add(RunState state, const Measurement& m, const Scene& asked, const Scene& inForce,
                  double cost) {
    passed_ = 0, cost_ = keptAt_.empty() ? 0 : cost;  // the first time all takes longer
    const int64_t steps = state.clock.steps;
    const auto place = std::lower_bound(keptAt_.begin(), keptAt_.end(), steps);
    if (place == keptAt_.end() || *place != steps) keptAt_.insert(place, steps);
    if (!empty() && back().state.clock.steps == steps) moments_.pop_back();  // of other knobs
    walls_ = std::exchange(state.particles.walls, {});
    tighten(state);
    Moment moment{std::move(state), m, nullptr, nullptr};
    moment.asked = sharedOf(asked, empty() ? nullptr : back().asked);
    moment.inForce = sharedOf(inForce, moment.asked);
    moments_.push_back(std::move(moment));
    thin();
}

void History::dropAfter(double time) {
    std::erase_if(moments_, [&](const Moment& m) { return m.time() > time; });
    if (size() < 2) interval_ = 0;
    count();
}

void History::clear() {
    moments_.clear(), walls_.clear(), keptAt_.clear();
    interval_ = passed_ = cost_ = 0;
    isTooSmall_ = false;
    bytes_ = 0;
}

RunState History::state(size_t i) const {
    RunState state = moments_[i].state;
    state.particles.walls = walls_;
    return state;
}

size_t History::at(double time) const {
    const auto after = std::lower_bound(moments_.begin(), moments_.end(), time,
                                        [](const Moment& m, double t) { return m.time() < t; });
    if (after == moments_.begin()) return 0;
    const auto i = size_t(after - moments_.begin());
    return i == size() || time - moments_[i - 1].time() < moments_[i].time() - time ? i - 1 : i;
}

void History::count() {
    bytes_ = bytesOf(walls_) + bytesOf(keptAt_);
    const Scene* before = nullptr;
    for (const Moment& m : moments_) {
        bytes_ += bytesOf(m);
        if (m.asked.get() != before) bytes_ += bytesOf(*m.asked);
        if (m.inForce != m.asked) bytes_ += bytesOf(*m.inForce);
        before = m.asked.get();
    }
}

void History::thin() {
    for (count(); double(bytes_) > budget_ && size() > 2; count()) {
        const double span = back().time() - moments_.front().time();
        interval_ = std::max(2 * interval_, 2 * span / double(size() - 1));
        std::vector<Moment> kept;
        for (Moment& m : moments_)
            if (kept.empty() || &m == &moments_.back() ||
                m.time() >= kept.back().time() + 0.75 * interval_)
                kept.push_back(std::move(m));
        moments_ = std::move(kept);
    }
    if (double(bytes_) <= budget_) return;
    clear();
    isTooSmall_ = true;
}

}  // namespace spindrift
