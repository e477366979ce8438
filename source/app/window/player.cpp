#include "app/window/player.h"

#include "core/error.h"
#include "measure/checkpoint.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace spindrift {

namespace {

double wallTime() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// A run that can't keep up forgets what it is late by beyond this, instead of racing to catch up.
constexpr double longestLag = 0.1;  // s
constexpr size_t longestHistory = 1024;

}  // namespace

void History::add(const Measurement& m) {
    if (!time.empty() && (m.time <= time.back() || m.time < time.back() + least_)) return;
    std::vector<float>* curves[] = {&time, &kinetic, &potential, &total, &densityError};
    if (time.size() >= longestHistory) {
        for (std::vector<float>* curve : curves) {
            for (size_t i = 0; i < curve->size() / 2; ++i) (*curve)[i] = (*curve)[2 * i];
            curve->resize(curve->size() / 2);
        }
        least_ = m.time / double(time.size());
    }
    const double values[] = {m.time, m.kineticEnergy, m.potentialEnergy,
                             m.kineticEnergy + m.potentialEnergy, m.densityError};
    for (size_t c = 0; c < std::size(curves); ++c) curves[c]->push_back(float(values[c]));
}

void History::dropAfter(double t) {
    const auto keep = size_t(std::upper_bound(time.begin(), time.end(), float(t)) - time.begin());
    for (std::vector<float>* curve : {&time, &kinetic, &potential, &total, &densityError}) curve->resize(keep);
}

Player::Player(Start start) {
    auto simulation = startSimulation(start.scene, start.state);
    begin(std::move(start.scene), std::move(simulation));
    initialCamera_ = scene.view.camera;
}

void Player::begin(Scene s, std::unique_ptr<Simulation> simulation) {
    stepper_ = std::make_unique<Stepper>(std::move(simulation), s);
    scene = std::move(s);
    measurement_ = stepper_->measurement();
    history_ = {};
    history_.add(measurement_);
    halted.clear();
    notice.clear();
    culprits.clear();
    lag_ = rateTime_ = stepsPerSecond_ = realTimeFactor_ = 0;
    rateSteps_ = 0;
    stepsLeft_ = scene.compute.steps;
    lastProceed_ = rateSince_ = wallTime();
    applyWanted_ = stepWanted_ = stirWanted_ = holdWanted_ = collected_ = false;
    ++generation_;
}

void Player::load(const std::string& file) {
    Start next = chooseStart(file, {});
    auto simulation = startSimulation(next.scene, next.state);
    begin(std::move(next.scene), std::move(simulation));
    initialCamera_ = scene.view.camera;
}

void Player::reset() {
    Scene next = scene;
    auto simulation = makeSimulation(next);
    begin(std::move(next), std::move(simulation));
}

void Player::switchBackend(Backend backend) {
    while (stepper_->busy()) stepper_->wait(1);
    Scene next = scene;
    next.compute.backend = backend;
    stepper_ = std::make_unique<Stepper>(makeSimulation(next, stepper_->simulation().state()), next);
    scene.compute.backend = backend;
    stirWanted_ = holdWanted_ = false;
}

void Player::stepOnce() {
    running = false;
    stepWanted_ = true;
}

void Player::saveCheckpoint(const std::string& file) {
    while (stepper_->busy()) stepper_->wait(1);
    writeCheckpoint(file, scene, culprits.empty() ? stepper_->simulation().state() : stepper_->guard().lastGood());
}

void Player::halt(const std::string& why) {
    running = false;
    halted = why;
}

bool Player::collect(bool& moved) {
    moved = false;
    if (stepper_->busy()) return false;
    if (!collected_) {
        takeMeasurement();
        moved = collected_ = true;
    }
    updateRates();
    meetRequests();
    return true;
}

void Player::takeMeasurement() {
    const double before = measurement_.time;
    const int64_t stepsBefore = measurement_.steps;
    try {
        measurement_ = stepper_->measurement();
    } catch (const Error& error) { halt(error.what()); }
    lag_ -= measurement_.time - before;
    if (stepsLeft_ > 0) {
        stepsLeft_ = std::max<int64_t>(stepsLeft_ - (measurement_.steps - stepsBefore), 0);
        if (stepsLeft_ == 0) running = false;
    }
    HealthGuard& guard = stepper_->guard();
    if (stepper_->finding() == HealthGuard::Finding::WentBack) history_.dropAfter(measurement_.time);
    history_.add(measurement_);
    if (stepper_->finding() == HealthGuard::Finding::GaveUp) {
        culprits = guard.culprits();
        halt(guard.said() + ", then press R");
    } else if (!guard.said().empty()) {
        notice = guard.said();
    }
}

void Player::meetRequests() {
    try {
        if (applyWanted_) stepper_->guard().apply(scene);
    } catch (const Error& error) { halt(error.what()); }
    if (stirWanted_) stepper_->simulation().stir(stir_);
    if (holdWanted_) stepper_->simulation().hold(hold_);
    applyWanted_ = stirWanted_ = holdWanted_ = false;
}

void Player::proceed(double budget) {
    const double now = wallTime();
    lag_ = std::min(lag_ + (running ? now - lastProceed_ : 0), longestLag);
    lastProceed_ = now;
    const double dt = measurement_.dt > 0 ? measurement_.dt : 1e-4;
    auto due = int64_t(std::ceil(lag_ / dt));
    if (stepsLeft_ > 0) due = std::min(due, stepsLeft_);
    if (!halted.empty() || !(stepWanted_ || (running && due > 0))) return;
    stepper_->start(stepWanted_ ? Batch{1, 0} : Batch{due, budget});
    stepWanted_ = collected_ = false;
}

void Player::updateRates() {
    constexpr double period = 0.5;  // s
    const double now = wallTime(), wall = now - rateSince_;
    if (wall < period) return;
    stepsPerSecond_ = double(measurement_.steps - rateSteps_) / wall;
    realTimeFactor_ = (measurement_.time - rateTime_) / wall;
    rateSince_ = now;
    rateSteps_ = measurement_.steps;
    rateTime_ = measurement_.time;
}

}  // namespace spindrift
