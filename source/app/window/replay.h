#pragma once
// Plays the moments that were kept of a run: which one is shown next.
#include "app/window/history.h"

namespace spindrift {

struct Replay {
    bool playing = false, loops = false;
    bool isEven = false;  // so many moments a second, instead of as fast as the run is to be played
    static constexpr double evenRate = 12;  // 1/s

    void start() { playing = true, due_ = 0; }
    // The moment to be shown after this one when so many seconds of the clock have passed, played
    // at so many simulated seconds for one of them; stops at the last one unless it loops.
    size_t next(const History&, size_t shown, double passed, double speed);

private:
    double due_ = 0;  // s simulated, or moments, that have passed since the one that is shown
};

}  // namespace spindrift
