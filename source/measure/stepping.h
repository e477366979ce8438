#pragma once
// What the runs of validation cases share.
#include "measure/health.h"
#include "measure/validation.h"
#include "sim/simulation.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

namespace spindrift {

// Steps a simulation and keeps the time it takes, measurements left out.
class Stepping {
public:
    Stepping(const Scene& scene, ValidationRun& run)
        : scene_(scene), simulation_(makeSimulation(scene)), run_(run) {
        run.cost.particles = simulation_->fluidCount(), run.cost.walls = simulation_->wallCount();
    }
    Simulation& operator*() { return *simulation_; }
    Simulation* operator->() { return simulation_.get(); }
    double time() { return simulation_->measure().time; }
    void steps(int count) {
        const auto start = std::chrono::steady_clock::now();
        simulation_->step(count);
        simulation_->wait();
        run_.cost.seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const Measurement m = simulation_->measure();
        run_.diverged = run_.diverged || !divergence(scene_, m).empty();
        run_.cost.steps = m.steps;
        run_.cost.megabytes = double(simulation_->bytes()) / 1e6;
    }
    // Until `time` (s) is reached, at most a step beyond; stops early when the run has diverged.
    void until(double time) {
        Measurement m = simulation_->measure();
        while (m.time < time && !run_.diverged) {
            const int most = m.dt > 0 ? std::clamp(int((time - m.time) / m.dt / 1.5), 1, 200) : 1;
            steps(most);
            m = simulation_->measure();
        }
    }

private:
    const Scene& scene_;
    std::unique_ptr<Simulation> simulation_;
    ValidationRun& run_;
};

// `target`, where the resolution is high enough to be judged by it.
inline std::optional<double> targetAt(int resolution, int from, double target) {
    return resolution >= from ? std::optional(target) : std::nullopt;
}

// Mean of samples within `window` about each time.
inline std::vector<double> runningMean(const std::vector<double>& t, const std::vector<double>& p,
                                       double window) {
    std::vector<double> out;
    for (double at : t) {
        double sum = 0;
        int count = 0;
        for (size_t k = size_t(std::lower_bound(t.begin(), t.end(), at - window / 2) - t.begin());
             k < t.size() && t[k] <= at + window / 2; ++k)
            sum += p[k], ++count;
        out.push_back(sum / count);
    }
    return out;
}

}  // namespace spindrift
