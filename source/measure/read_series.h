#pragma once
// The time series that an earlier run has left, for one that goes on.
#include "sim/simulation.h"

#include <optional>
#include <string>
#include <vector>

namespace spindrift {

struct Column {
    std::string name, unit;
};
// The place of a name.
std::optional<size_t> find(const std::vector<Column>&, const std::string& name);

// A line of text that stands in a series, after so many of its rows.
struct SeriesRemark {
    size_t row;
    std::string text;
    double time = -1;  // s simulated, where that is known
};

// The attribute of an HDF5 file that has them, each in a line with its row before it.
constexpr const char* Remarks = "remarks";

struct SeriesTable {
    std::string path;
    std::vector<Column> columns;
    std::vector<std::vector<double>> rows;  // each with a value for each column
    std::vector<SeriesRemark> remarks{};
};

// Reads what TimeSeries has written: CSV, but for a last line that a killed run has left
// unfinished, JSON or HDF5. Throws Error (Output), because that is what the file is to become, when
// it holds something else.
SeriesTable readSeries(const std::string& path);

// The rows up to where a run goes on; those behind it will be written anew. Throws Error (Output)
// when they are another run's: their steps have other times.
SeriesTable rowsBefore(const Measurement& now, SeriesTable);

}  // namespace spindrift
