#pragma once
// What a run measured over time, as a table: CSV or JSON, units in the header.
#include "measure/read_series.h"
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

class TimeSeries {
public:
    // `more` are columns beside those of a Measurement; each row has a value for each of them. The
    // times of the plan's passes follow them. Which columns there are is certain from the first row
    // on.
    explicit TimeSeries(std::vector<Column> more = {}, const std::vector<PlanRow>& plan = {});
    // Begins with the rows that an earlier part of this run has left; it gets that part's own
    // columns too, NaN where one has no value. Throws Error (Output) when units differ. Before the
    // first row.
    void goOn(const Measurement& now, const SeriesTable& earlier);
    // Appends a row. `passes` are the times since the last row; 0 where one didn't run.
    void add(const Measurement&, const std::vector<PassTime>& passes,
             const std::vector<double>& more = {});
    size_t size() const { return rows_.size(); }
    // s, of the last row; -1 when there is none.
    double lastTime() const { return rows_.empty() ? -1 : rows_.back()[0]; }
    // A line of text among the rows: "# text" in CSV, "remarks" in JSON and HDF5. False where one
    // with the same key, what stands before a colon, is there.
    bool remark(double time, const std::string& text);
    // Forgets the rows and remarks after this time, s: the run has gone back to it. Returns how
    // many.
    size_t dropAfter(double time);

    // "time [s],..." then a line a row. Values that are no numbers are written as nan.
    std::string csv() const;
    std::string csvLine(size_t row) const;
    // {"columns": [{"name": "time", "unit": "s"}, ...], "rows": [[...], ...]}; no numbers become
    // null. Where there are any: "remarks": [{"row": 3, "text": "..."}, ...].
    std::string json() const;
    // An HDF5 file: for each column a dataset of float64 with the attribute "unit". Throws Error
    // (Output), and leaves what was there.
    void writeHdf5(const std::string& path) const;

private:
    void chooseColumns(const Measurement&);

    std::vector<Column> more_, passes_, columns_;
    std::vector<std::vector<double>> rows_;
    std::vector<SeriesRemark> remarks_;
};

}  // namespace spindrift
