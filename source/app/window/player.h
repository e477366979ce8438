#pragma once
// Plays a scene in real time where it can: run, pause, step, reset, load. Knows nothing of pixels.
#include "app/window/history.h"
#include "app/window/live_knobs.h"
#include "app/window/loader.h"
#include "app/window/stepper.h"
#include "measure/validity.h"
#include "scene/scene.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

// Curves over the whole run, evenly spaced; when they grow long every second sample goes.
struct Curves {
    std::vector<float> time, kinetic, potential, total, densityError;  // s, J, J, J, 1
    int dimensions = 3;                                                // in two J/m
    void add(const Measurement&);
    void dropAfter(double time);  // the run has gone back to it

private:
    double least_ = 0;  // s between samples
};

// What the mouse does there, by the knobs: dragged along at its velocity (m/s), or pulled to it, or
// pushed away.
Stir stirOf(const Stirrer&, Vec3 center, float radius, Vec3 velocity);

class Player {
public:
    explicit Player(Loaded);

    Scene scene;  // edit live knobs, then call knobsChanged()
    bool running = true;
    std::string halted;  // why the run was stopped by itself; empty = it wasn't
    std::string
        notice;  // what the health guard says while the run goes on; whoever shows it empties it
    std::vector<Particle> culprits;                       // of a run that was stopped by itself
    double watchAt = std::numeric_limits<double>::max();  // s: there it is wanted at hand, about

    // Requests; they are met when the simulation is at hand (collect).
    // Knobs that make no sense are put back, with a notice.
    void knobsChanged() { applyWanted_ = true; }
    void stepOnce();
    void stir(const Stir& s) {
        stir_ = s;
        stirWanted_ = true;
    }
    void hold(const Hold& h) {
        hold_ = h;
        holdWanted_ = true;
    }

    // Makes another scene, or the same as it was loaded, ready in the background; the run stands
    // still meanwhile.
    void load(const std::string& file);
    void reset();
    // What is being made ready; null: nothing.
    const Task* loading() const { return loader_ ? &loader_->progress() : nullptr; }
    void cancelLoading() { loader_.reset(); }
    // True when the new run has begun. Throws Error when it can't; then nothing has changed.
    bool takeLoaded();
    // The same with other knobs than live ones: from here on that is the scene as it was loaded.
    void beginAnew(Scene);
    // Goes on from where the run stands with another formulation, or on another device. Blocks
    // until the step at hand is done. Throws Error; then nothing has changed.
    void goOnWith(Formulation, Backend);

    // True when the simulation is at hand: the requests are met, measurement() is new, simulation()
    // may be used until proceed(). `moved` tells whether steps were made since the last time.
    bool collect(bool& moved);
    // Starts the steps that real time asks for, as many as fit into `budget` seconds of wall time.
    void proceed(double budget);

    // --- looking back (history.h): the run stands still and what is at hand is a moment of it ---

    // Goes to the moment that the run has come to. Blocks until the step at hand is done. False
    // where nothing is kept; the notice says why.
    bool lookBack();
    bool looksBack() const { return shown_.has_value(); }
    // To be shown as soon as it can be. Knobs are as they were then; what of them was changed since
    // the last moment was asked for is taken back, with a notice.
    void look(size_t moment);
    size_t lookedAt() const { return wanted_; }
    // As if it had not looked back.
    void returnToPresent();
    // Forgets what came after the moment that is shown. Blocks until it is.
    void goOnFromHere();
    const History& history() const { return history_; }

    // Stops the run and says why.
    void halt(const std::string& why);

    bool busy() const { return stepper_->busy(); }
    void wait(double seconds) const { stepper_->wait(seconds); }
    Simulation& simulation() { return stepper_->simulation(); }
    const Measurement& measurement() const { return measurement_; }
    // Writes where the run stands, or its last good state when it was stopped by itself. Throws
    // Error (Output).
    void saveCheckpoint(const std::string& file);
    // Whether steps would be lost if it ended now.
    bool unsaved() const { return stepsMade() > std::max(firstSteps_, savedSteps_); }
    const Curves& curves() const { return curves_; }
    // What of the run is outside the validity of its method.
    const std::vector<Remark>& remarks() const { return validity_.remarks(); }
    const Scene& loadedScene() const { return origin_.scene; }
    const std::string& file() const { return origin_.file; }
    bool beganFromCheckpoint() const { return origin_.state.has_value(); }
    double stepsPerSecond() const { return stepsPerSecond_; }
    double realTimeFactor() const { return realTimeFactor_; }  // simulated / wall time
    int generation() const { return generation_; }             // grows with every new run

private:
    // Knobs that were changed, what they were before, and until when (s simulated) the run was on
    // its way to them.
    struct Change {
        double until;
        Scene before;
    };

    // A state that the step thread fetches, to be kept.
    struct Kept {
        RunState state;
        Measurement measurement;
        double seconds = 0;      // that it took
        bool isPresent = false;  // that is looked back from: kept wherever it is
    };

    void begin(Loaded, bool again);
    std::function<void(Simulation&)> keeping();
    void takeKept();
    void sayTooSmall();
    void show(size_t moment);
    void goOnLooking();
    void dropAfter(double time);
    void beginRates();
    int64_t stepsMade() const {
        return shown_ ? history_.back().measurement.steps : measurement_.steps;
    }
    void takeMeasurement();
    void takeBackChangesAfter(double time);
    void meetRequests();
    void followKnobs();
    void updateRates();

    std::unique_ptr<Stepper> stepper_;
    std::unique_ptr<Loader> loader_;
    bool resets_ = false;      // what the loader makes is this scene again
    Start origin_;             // of this run
    Scene asked_, inForce_;    // knobs as the last change left them; as the simulation has them
    double inForceSince_ = 0;  // s simulated
    std::vector<Change> changes_;
    FluidExtent start_;
    int64_t firstSteps_ = 0, savedSteps_ = 0;
    Measurement measurement_;
    Curves curves_;
    History history_;
    std::shared_ptr<Kept> kept_;          // by the batch at hand
    std::optional<size_t> shown_;         // moment, while it looks back
    size_t wanted_ = 0;                   // moment to be shown
    bool returns_ = false, ran_ = false;  // to the present; before it looked back
    Validity validity_{Scene{}};
    bool applyWanted_ = false, underWay_ = false, stirWanted_ = false, holdWanted_ = false,
         stepWanted_ = false, collected_ = false;
    Stir stir_;
    Hold hold_;
    int64_t stepsLeft_ = 0;                // until the run pauses by itself; 0 = never
    double lag_ = 0, lastProceed_ = 0;     // s
    double rateSince_ = 0, rateTime_ = 0;  // wall and simulated s at the last update of the rates
    int64_t rateSteps_ = 0;
    double stepsPerSecond_ = 0, realTimeFactor_ = 0;
    int generation_ = 0;
};

}  // namespace spindrift
