#include "measure/read_series.h"

#include "core/error.h"
#include "core/hdf5_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace spindrift {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw Error(
        Failure::Output,
        fmt::format(
            "{}: can't go on with this series: {}; name another file, or move this one away", path,
            why));
}

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
}

// "time [s]"
Column columnOf(const std::string& cell) {
    const size_t unit = cell.find(" [");
    if (unit == std::string::npos || !cell.ends_with("]")) return {cell, ""};
    return {cell.substr(0, unit), cell.substr(unit + 2, cell.size() - unit - 3)};
}

void readCsv(const std::string& text, SeriesTable& table) {
    std::istringstream stream(text.substr(0, text.rfind('\n') + 1));  // whole lines only
    std::string line;
    std::getline(stream, line);
    for (const std::string& cell : cellsOf(line)) table.columns.push_back(columnOf(cell));
    while (std::getline(stream, line)) {
        if (line.starts_with("# ")) {
            table.remarks.push_back({table.rows.size(), line.substr(2)});
            continue;
        }
        std::vector<double>& row = table.rows.emplace_back();
        for (const std::string& cell : cellsOf(line)) {
            char* end = nullptr;
            row.push_back(std::strtod(cell.c_str(), &end));
            if (cell.empty() || *end != 0)
                refuse(table.path,
                       fmt::format("row {} has a value that is no number", table.rows.size()));
        }
    }
}

void readJson(const std::string& text, SeriesTable& table) {
    try {
        const auto json = nlohmann::json::parse(text);
        for (const auto& c : json.at("columns"))
            table.columns.push_back({c.at("name"), c.at("unit")});
        for (const auto& r : json.value("remarks", nlohmann::json::array()))
            table.remarks.push_back({r.at("row"), r.at("text")});
        for (const auto& values : json.at("rows")) {
            std::vector<double>& row = table.rows.emplace_back();
            for (const auto& value : values)
                row.push_back(value.is_null() ? std::nan("") : value.get<double>());
        }
    } catch (const nlohmann::json::exception&) { refuse(table.path, "it is no time series"); }
}

void readHdf5(SeriesTable& table) {
    try {
        const hdf5::Handle file = hdf5::openFile(table.path);
        for (const std::string& name : hdf5::names(file)) {
            const std::vector<double> values = hdf5::readNumbers(file, name);
            table.columns.push_back({name, hdf5::readUnit(file, name)});
            table.rows.resize(std::max(table.rows.size(), values.size()));
            for (size_t r = 0; r < values.size(); ++r) table.rows[r].push_back(values[r]);
        }
        std::istringstream remarks(hdf5::readText(file, Remarks));
        for (std::string line; std::getline(remarks, line);)
            table.remarks.push_back(
                {size_t(std::atoll(line.c_str())), line.substr(line.find(' ') + 1)});
    } catch (const hdf5::Trouble&) { refuse(table.path, "it is no time series"); }
}

}  // namespace

std::optional<size_t> find(const std::vector<Column>& columns, const std::string& name) {
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const Column& c) { return c.name == name; });
    return at == columns.end() ? std::nullopt : std::optional<size_t>(at - columns.begin());
}

SeriesTable readSeries(const std::string& path) {
    SeriesTable table{path, {}, {}};
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) refuse(path, "it can't be read");
    if (hdf5::isFile(path))
        readHdf5(table);
    else if (text.starts_with("{"))
        readJson(text, table);
    else
        readCsv(text, table);
    if (!find(table.columns, "time") || !find(table.columns, "step"))
        refuse(path, "it has no columns time and step");
    for (const std::vector<double>& row : table.rows)
        if (row.size() != table.columns.size()) refuse(path, "its rows are not of one length");
    return table;
}

SeriesTable rowsBefore(const Measurement& now, SeriesTable table) {
    constexpr double Rounding = 1e-8;  // of numbers with nine digits
    const size_t time = *find(table.columns, "time"), step = *find(table.columns, "step");
    const auto isBehind = [&](const std::vector<double>& row) {
        return row[step] > double(now.steps);
    };
    for (const std::vector<double>& row : table.rows)
        if (isBehind(row) ? !(row[time] >= now.time * (1 - Rounding))
                          : !(row[time] <= now.time * (1 + Rounding)))
            refuse(table.path, fmt::format("it is another run's, at step {:.0f} after {:.6g} s, "
                                           "but this one goes on from step {} after {:.6g} s",
                                           row[step], row[time], now.steps, now.time));
    std::erase_if(table.rows, isBehind);
    std::erase_if(table.remarks, [&](const SeriesRemark& r) { return r.row > table.rows.size(); });
    if (!table.rows.empty() && table.rows.back()[step] == double(now.steps))
        table.rows.back()[time] = now.time;  // with all digits
    return table;
}

}  // namespace spindrift
