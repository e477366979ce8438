#pragma once
// Tables of numbers: CSV with a line of names, before it lines that start with #.
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
// The same, from a user's file: each of `needed` must be there and all cells be finite numbers; an error names the line.
Table readStrictTable(const std::string& path, const std::vector<std::string>& needed);

// y at x by straight lines between points of increasing x; the ends' values beyond them.
double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace spindrift
