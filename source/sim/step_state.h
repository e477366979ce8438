#pragma once
// Where a run stands. Lives on the device, so that choosing dt needs no round trip to the host.
#include <cstdint>

namespace spindrift {

struct StepState {
    double time = 0;     // s
    double dt = 0;       // s, of the last step
    int64_t steps = 0;
    double speed = 0;    // m/s, the largest before the last step
    double volume = 1;   // of all particles then, share of their volume at rest density
};

}  // namespace spindrift
