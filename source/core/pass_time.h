#pragma once
#include <cstdint>

namespace spindrift {

// One row of the plan: a pass's name, and the time that its measured runs took.
struct PassTime {
    const char* name;
    double ms;
    int64_t runs;
};

// Pairs of particles that the passes of a step look at: the first one, and each later one, for
// which the first has sorted out lists.
struct PairsSeen {
    double first = 0, later = 0;
};

}  // namespace spindrift
