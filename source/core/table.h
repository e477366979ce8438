#pragma once
// Tables of numbers: CSV with a line of names, a unit behind them if any ("x [m]"); empty lines and those that start with # are skipped.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace spindrift {

struct Table {
    std::map<std::string, std::vector<double>> columns;   // of equal length; a cell that is no number is NaN
    std::vector<int> lines;                               // of the file, that each row stands in, from 1
    size_t rows() const { return lines.size(); }
    bool has(const std::string& name) const { return columns.contains(name); }
    const std::vector<double>& at(const std::string& name) const { return columns.at(name); }
};

// Throws Error (Scene) when the file is missing or has no rows.
Table readTable(const std::string& path);
// The same, from a user's file: each of `needed` must be there and all cells be finite numbers; an error names the first lines
// that are wrong.
Table readStrictTable(const std::string& path, const std::vector<std::string>& needed);
// How many rows there are, without reading them. Throws Error (Scene) when the file is missing.
int64_t countRows(const std::string& path);

// Throws Error (Scene) with the first of these, "line 7: x is no number", and how many more there are; does nothing when there are none.
void refuseAny(const std::string& path, const std::vector<std::string>& complaints);

// y at x by straight lines between points of increasing x; the ends' values beyond them.
double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace spindrift
