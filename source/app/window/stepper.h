#pragma once
// A simulation that steps on a thread of its own, so that the window answers however long a step
// takes.
#include "sim/simulation.h"

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace spindrift {

// Some steps, but none is begun after `seconds` of wall time.
struct Batch {
    int64_t steps = 1;
    double seconds = 0.012;
};

// Handover: while busy() the thread alone touches the simulation, otherwise the owner alone does.
class Stepper {
public:
    explicit Stepper(std::unique_ptr<Simulation>);
    ~Stepper();  // waits for the step at hand

    bool busy() const;
    // Until the batch is done, for at most so many seconds.
    void wait(double seconds) const;

    // Only while not busy:
    void start(Batch);
    Simulation& simulation();
    // Measured after the last batch. Throws what a step threw.
    const Measurement& measurement();

private:
    void work(std::stop_token);
    void runBatch();

    std::unique_ptr<Simulation> simulation_;
    Batch batch_;
    Measurement measurement_;
    std::exception_ptr failure_;

    mutable std::mutex mutex_;
    mutable std::condition_variable_any changed_;
    bool busy_ = false;
    std::jthread thread_;  // last, so that it ends before what it uses
};

}  // namespace spindrift
