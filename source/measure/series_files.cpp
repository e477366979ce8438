#include "measure/series_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace spindrift {
namespace {

// Files of one run may be of different length, when one of them was asked for later than others.
std::optional<SeriesTable> longestBefore(const Measurement& now,
                                         const std::vector<std::string>& paths) {
    std::optional<SeriesTable> longest;
    for (const std::string& path : paths) {
        if (path.empty() || isStream(path) || !std::filesystem::exists(path)) continue;
        SeriesTable table = rowsBefore(now, readSeries(path));
        if (!longest || table.rows.size() > longest->rows.size()) longest = std::move(table);
    }
    return longest;
}

}  // namespace

SeriesFiles::SeriesFiles(const Output& output, std::vector<Column> more,
                         const std::vector<PlanRow>& plan, const Measurement* goesOnFrom)
    : csv_(output.csv), json_(output.json), hdf5_(output.hdf5), series_(std::move(more), plan) {
    if (!goesOnFrom) return;
    const std::optional<SeriesTable> before = longestBefore(*goesOnFrom, {hdf5_, csv_, json_});
    if (!before || before->rows.empty()) return;
    constexpr double Rounding = 1e-8;  // up, of the nine digits that a file has
    series_.goOn(*goesOnFrom, *before);
    lastTime_ = series_.lastTime() * (1 + Rounding);
    changed_ = true;  // the other files may be shorter
}

void SeriesFiles::add(const Measurement& m, const std::vector<PassTime>& passes,
                      const std::vector<double>& more) {
    series_.add(m, passes, more);
    lastTime_ = m.time;
    changed_ = true;
    if (csvFile_)
        csvFile_->append(series_.csvLine(series_.size() - 1));
    else if (!csv_.empty())
        csvFile_.emplace(csv_, series_.csv());
}

void SeriesFiles::remark(double time, const std::string& text) {
    if (!series_.remark(time, text)) return;
    changed_ = true;
    if (csvFile_) csvFile_->append("# " + text + "\n");
}

void SeriesFiles::keepUp() {
    if (changed_ && Clock::now() >= active_) replace(false);
}

void SeriesFiles::dropAfter(double time) {
    if (series_.dropAfter(time) == 0) return;
    lastTime_ = series_.lastTime();
    changed_ = true;
    if (csvFile_ && !csvFile_->shrink(series_.csv().size()))
        csvFile_->append(fmt::format("# back to {:.9g} s: the rows after it do not count\n", time));
}

void SeriesFiles::finish() {
    if (!csvFile_ && !csv_.empty() && series_.size() > 0)
        csvFile_.emplace(csv_, series_.csv());  // no row was left to be added
    replace(true);
    json_.clear(), hdf5_.clear();  // a stream gets them once
}

void SeriesFiles::replace(bool streamsToo) {
    const auto isActive = [&](const std::string& path) {
        return !path.empty() && (isStream(path) ? streamsToo : changed_);
    };
    const Clock::time_point start = Clock::now();
    if (isActive(json_)) writeText(json_, series_.json());
    if (isActive(hdf5_)) series_.writeHdf5(hdf5_);
    changed_ = false;
    const Clock::duration took = Clock::now() - start;
    active_ = Clock::now() +
              std::max(std::min<Clock::duration>(20 * took, std::chrono::seconds(1)), 4 * took);
}

}  // namespace spindrift
