#pragma once
// How many threads share the work of a step.
#include <algorithm>
#include <array>
#include <cstdint>

namespace spindrift {

// All cores, while they are free. Where others use them each loop waits for the thread that is
// kept from running, and a step can take ten times as long as on one core. So now and then some
// steps are made with half or twice as many threads, or with one, and where that is clearly faster
// it stays so. Results don't depend on it.
class Team {
public:
    // Without `adapts` it is always `most`.
    Team(int most, bool adapts) : most_(most), settled_(most), adapts_(adapts && most > 1) {}

    // For the next step.
    int size() const { return trial_ > 0 ? trial_ : settled_; }

    // What a step has taken, ms.
    void note(double ms) {
        if (!adapts_) return;
        if (trial_ > 0) return noteTrial(ms);
        recent_[size_t(made_++ % Steps)] = ms;
        patience_ -= ms;
        if (made_ >= Steps && patience_ <= 0) beginTrial();
    }

private:
    // Steps that make new neighbour lists take longer: so many have some of both kinds.
    static constexpr int Steps = 16;
    // A trial that has failed is followed by as much time without, the next by twice as much, and
    // so on: in the end trials take a fiftieth of the time.
    static constexpr double Faster = 1.2, LongestRest = 50;

    double settledTime() const {
        double sum = 0;
        for (const double ms : recent_) sum += ms;
        return sum;
    }
    void beginTrial() {
        const int others[] = {settled_ / 2, 1, std::min(most_, 2 * settled_)};
        do trial_ = others[next_++ % 3];
        while (trial_ == settled_ || trial_ == 0);
        trialSteps_ = 0, trialTime_ = 0;
    }
    void noteTrial(double ms) {
        ++trialSteps_, trialTime_ += ms;
        const bool hopeless = trialTime_ * Faster > settledTime();
        if (trialSteps_ < Steps && !hopeless) return;
        patience_ = rest_ * trialTime_;
        rest_ = std::min(2 * rest_, LongestRest);
        if (!hopeless) settled_ = trial_, made_ = 0, patience_ = 0, rest_ = 1;
        trial_ = 0;
    }

    int most_, settled_, trial_ = 0;  // threads; no trial: 0
    bool adapts_;
    unsigned next_ = 0;                   // of the others to try
    std::array<double, Steps> recent_{};  // ms, of steps by the settled number
    int64_t made_ = 0;
    int trialSteps_ = 0;
    double patience_ = 0, trialTime_ = 0;  // ms
    double rest_ = 1;                      // times the trial's own time
};

}  // namespace spindrift
