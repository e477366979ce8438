#pragma once
// The time series of a run in its files, which follow it closely, so that a run that is killed has
// them too.
#include "core/output_file.h"
#include "measure/time_series.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

// Rows are in the CSV file at once. JSON and HDF5 files are replaced by whole new ones, at least
// once a second as long as that takes less than a fifth of the time; what is no regular file gets
// them at the end. Throws Error (Output).
class SeriesFiles {
public:
    // A run that goes on from a checkpoint begins with the rows that its files have up to there.
    SeriesFiles(const Output&, std::vector<Column> more, const std::vector<PlanRow>& plan,
                const Measurement* goesOnFrom);
    void add(const Measurement&, const std::vector<PassTime>& passes,
             const std::vector<double>& more);
    // Once for each key; see TimeSeries.
    void remark(double time, const std::string& text);
    // To be called often: replaces what is due.
    void keepUp();
    // The run has gone back to this time, s.
    void dropAfter(double time);
    void finish();
    // s, of the last row; -1 when there is none.
    double lastTime() const { return lastTime_; }

private:
    using Clock = std::chrono::steady_clock;
    void replace(bool streamsToo);

    std::string csv_, json_, hdf5_;  // paths
    TimeSeries series_;
    std::optional<GrowingText> csvFile_;  // from the first row on
    double lastTime_ = -1;
    bool changed_ = false;  // since JSON and HDF5 were written
    Clock::time_point active_{};
};

}  // namespace spindrift
