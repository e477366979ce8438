#pragma once
// Where a run stands. Lives on the device, so that choosing dt needs no round trip to the host.
#include <cstdint>

namespace spindrift {

struct StepState {
    double time = 0;  // s
    double dt = 0;    // s, of the last step
    int64_t steps = 0;
    double speed = 0;          // m/s, the largest before the last step
    double volume = 1;         // of all particles then, share of their volume at rest density
    double stop = 1e300;       // s: a step ends here
    double longest = 0;        // s, what the last step could have been without a stop
    double share = 1;          // of it, that steps take: less where pressures were not found
    double momentum = 0;       // of the iterations for pressures
    double pressureScale = 1;  // by which they still change when those have ended
    // With local steps `dt` is the time to the next substep in which any particle is active, and
    // `longest` the step of calm fluid and of the whole.
    int substep = 0;         // where in it the run stands, in 64ths; outside of step() 0
    int timeBin = 0;         // particles are active whose steps are longest / 2^bin or shorter
    bool allActive = false;  // at this moment, for certain
    bool allRest = false;    // until what rests is decided again
    double awake = 1;        // share of the particles that don't rest
    double evaluations = 0;  // of a particle's forces, since the beginning of the run
};

}  // namespace spindrift
