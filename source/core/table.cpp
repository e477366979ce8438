#include "core/table.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace spindrift {

namespace {

std::string trimmed(const std::string& text) {
    const size_t begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    for (size_t begin = 0;;) {
        const size_t comma = line.find(',', begin);
        cells.push_back(trimmed(line.substr(begin, comma - begin)));
        if (comma == std::string::npos) return cells;
        begin = comma + 1;
    }
}

double numberOf(const std::string& cell) {
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    return !cell.empty() && *end == 0 ? value : std::nan("");
}

std::ifstream openTable(const std::string& path) {
    std::error_code none;
    if (!std::filesystem::exists(path, none)) throw Error(Exit::Scene, path + ": no such file; check the path");
    std::ifstream stream(path);
    if (!stream || std::filesystem::is_directory(path, none))
        throw Error(Exit::Scene, path + ": can't be read; it is a folder, or its permissions forbid it");
    return stream;
}

// The next line that holds cells; false at the end.
bool nextLine(std::istream& stream, std::string& line, int& number) {
    while (std::getline(stream, line)) {
        ++number;
        const size_t begin = line.find_first_not_of(" \t\r");
        if (begin != std::string::npos && line[begin] != '#') return true;
    }
    return false;
}

std::vector<std::string> namesOf(const std::string& line) {
    std::vector<std::string> names = cellsOf(line);
    for (std::string& name : names) name = trimmed(name.substr(0, name.find('[')));
    return names;
}

// Mistakes of rows go to `complaints`, when there are such.
Table read(const std::string& path, std::vector<std::string>* complaints) {
    std::ifstream stream = openTable(path);
    Table table;
    std::string line;
    int number = 0;
    if (!nextLine(stream, line, number)) throw Error(Exit::Scene, path + ": is empty; its first line names the columns");
    const std::vector<std::string> names = namesOf(line);
    std::vector<std::vector<double>*> columns;
    for (const std::string& name : names) columns.push_back(&table.columns[name]);
    if (complaints && table.columns.size() < names.size()) throw Error(Exit::Scene, path + ": names a column twice; remove one");
    while (nextLine(stream, line, number)) {
        const std::vector<std::string> cells = cellsOf(line);
        auto complain = [&](const std::string& what) {
            if (complaints) complaints->push_back("line " + std::to_string(number) + ": " + what);
        };
        if (cells.size() != names.size())
            complain(std::to_string(cells.size()) + " values for " + std::to_string(names.size()) + " columns");
        for (size_t k = 0; k < names.size(); ++k) {
            const double value = k < cells.size() ? numberOf(cells[k]) : std::nan("");
            if (k < cells.size() && !std::isfinite(value)) complain(names[k] + " is no number");
            columns[k]->push_back(value);
        }
        table.lines.push_back(number);
    }
    if (table.rows() == 0) throw Error(Exit::Scene, path + ": has no rows of numbers; the first line names the columns");
    return table;
}

}  // namespace

Table readTable(const std::string& path) { return read(path, nullptr); }

Table readStrictTable(const std::string& path, const std::vector<std::string>& needed) {
    std::vector<std::string> complaints;
    Table table = read(path, &complaints);
    for (const std::string& name : needed)
        if (!table.has(name)) throw Error(Exit::Scene, path + ": has no column " + name + "; its first line names the columns");
    refuseAny(path, complaints);
    return table;
}

void refuseAny(const std::string& path, const std::vector<std::string>& complaints) {
    constexpr size_t Most = 3;
    std::string text;
    for (size_t i = 0; i < std::min(Most, complaints.size()); ++i) text += (i ? "; " : "") + complaints[i];
    if (complaints.size() > Most) text += "; and " + std::to_string(complaints.size() - Most) + " more";
    if (!text.empty()) throw Error(Exit::Scene, path + ": " + text + "; mend or remove these lines");
}

int64_t countRows(const std::string& path) {
    std::ifstream stream = openTable(path);
    std::string line;
    int number = 0;
    int64_t count = -1;   // without the names
    while (nextLine(stream, line, number)) ++count;
    return std::max<int64_t>(count, 0);
}

double valueAt(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
    const size_t right = size_t(std::lower_bound(xs.begin(), xs.end(), x) - xs.begin());
    if (right == 0) return ys.front();
    if (right == xs.size()) return ys.back();
    const double share = (x - xs[right - 1]) / (xs[right] - xs[right - 1]);
    return ys[right - 1] + share * (ys[right] - ys[right - 1]);
}

}  // namespace spindrift
