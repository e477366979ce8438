#pragma once
// Tables of reference numbers: CSV whose first lines, starting with #, say where they are from.
#include <map>
#include <string>
#include <vector>

namespace spindrift {

// Column name -> numbers; text in a column of numbers is NaN. Throws Error (Scene) when the file is missing or has no rows.
std::map<std::string, std::vector<double>> readTable(const std::string& path);

// y at x by straight lines between points of increasing x; the ends' values beyond them.
double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace spindrift
