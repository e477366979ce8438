#include "core/table.h"

#include "core/error.h"
#include "core/units.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

namespace spindrift {

namespace {

std::string trimmed(const std::string& text, const char* what = " \t\r") {
    const size_t begin = text.find_first_not_of(what), end = text.find_last_not_of(what);
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::string inSmall(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// What stands between separators that are neither quoted nor in brackets, without blanks around and
// quotes. ' ' means any run of blanks; an empty cell behind the last separator is none.
std::vector<std::string> cellsOf(const std::string& line, char separator) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    int depth = 0;
    const std::string text = trimmed(line, separator == '\t' ? " \r" : " \t\r");
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') quoted = !quoted;
        if (c == '[' || c == '(') ++depth;
        if (c == ']' || c == ')') --depth;
        const bool ends = !quoted && depth <= 0 &&
                          (separator == ' ' ? isBlank(c) && !isBlank(text[i - 1]) : c == separator);
        // A unit stands behind its name, also where blanks separate.
        const size_t next = text.find_first_not_of(" \t\r", i);
        const bool unit = separator == ' ' && ends && next != std::string::npos &&
                          (text[next] == '[' || text[next] == '(');
        if (ends && !unit)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    for (std::string& cell : cells) cell = trimmed(trimmed(trimmed(cell), "\"'"));
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

// The one that the line of names has.
char separatorOf(const std::string& names) {
    for (const char separator : {';', ',', '\t'})
        if (cellsOf(names, separator).size() > 1) return separator;
    return ' ';
}

// A cell's value; a decimal comma may stand where commas don't separate. A table has one kind of
// mark, `decimal` once it is known.
double numberOf(std::string cell, char& decimal) {
    const size_t mark = cell.find_first_of(".,");
    if (mark != std::string::npos) {
        if (decimal != 0 && decimal != cell[mark]) return std::nan("");
        decimal = cell[mark];
        cell[mark] = '.';
    }
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    return !cell.empty() && *end == 0 ? value : std::nan("");
}

std::ifstream openTable(const std::string& path) {
    std::error_code none;
    if (!std::filesystem::exists(path, none))
        throw Error(Failure::Scene, path + ": no such file; check the path");
    std::ifstream stream(path);
    if (!stream || std::filesystem::is_directory(path, none))
        throw Error(Failure::Scene,
                    path + ": can't be read; it is a folder, or its permissions forbid it");
    const std::string wide[] = {"\xff\xfe", "\xfe\xff"}, mark = "\xef\xbb\xbf";
    std::string start(mark.size(), 0);
    stream.read(start.data(), long(start.size()));
    for (const std::string& w : wide)
        if (start.starts_with(w))
            throw Error(Failure::Scene, path + ": is text in UTF-16; save it as UTF-8");
    stream.clear();
    if (start != mark) stream.seekg(0);
    return stream;
}

// The next line that holds cells; false at the end.
bool nextLine(std::istream& stream, std::string& line, int& number) {
    while (std::getline(stream, line)) {
        ++number;
        const size_t begin = line.find_first_not_of(" \t\r;,");
        if (begin != std::string::npos && line[begin] != '#') return true;
    }
    return false;
}

struct Header {
    char separator;
    std::vector<std::string> names, units;  // a column's unit may be empty
};

// "rho [g/cm^3]", "rho (g/cm^3)", "rho / (g/cm^3)"
Header readHeader(const std::string& path, std::istream& stream, int& line) {
    std::string text;
    if (!nextLine(stream, text, line))
        throw Error(Failure::Scene, path + ": is empty; its first line names the columns");
    Header header{separatorOf(text), {}, {}};
    for (const std::string& cell : cellsOf(text, header.separator)) {
        const size_t end = std::min(cell.find_first_of("[(/"), cell.size());
        std::string unit = trimmed(cell.substr(end), " \t/");
        if (unit.size() > 1 && (unit.front() == '[' || unit.front() == '('))
            unit = unit.substr(1, unit.size() - 1 - (unit.back() == ']' || unit.back() == ')'));
        header.names.push_back(trimmed(trimmed(cell.substr(0, end)), "\"'")),
            header.units.push_back(trimmed(unit));
    }
    return header;
}

// Rows below their header. Mistakes of rows go to `complaints`, when there are such.
Table readRows(const std::string& path, std::istream& stream, int number, const Header& header,
               std::vector<std::string>* complaints) {
    Table table;
    std::string line;
    const std::vector<std::string>& names = header.names;
    std::vector<std::vector<double>*> columns;
    for (const std::string& name : names) columns.push_back(&table.columns[name]);
    char decimal = 0;
    while (nextLine(stream, line, number)) {
        const std::vector<std::string> cells = cellsOf(line, header.separator);
        auto complain = [&](const std::string& what) {
            if (complaints) complaints->push_back("line " + std::to_string(number) + ": " + what);
        };
        if (cells.size() != names.size())
            complain(std::to_string(cells.size()) + " values for " + std::to_string(names.size()) +
                     " columns");
        for (size_t k = 0; k < names.size(); ++k) {
            const double value = k < cells.size() ? numberOf(cells[k], decimal) : std::nan("");
            if (k < cells.size() && !std::isfinite(value)) complain(names[k] + " is no number");
            columns[k]->push_back(value);
        }
        table.lines.push_back(number);
    }
    if (table.rows() == 0)
        throw Error(Failure::Scene,
                    path + ": has no rows of numbers; the first line names the columns");
    return table;
}

// The factor from a column's unit to the one that is wanted.
double factorOf(const std::string& path, const std::string& unit, const TableColumn& column) {
    if (unit.empty()) return 1;
    const std::optional<double> factor = unitFactor(unit, column.unit);
    if (!factor)
        throw Error(Failure::Scene, path + ": column " + column.name + ": \"" + unit.substr(0, 40) +
                                        "\" is no unit of it that is known; use " +
                                        commonUnits(column.unit));
    return *factor;
}

}  // namespace

Table readTable(const std::string& path) {
    std::ifstream stream = openTable(path);
    int line = 0;
    const Header header = readHeader(path, stream, line);
    return readRows(path, stream, line, header, nullptr);
}

std::vector<std::string> columnsOf(const std::string& path) {
    std::ifstream stream = openTable(path);
    int line = 0;
    Header header = readHeader(path, stream, line);
    for (std::string& name : header.names) name = inSmall(name);
    return header.names;
}

Table readStrictTable(const std::string& path, const std::vector<TableColumn>& known) {
    std::ifstream stream = openTable(path);
    int line = 0;
    Header header = readHeader(path, stream, line);
    for (std::string& name : header.names) name = inSmall(name);
    if (std::set<std::string>(header.names.begin(), header.names.end()).size() <
        header.names.size())
        throw Error(Failure::Scene, path + ": names a column twice; remove one");
    for (const TableColumn& column : known)
        if (column.needed &&
            std::find(header.names.begin(), header.names.end(), column.name) == header.names.end())
            throw Error(Failure::Scene, path + ": has no column " + column.name +
                                            "; its first line names the columns");
    std::vector<double> factors;
    for (size_t k = 0; k < header.names.size(); ++k) {
        const auto column = std::find_if(known.begin(), known.end(), [&](const TableColumn& c) {
            return c.name == header.names[k];
        });
        if (column == known.end()) {
            std::string names;
            for (const TableColumn& c : known) names += (names.empty() ? "" : ", ") + c.name;
            throw Error(Failure::Scene, path + ": unknown column \"" +
                                            header.names[k].substr(0, 40) + "\"; known: " + names);
        }
        factors.push_back(factorOf(path, header.units[k], *column));
    }
    std::vector<std::string> complaints;
    Table table = readRows(path, stream, line, header, &complaints);
    refuseAny(path, complaints);
    for (size_t k = 0; k < factors.size(); ++k)
        for (double& value : table.columns[header.names[k]]) value *= factors[k];
    return table;
}

void refuseAny(const std::string& path, const std::vector<std::string>& complaints) {
    constexpr size_t Most = 3;
    std::string text;
    for (size_t i = 0; i < std::min(Most, complaints.size()); ++i)
        text += (i ? "; " : "") + complaints[i];
    if (complaints.size() > Most)
        text += "; and " + std::to_string(complaints.size() - Most) + " more";
    if (!text.empty())
        throw Error(Failure::Scene, path + ": " + text + "; mend or remove these lines");
}

int64_t countRows(const std::string& path) {
    std::ifstream stream = openTable(path);
    std::string line;
    int number = 0;
    int64_t count = -1;  // without the names
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
