#include "app/window/replay.h"

#include <algorithm>

namespace spindrift {

size_t Replay::next(const History& history, size_t shown, double passed, double speed) {
    if (!playing || history.size() < 2) return shown;
    const size_t last = history.size() - 1;
    // How long a moment stays; the last one as long as the one before it.
    const auto length = [&](size_t i) {
        const size_t k = std::min(i, last - 1);
        return isEven ? 1 : history[k + 1].time() - history[k].time();
    };
    // At an even pace none is left out, however slow the pictures are.
    due_ = isEven ? std::min(due_ + evenRate * passed, 1.0) : due_ + speed * passed;
    while (due_ >= length(shown) && playing) {
        due_ -= length(shown);
        if (shown < last)
            ++shown;
        else if (loops)
            shown = 0, due_ = 0;
        else
            playing = false;
    }
    return shown;
}

}  // namespace spindrift
