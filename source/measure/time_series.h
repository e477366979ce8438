#pragma once
// What a run measured over time, as a table: CSV or JSON, units in the header.
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

struct Column { std::string name, unit; };

class TimeSeries {
public:
    // `more` are columns beside those of a Measurement; each row has a value for each of them.
    explicit TimeSeries(std::vector<Column> more = {});
    // Appends a row. `passes` are the times since the last row; a pass seen later than others gets
    // a column of its own then, 0 where it didn't run.
    void add(const Measurement&, const std::vector<PassTime>& passes, const std::vector<double>& more = {});
    size_t size() const { return rows_.size(); }
    // Forgets the rows after this time, s: the run has gone back to it. Returns how many.
    size_t dropAfter(double time);

    // "time [s],..." then a line a row. Values that are no numbers are written as nan.
    std::string csv() const;
    // {"columns": [{"name": "time", "unit": "s"}, ...], "rows": [[...], ...]}; no numbers become
    // null.
    std::string json() const;
    // An HDF5 file: for each column a dataset of float64 with the attribute "unit". Throws Error (Output), and leaves what was there.
    void writeHdf5(const std::string& path) const;

private:
    double valueAt(size_t row, size_t column) const;

    std::vector<Column> more_, columns_;
    std::vector<std::vector<double>> rows_;  // each as long as the columns were when it was added
};

}  // namespace spindrift
