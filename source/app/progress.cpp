#include "app/progress.h"

#include "core/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace spindrift {

Progress::Progress(bool wanted) : active_(wanted && os::errorsGoToTerminal()) {}

bool Progress::due() const {
    return active_ && Clock::now() - last_ > std::chrono::milliseconds(100);
}

void Progress::show(double share, const std::string& text) {
    if (!due()) return;
    last_ = Clock::now();
    constexpr int Width = 30;
    share = std::clamp(share, 0.0, 1.0);
    const double elapsed = std::chrono::duration<double>(last_ - start_).count();
    const std::string left =
        share > 0 ? fmt::format(", {:.0f} s left", elapsed / share - elapsed) : "";
    const int filled = int(Width * share);
    fmt::print(stderr, "\r[{:#>{}}{:.>{}}] {:3.0f} % {}{}\x1b[K", "", filled, "", Width - filled,
               100 * share, text, left);
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::clear() {
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
}

}  // namespace spindrift
