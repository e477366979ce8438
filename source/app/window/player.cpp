#include "app/window/player.h"

#include "core/error.h"
#include "measure/checkpoint.h"
#include "measure/probes.h"
#include "scene/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace spindrift {

namespace {

// A run that can't keep up forgets what it is late by beyond this, instead of racing to catch up.
constexpr double longestLag = 0.1;  // s
constexpr size_t longestCurve = 1024;

}  // namespace

void Curves::add(const Measurement& m) {
    if (!time.empty() && (m.time <= time.back() || m.time < time.back() + least_)) return;
    std::vector<float>* curves[] = {&time, &kinetic, &potential, &total, &densityError};
    if (time.size() >= longestCurve) {
        for (std::vector<float>* curve : curves) {
            for (size_t i = 0; i < curve->size() / 2; ++i) (*curve)[i] = (*curve)[2 * i];
            curve->resize(curve->size() / 2);
        }
        least_ = m.time / double(time.size());
    }
    const double values[] = {m.time, m.kineticEnergy, m.potentialEnergy,
                             m.kineticEnergy + m.potentialEnergy, m.densityError};
    for (size_t c = 0; c < std::size(curves); ++c) curves[c]->push_back(float(values[c]));
    dimensions = m.dimensions;
}

void Curves::dropAfter(double t) {
    const auto keep = size_t(std::upper_bound(time.begin(), time.end(), float(t)) - time.begin());
    for (std::vector<float>* curve : {&time, &kinetic, &potential, &total, &densityError})
        curve->resize(keep);
}

Stir stirOf(const Stirrer& stirrer, Vec3 center, float radius, Vec3 velocity) {
    constexpr float rate = 30, pull = 10;  // 1/s, at strength 1
    const float sign = stirrer.mode == StirMode::Drag      ? 0.0f
                       : stirrer.mode == StirMode::Attract ? 1.0f
                                                           : -1.0f;
    return {center, radius, velocity, rate * stirrer.strength, sign * pull * stirrer.strength};
}

Player::Player(Loaded loaded) { begin(std::move(loaded), false); }

void Player::begin(Loaded loaded, bool again) {
    const RunState state = loaded.simulation->state();
    const std::string hidden =
        Probes(loaded.start.scene).hiddenBySolids(loaded.start.scene, *loaded.simulation);
    stepper_ = std::make_unique<Stepper>(std::move(loaded.simulation), loaded.start.scene);
    const Camera camera = scene.view.camera;
    loaded.start.scene.view.up =
        upOf(loaded.start.scene);  // gravity may change, the view should not
    scene = asked_ = inForce_ = loaded.start.scene;
    if (again) scene.view.camera = camera;
    origin_ = std::move(loaded.start);
    start_ = state.start;
    measurement_ = stepper_->measurement();
    curves_ = {};
    history_.clear();
    kept_.reset(), shown_.reset();
    for (const CurvePoint& p : origin_.before) {
        Measurement m;
        m.time = p.time, m.kineticEnergy = p.kineticEnergy, m.potentialEnergy = p.potentialEnergy;
        m.densityError = p.densityError;
        curves_.add(m);
    }
    curves_.add(measurement_);
    validity_ = Validity(scene);
    validity_.look(measurement_);
    changes_.clear();
    halted.clear();
    notice = hidden;
    if (!hidden.empty()) std::fprintf(stderr, "spindrift: %s\n", hidden.c_str());
    culprits.clear();
    firstSteps_ = measurement_.steps;
    savedSteps_ = 0;
    beginRates();
    applyWanted_ = underWay_ = stepWanted_ = stirWanted_ = holdWanted_ = collected_ = false;
    ++generation_;
}

// Of a run that begins at a state.
void Player::beginRates() {
    lag_ = stepsPerSecond_ = realTimeFactor_ = 0;
    rateTime_ = inForceSince_ = measurement_.time;
    rateSteps_ = measurement_.steps;
    stepsLeft_ = std::max<int64_t>(scene.compute.steps - measurement_.steps, 0);
    lastProceed_ = rateSince_ = wallTime();
}

void Player::load(const std::string& file) {
    loader_ = std::make_unique<Loader>([file] { return chooseStart(file, {}); });
    resets_ = false;
}

void Player::reset() { beginAnew(origin_.scene); }

void Player::beginAnew(Scene changed) {
    Start again = origin_;
    again.scene = std::move(changed);
    again.scene.compute.backend = scene.compute.backend;  // it may have been switched
    loader_ = std::make_unique<Loader>([again = std::move(again)] { return again; });
    resets_ = true;
}

bool Player::takeLoaded() {
    if (!loader_ || !loader_->done()) return false;
    const std::unique_ptr<Loader> loader = std::move(loader_);
    begin(loader->take(), resets_);
    return true;
}

void Player::goOnWith(Formulation formulation, Backend backend) {
    if (looksBack())
        throw Error(Failure::Usage,
                    "looking back: go on from here (Enter) or return to the present (Esc) first");
    while (stepper_->busy()) stepper_->wait(1);
    bool moved = false;
    collect(moved);
    const auto with = [&](Scene s) {
        s.simulation.formulation = formulation, s.compute.backend = backend;
        return s;
    };
    const Scene next = with(inForce_);
    stepper_ =
        std::make_unique<Stepper>(makeSimulation(next, stepper_->simulation().state()), next);
    if (formulation != scene.simulation.formulation) validity_ = Validity(next);
    scene = with(scene), asked_ = with(asked_), inForce_ = next;
    measurement_ = stepper_->measurement();
    stirWanted_ = holdWanted_ = false;
}

void Player::stepOnce() {
    running = false;
    stepWanted_ = true;
}

void Player::saveCheckpoint(const std::string& file) {
    while (stepper_->busy()) stepper_->wait(1);
    const RunState state = culprits.empty() || looksBack() ? stepper_->simulation().state()
                                                           : stepper_->guard().lastGood();
    std::vector<CurvePoint> curves;
    for (size_t i = 0; i < curves_.time.size() && curves_.time[i] <= float(state.clock.time); ++i)
        curves.push_back(
            {curves_.time[i], curves_.kinetic[i], curves_.potential[i], curves_.densityError[i]});
    writeCheckpoint(file, scene, state, curves);
    savedSteps_ = std::max({savedSteps_, state.clock.steps, measurement_.steps});
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
    if (shown_) {
        try {
            stepper_->measurement();
        } catch (const Error& error) { halt(error.what()); }
        measurement_ = history_[*shown_].measurement;
        return;
    }
    takeKept();
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
    const bool wentBack = stepper_->finding() == HealthGuard::Finding::WentBack;
    if (wentBack) {  // rates count what has been gained since
        rateTime_ -= before - measurement_.time, rateSteps_ -= stepsBefore - measurement_.steps;
        inForceSince_ = std::min(inForceSince_, measurement_.time);
        dropAfter(measurement_.time);
    }
    curves_.add(measurement_);
    validity_.look(measurement_);
    if (stepper_->finding() == HealthGuard::Finding::GaveUp) {
        culprits = guard.culprits();
        halt(guard.said() + ", then press R, or Left to go on from before");
    } else if (!guard.said().empty()) {
        notice = guard.said();
    }
    if (wentBack) takeBackChangesAfter(measurement_.time);
}

// The run has gone back to this time, s.
void Player::dropAfter(double time) {
    curves_.dropAfter(time);
    validity_.dropAfter(time);
    history_.dropAfter(time);
}

// The run has come into trouble: what was changed since the state that it goes on from is to blame.
void Player::takeBackChangesAfter(double time) {
    const auto first = std::find_if(changes_.begin(), changes_.end(),
                                    [&](const Change& c) { return c.until >= time; });
    if (first == changes_.end()) return;
    const std::string paths = joined(changedKnobs(scene, first->before, KnobKind::Physics));
    copyKnobs(scene, first->before, KnobKind::Physics);
    asked_ = scene;
    changes_.erase(first, changes_.end());
    underWay_ = true;
    if (!paths.empty()) notice += "; the run could not follow, so it was put back: " + paths;
}

// What was asked for becomes what the run is on its way to, if it makes sense.
void Player::meetRequests() {
    constexpr size_t mostChanges = 64;
    if (applyWanted_ && !changedKnobs(scene, asked_, KnobKind::Physics).empty()) try {
            Simulation& s = stepper_->simulation();
            checkScene(scene, "panel", ParticleCount{s.fluidCount(), s.wallCount()});
            if (const std::string why = whyNotForGpus(scene);
                s.cudaDevice() != hostMemory && !why.empty())
                throw Error(Failure::NoDevice, why + ", or go on, on the CPU (G)");
            const Scene before = std::exchange(asked_, scene);
            if (!looksBack()) {
                changes_.push_back({measurement_.time, before});
                if (changes_.size() > mostChanges) changes_.erase(changes_.begin());
                underWay_ = true;
            }
        } catch (const Error& error) {
            copyKnobs(scene, asked_, KnobKind::Physics);
            notice = error.what();
        }
    try {
        followKnobs();
    } catch (const Error& error) { halt(error.what()); }
    if (stirWanted_) stepper_->simulation().stir(stir_);
    if (holdWanted_) stepper_->simulation().hold(hold_);
    applyWanted_ = stirWanted_ = holdWanted_ = false;
}

void Player::followKnobs() {
    if (!underWay_ || looksBack()) return;
    inForce_ = towards(asked_, inForce_, start_, measurement_.time - inForceSince_);
    inForceSince_ = measurement_.time;
    stepper_->guard().apply(inForce_);
    underWay_ = !changedKnobs(inForce_, asked_, KnobKind::Physics).empty();
    if (!changes_.empty()) changes_.back().until = measurement_.time;
}

void Player::proceed(double budget) {
    const double now = wallTime(), passed = now - lastProceed_;
    const double speed = scene.view.speed;
    lag_ = std::min(lag_ + (running ? speed * passed : 0), speed * longestLag);
    lastProceed_ = now;
    if (loader_) return;
    if (shown_) return goOnLooking();
    history_.setBudget(double(scene.view.history));
    if (running) history_.passed(passed);
    const Measurement& m = measurement_;
    const double dt = m.dt > 0 ? m.dt : 1e-4;
    auto due = int64_t(std::ceil(lag_ / dt));
    if (!halted.empty() || !(stepWanted_ || (running && due > 0))) return;
    if (stepsLeft_ > 0) due = std::min(due, stepsLeft_);
    const bool keeps = history_.isDue(m.time, m.steps);
    due = std::min(due, history_.stepsToNext(m.steps));
    due = std::min(due, std::max<int64_t>(int64_t(std::min((watchAt - m.time) / dt, 1e9)), 1));
    stepper_->start({stepWanted_ ? 1 : due, stepWanted_ ? 0 : budget,
                     keeps ? keeping() : std::function<void(Simulation&)>()});
    stepWanted_ = collected_ = false;
}

void Player::updateRates() {
    constexpr double period = 0.5;  // s
    const double now = wallTime(), wall = now - rateSince_;
    if (wall < period || looksBack()) return;
    stepsPerSecond_ = double(measurement_.steps - rateSteps_) / wall;
    realTimeFactor_ = (measurement_.time - rateTime_) / wall;
    rateSince_ = now;
    rateSteps_ = measurement_.steps;
    rateTime_ = measurement_.time;
}

}  // namespace spindrift
