#include "app/run_range.h"

#include <algorithm>

namespace spindrift {

namespace {

constexpr size_t most = 1024;

void insert(std::vector<float>& sorted, float value) {
    sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), value), value);
}

void keepEverySecond(std::vector<float>& sorted) {
    for (size_t i = 0; i < sorted.size() / 2; ++i) sorted[i] = sorted[2 * i + i % 2];
    sorted.resize(sorted.size() / 2);
}

}  // namespace

void RunRange::add(double time, Range range) {
    if (empty())
        since_ = time;
    else if (time == last_ || ++passed_ % stride_ != 0)
        return;
    last_ = time;
    insert(lows_, range.min), insert(highs_, range.max);
    if (lows_.size() < most) return;
    keepEverySecond(lows_), keepEverySecond(highs_);
    stride_ *= 2;
}

Range RunRange::range() const {
    const size_t outliers = lows_.size() / 50;
    return {lows_[outliers], highs_[highs_.size() - 1 - outliers]};
}

}  // namespace spindrift
