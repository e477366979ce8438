// How a player keeps moments of its run, shows them and goes on from one.
#include "app/window/player.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace spindrift {

// The run goes on from what is kept, so that it has the same bits when it goes on from there again;
// not with local steps, because that would wake what rests.
std::function<void(Simulation&)> Player::keeping() {
    kept_ = std::make_shared<Kept>();
    kept_->measurement = measurement_;
    return [kept = kept_, goesOn = inForce_.time.mode != TimeMode::Local](Simulation& simulation) {
        const double begin = wallTime();
        kept->state = simulation.state();
        if (goesOn) simulation.restart(kept->state);
        simulation.wait();
        kept->seconds = wallTime() - begin;
    };
}

void Player::takeKept() {
    const std::shared_ptr<Kept> kept = std::exchange(kept_, {});
    if (!kept || kept->seconds == 0) return;
    if (!kept->isPresent && history_.isNearTheLast(kept->state.clock.time)) return;
    history_.add(std::move(kept->state), kept->measurement, asked_, inForce_, kept->seconds);
    if (history_.isTooSmall()) sayTooSmall();
}

void Player::sayTooSmall() {
    notice = fmt::format(
        "the run can't be looked back at: two moments take more than view.history, {:g} MB; raise "
        "it",
        scene.view.history);
}

bool Player::lookBack() {
    if (shown_) return true;
    while (stepper_->busy()) stepper_->wait(1);
    bool moved = false;
    collect(moved);
    const bool isBroken = !halted.empty();  // its last moment stands for it
    if (halted.empty() && history_.isOn() && !history_.isTooSmall()) {
        keeping()(stepper_->simulation());
        kept_->isPresent = true;
        takeKept();
    }
    if (history_.empty()) {
        if (!history_.isOn())
            notice = "nothing is kept to look back at: view.history is 0";
        else if (history_.isTooSmall())
            sayTooSmall();
        else
            notice = "there is nothing to look back at";
        return false;
    }
    ran_ = std::exchange(running, false);
    returns_ = stepWanted_ = false;
    shown_ = wanted_ = history_.size() - 1;
    if (isBroken) show(wanted_);
    return true;
}

void Player::look(size_t moment) {
    if (!shown_) return;
    wanted_ = std::min(moment, history_.size() - 1);
    returns_ = false;
}

void Player::returnToPresent() {
    if (!shown_) return;
    wanted_ = history_.size() - 1;
    returns_ = true;
}

// The simulation is at hand.
void Player::goOnLooking() {
    if (wanted_ != *shown_) return show(wanted_);
    if (!std::exchange(returns_, false)) return;
    shown_.reset();
    beginRates();
    underWay_ = !changedKnobs(inForce_, asked_, KnobKind::Physics).empty();
    if (underWay_) changes_.push_back({measurement_.time, *history_.back().asked});
    running = ran_;
}

void Player::show(size_t moment) {
    const Moment& m = history_[moment];
    const auto dropped = joined(changedKnobs(scene, *history_[*shown_].asked, KnobKind::Physics));
    if (!dropped.empty()) notice = "knobs are as they were at this moment again: " + dropped;
    Scene next = *m.inForce;
    next.compute.backend = inForce_.compute.backend, next.view = scene.view;
    auto state = std::make_shared<const RunState>(history_.state(moment));
    try {
        if (next.simulation.formulation != inForce_.simulation.formulation) {
            stepper_ = std::make_unique<Stepper>(makeSimulation(next, *state), next);
        } else {
            // The present's steps are as long as its guard lets them be.
            const bool isPresent = moment + 1 == history_.size();
            isPresent ? stepper_->guard().apply(next) : stepper_->simulation().apply(next);
            stepper_->start({0, 0, [state](Simulation& simulation) {
                                 simulation.restart(*state);
                                 simulation.wait();
                             }});
        }
    } catch (const Error& error) {
        wanted_ = *shown_;
        notice = error.what();
        return;
    }
    inForce_ = next;
    copyKnobs(scene, *m.asked, KnobKind::Physics);
    scene.simulation.formulation = m.asked->simulation.formulation;
    asked_ = scene;
    shown_ = moment;
    collected_ = false;
}

void Player::goOnFromHere() {
    if (!shown_) return;
    while (stepper_->busy()) stepper_->wait(1);
    const std::string before = halted;
    if (const size_t target = wanted_; target != *shown_) {
        show(target);
        if (*shown_ != target) return;  // it says why
        while (stepper_->busy()) stepper_->wait(1);
    }
    bool moved = false;
    collect(moved);  // knobs that were changed since
    if (halted != before) return;
    const Moment& m = history_[*shown_];
    const bool isPresent = *shown_ + 1 == history_.size() && halted.empty();
    shown_.reset();
    running = true;
    measurement_ = m.measurement;
    if (!isPresent)  // what the guard knows is of another future
        stepper_ = std::make_unique<Stepper>(stepper_->release(), inForce_);
    underWay_ = !changedKnobs(inForce_, asked_, KnobKind::Physics).empty();
    std::erase_if(changes_, [&](const Change& c) { return c.until > measurement_.time; });
    if (underWay_) changes_.push_back({measurement_.time, *m.asked});
    if (savedSteps_ > measurement_.steps) savedSteps_ = 0;
    halted.clear(), culprits.clear();
    dropAfter(measurement_.time);
    beginRates();
}

}  // namespace spindrift
