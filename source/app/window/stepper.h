#pragma once
// A simulation that steps on a thread of its own, so that the window answers however long a step
// takes.
#include "measure/health.h"
#include "sim/simulation.h"

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace spindrift {

double wallTime();  // s

// Some steps, or none, but none is begun after `seconds` of wall time; and what is done before
// them.
struct Batch {
    int64_t steps = 1;
    double seconds = 0.012;
    std::function<void(Simulation&)> before = {};
};

// Handover: while busy() the thread alone touches the simulation, otherwise the owner alone does.
class Stepper {
public:
    Stepper(std::unique_ptr<Simulation>, const Scene&);
    ~Stepper();  // waits for the step at hand

    bool busy() const;
    // Until the batch is done, for at most so many seconds.
    void wait(double seconds) const;

    // Only while not busy:
    void start(Batch);
    Simulation& simulation();
    // The simulation goes to another one; this one is over.
    std::unique_ptr<Simulation> release();
    // Measured after the last batch. Throws what a step threw.
    const Measurement& measurement();
    // What the guard found after that batch, if it made steps, and what it has to say.
    HealthGuard::Finding finding() const { return finding_; }
    HealthGuard& guard();

private:
    void work(std::stop_token);
    void runBatch();

    std::unique_ptr<Simulation> simulation_;
    HealthGuard guard_;
    HealthGuard::Finding finding_ = HealthGuard::Finding::Sound;
    Batch batch_;
    Measurement measurement_;
    std::exception_ptr failure_;

    mutable std::mutex mutex_;
    mutable std::condition_variable_any changed_;
    bool busy_ = false;
    std::jthread thread_;  // last, so that it ends before what it uses
};

}  // namespace spindrift
