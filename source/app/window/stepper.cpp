#include "app/window/stepper.h"

#include "core/error.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace spindrift {

double wallTime() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

Stepper::Stepper(std::unique_ptr<Simulation> simulation, const Scene& scene)
    : simulation_(std::move(simulation)),
      guard_(*simulation_, scene),
      measurement_(simulation_->measure()),
      thread_([this](std::stop_token stop) { work(stop); }) {}

Stepper::~Stepper() = default;

bool Stepper::busy() const {
    std::lock_guard lock(mutex_);
    return busy_;
}

void Stepper::wait(double seconds) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !busy_; });
}

void Stepper::start(Batch batch) {
    {
        std::lock_guard lock(mutex_);
        CHECK(!busy_);
        batch_ = std::move(batch);
        busy_ = true;
    }
    changed_.notify_all();
}

Simulation& Stepper::simulation() {
    CHECK(!busy());
    return *simulation_;
}

std::unique_ptr<Simulation> Stepper::release() {
    CHECK(!busy());
    return std::move(simulation_);
}

HealthGuard& Stepper::guard() {
    CHECK(!busy());
    return guard_;
}

const Measurement& Stepper::measurement() {
    CHECK(!busy());
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return measurement_;
}

void Stepper::work(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [this] { return busy_; })) {
        lock.unlock();
        runBatch();
        lock.lock();
        busy_ = false;
        changed_.notify_all();
        if (stop.stop_requested()) return;
    }
}

void Stepper::runBatch() {
    try {
        if (batch_.before) std::exchange(batch_.before, {})(*simulation_);
        const double begin = wallTime();
        // A GPU says when it is done only when it is waited for, which costs: first one step, then
        // half of what may fit.
        for (int64_t done = 0, group = std::min<int64_t>(batch_.steps, 1); group > 0;) {
            simulation_->step(int(group));
            simulation_->wait();
            done += group;
            const double passed = wallTime() - begin, each = passed / double(done),
                         rest = batch_.seconds - passed;
            const auto fitting = std::max(int64_t(rest / (2 * each)), int64_t(rest > 0));
            group = std::min(fitting, batch_.steps - done);
        }
        measurement_ = simulation_->measure();
        finding_ = batch_.steps > 0 ? guard_.look(measurement_) : HealthGuard::Finding::Sound;
    } catch (...) { failure_ = std::current_exception(); }
}

}  // namespace spindrift
