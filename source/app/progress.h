#pragma once
#include <chrono>
#include <string>

namespace spindrift {

// A bar on standard error, drawn only on a terminal and at most ten times a second; gone when it's
// destroyed.
class Progress {
public:
    explicit Progress(bool wanted);
    ~Progress() { clear(); }
    // `share` of the run that is done, 0..1; `text` stands behind the bar.
    void show(double share, const std::string& text);
    bool due() const;
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    bool active_, drawn_ = false;
    Clock::time_point start_ = Clock::now(), last_{};
};

}  // namespace spindrift
