#pragma once
// The range of a quantity over a run, for its colours.
#include "sim/simulation.h"

#include <vector>

namespace spindrift {

class RunRange {
public:
    void add(double time, Range);
    bool empty() const { return lows_.empty(); }
    double since() const { return since_; }  // s, the first time
    // Of all pictures but the one in fifty that goes lowest, and highest: one splash must not dim
    // all that follows.
    Range range() const;

private:
    std::vector<float> lows_,
        highs_;  // of each picture, or of every second, fourth, ... one, in rising order
    int stride_ = 1, passed_ = 0;
    double since_ = 0, last_ = -1;
};

}  // namespace spindrift
