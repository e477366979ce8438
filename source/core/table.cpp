#include "core/table.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace spindrift {

static std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
        const size_t begin = cell.find_first_not_of(" \t\r"), end = cell.find_last_not_of(" \t\r");
        cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    return cells;
}

static double numberOf(const std::string& cell) {
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    return !cell.empty() && *end == 0 ? value : std::nan("");
}

Table readTable(const std::string& path) {
    std::ifstream stream(path);
    std::vector<std::string> names;
    Table table;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const std::vector<std::string> cells = cellsOf(line);
        if (cells.empty() || cells[0].starts_with('#') || (cells.size() == 1 && cells[0].empty())) continue;
        if (names.empty()) {
            names = cells;
            continue;
        }
        for (size_t k = 0; k < names.size(); ++k)
            table.columns[names[k]].push_back(k < cells.size() ? numberOf(cells[k]) : std::nan(""));
        table.lines.push_back(number);
    }
    if (table.rows() == 0)
        throw Error(Exit::Scene, path + ": no rows of numbers there; check the path, the first line names the columns");
    return table;
}

Table readStrictTable(const std::string& path, const std::vector<std::string>& needed) {
    Table table = readTable(path);
    for (const std::string& name : needed)
        if (!table.has(name)) throw Error(Exit::Scene, path + ": has no column " + name + "; its first line names the columns");
    for (const auto& [name, values] : table.columns)
        for (size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
                throw Error(Exit::Scene, path + ": line " + std::to_string(table.lines[i]) + ": " + name + " is no number");
    return table;
}

double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
    const size_t right = size_t(std::lower_bound(xs.begin(), xs.end(), x) - xs.begin());
    if (right == 0) return ys.front();
    if (right == xs.size()) return ys.back();
    const double share = (x - xs[right - 1]) / (xs[right] - xs[right - 1]);
    return ys[right - 1] + share * (ys[right] - ys[right - 1]);
}

}  // namespace spindrift
