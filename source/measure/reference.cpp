#include "measure/reference.h"

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
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
}

std::map<std::string, std::vector<double>> readTable(const std::string& path) {
    std::ifstream stream(path);
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> table;
    for (std::string line; std::getline(stream, line);) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string> cells = cellsOf(line);
        if (names.empty()) {
            names = cells;
            continue;
        }
        for (size_t k = 0; k < names.size(); ++k) {
            char* end = nullptr;
            const double value = k < cells.size() ? std::strtod(cells[k].c_str(), &end) : 0;
            table[names[k]].push_back(end && end != cells[k].c_str() ? value : std::nan(""));
        }
    }
    if (table.empty()) throw Error(Exit::Scene, path + ": no reference numbers there; the installation is incomplete");
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
