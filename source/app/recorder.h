#pragma once
// Something that a run writes again and again: a row of its series, a frame, a checkpoint.
#include <algorithm>
#include <cmath>
#include <functional>

namespace spindrift {

// Two times that should be the same, but are sums of different steps, are; `tolerance` in s.
inline bool isReached(double time, double now, double tolerance = 0) {
    return now >= time * (1 - 1e-9) - tolerance;
}

// Among the multiples of `every` the first one that is still ahead.
inline double multipleAfter(double time, double every) {
    return (std::floor(time / every * (1 + 1e-9)) + 1) * every;
}

// Writes at the multiples of an interval of simulated time, s. What is due within so short a time
// that no step is worth it counts as due now.
struct Recorder {
    double every, next;
    std::function<void()> write;
    std::function<void(double time)> rewind;  // forgets what was written after this time

    static double tolerance(double every, double shortestStep) {
        return std::min(shortestStep, every / 2);
    }
    // The first time to write at after something was written at `now`.
    static double timeAfter(double now, double every, double shortestStep) {
        return multipleAfter(now + tolerance(every, shortestStep), every);
    }
    void writeIfDue(double now, double shortestStep) {
        if (!isReached(next, now, tolerance(every, shortestStep))) return;
        write();
        next = timeAfter(now, every, shortestStep);
    }
    void goBack(double now, double shortestStep) {
        rewind(now);
        next = std::min(next, timeAfter(now, every, shortestStep));
    }
};

}  // namespace spindrift
