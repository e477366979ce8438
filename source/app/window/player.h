#pragma once
// Plays a scene in real time where it can: run, pause, step, reset, load. Knows nothing of pixels.
#include "app/scene_choice.h"
#include "app/window/stepper.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace spindrift {

// Curves over the whole run, evenly spaced; when they grow long every second sample goes.
struct History {
    std::vector<float> time, kinetic, potential, total, densityError;  // s, J, J, J, 1
    void add(const Measurement&);
    void dropAfter(double time);   // the run has gone back to it

private:
    double least_ = 0;  // s between samples
};

class Player {
public:
    // Throws Error when the scene can't run.
    explicit Player(Start);
    explicit Player(Scene s) : Player(Start{std::move(s), {}}) {}

    Scene scene;  // edit live knobs, then call knobsChanged()
    bool running = true;
    std::string halted;  // why the run was stopped by itself; empty = it wasn't
    std::string notice;  // what the health guard says while the run goes on; whoever shows it empties it
    std::vector<Particle> culprits;  // of a run that was stopped by itself

    // Requests; they are met when the simulation is at hand (collect).
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

    // Blocks until the step at hand is done. Throws Error; then nothing has changed.
    void load(const std::string& file);
    void reset();
    // Goes on from where the run stands, on the other device.
    void switchBackend(Backend);

    // True when the simulation is at hand: the requests are met, measurement() is new, simulation()
    // may be used until proceed(). `moved` tells whether steps were made since the last time.
    bool collect(bool& moved);
    // Starts the steps that real time asks for, as many as fit into `budget` seconds of wall time.
    void proceed(double budget);

    // Stops the run and says why.
    void halt(const std::string& why);

    bool busy() const { return stepper_->busy(); }
    void wait(double seconds) const { stepper_->wait(seconds); }
    Simulation& simulation() { return stepper_->simulation(); }
    const Measurement& measurement() const { return measurement_; }
    // Writes where the run stands, or its last good state when it was stopped by itself. Throws Error (Output).
    void saveCheckpoint(const std::string& file);
    const History& history() const { return history_; }
    const Camera& initialCamera() const { return initialCamera_; }
    double stepsPerSecond() const { return stepsPerSecond_; }
    double realTimeFactor() const { return realTimeFactor_; }  // simulated / wall time
    int generation() const { return generation_; }             // grows with every new run

private:
    void begin(Scene, std::unique_ptr<Simulation>);
    void takeMeasurement();
    void meetRequests();
    void updateRates();

    std::unique_ptr<Stepper> stepper_;
    Camera initialCamera_;
    Measurement measurement_;
    History history_;
    bool applyWanted_ = false, stirWanted_ = false, holdWanted_ = false, stepWanted_ = false, collected_ = false;
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
