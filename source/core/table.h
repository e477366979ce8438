#pragma once
// Tables of numbers: CSV with a line of names, a unit behind them if any ("x [m]"); empty lines and
// those that start with # are skipped. The line of names says what separates cells: semicolons,
// commas, tabs or blanks. Numbers have decimal points, or all of them commas. Names may be quoted.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace spindrift {

struct Table {
    std::map<std::string, std::vector<double>>
        columns;             // of equal length; a cell that is no number is NaN
    std::vector<int> lines;  // of the file, that each row stands in, from 1
    size_t rows() const { return lines.size(); }
    bool has(const std::string& name) const { return columns.contains(name); }
    const std::vector<double>& at(const std::string& name) const { return columns.at(name); }
};

// Throws Error (Scene) when the file is missing or has no rows.
Table readTable(const std::string& path);

// A column that a user's table may have or must, and the unit that its values come back in,
// whatever its header says.
struct TableColumn {
    std::string name, unit;
    bool needed = false;
};
// The same, from a user's file: each needed column must be there, no other than the known ones, in
// letters of either case, and all cells be finite numbers; an error names the first lines that are
// wrong.
Table readStrictTable(const std::string& path, const std::vector<TableColumn>& known);
// The names that the header has, in small letters.
std::vector<std::string> columnsOf(const std::string& path);
// How many rows there are, without reading them. Throws Error (Scene) when the file is missing.
int64_t countRows(const std::string& path);

// Throws Error (Scene) with the first of these, "line 7: x is no number", and how many more there
// are; does nothing when there are none.
void refuseAny(const std::string& path, const std::vector<std::string>& complaints);

// y at x by straight lines between points of increasing x; the ends' values beyond them.
double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace spindrift
