#include "scene/color_file.h"

#include "core/error.h"
#include "core/table.h"
#include "scene/read_knobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace spindrift {
namespace {

struct Stop {
    double at;
    std::array<double, 3> color;
};
using Stops = std::vector<Stop>;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw Error(Failure::Scene, path + ": " + why);
}

Stops fromTable(const std::string& path) {
    const Table table = readStrictTable(
        path, {{"r", "", true}, {"g", "", true}, {"b", "", true}, {"at", "", false}});
    Stops stops;
    for (size_t i = 0; i < table.rows(); ++i)
        stops.push_back({table.has("at") ? table.at("at")[i] : double(i),
                         {table.at("r")[i], table.at("g")[i], table.at("b")[i]}});
    return stops;
}

Stops fromJson(const std::string& path) {
    std::ifstream file(path);
    if (!file) fail(path, "can't be read; name a table of colours");
    std::ostringstream text;
    text << file.rdbuf();
    const Json root = parseJson(text.str(), path);
    Stops stops;
    try {
        const Json& list = root.is_array() && !root.empty() && root[0].is_object() ? root[0] : root;
        if (list.is_object()) {
            const auto numbers = list.at("RGBPoints").get<std::vector<double>>();
            if (numbers.size() % 4 != 0)
                fail(path, fmt::format("RGBPoints has {} numbers, not four for each colour; mend "
                                       "it",
                                       numbers.size()));
            for (size_t i = 0; i + 3 < numbers.size(); i += 4)
                stops.push_back({numbers[i], {numbers[i + 1], numbers[i + 2], numbers[i + 3]}});
        } else {
            for (const Json& color : list)
                stops.push_back({double(stops.size()), color.get<std::array<double, 3>>()});
        }
    } catch (const Json::exception&) {
        fail(path,
             "is no list of colours; write [[r, g, b], ...] or name a colour map with "
             "RGBPoints, as ParaView exports it");
    }
    return stops;
}

// Two at least, in rising order, colours from 0 to 255.
void mend(Stops& stops, const std::string& path) {
    if (stops.size() < 2) fail(path, "has fewer than two colours; add some");
    double most = 0;
    for (size_t i = 0; i < stops.size(); ++i) {
        for (const double c : stops[i].color) {
            most = std::max(most, c);
            if (!(c >= 0 && c <= 255))
                fail(path, fmt::format("colour {} has {:g}, and numbers go from 0 to 255 or 0 to "
                                       "1; mend it",
                                       i + 1, c));
        }
        if (i > 0 && !(stops[i].at > stops[i - 1].at))
            fail(path, fmt::format("colour {} is at {:g}, not beyond the one before, at {:g}; put "
                                   "them in rising order",
                                   i + 1, stops[i].at, stops[i - 1].at));
    }
    for (Stop& stop : stops)
        for (double& c : stop.color) c *= most > 1 ? 1 : 255;
}

}  // namespace

std::array<std::array<uint8_t, 3>, 256> readColors(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    Stops stops = extension == ".csv" ? fromTable(path) : fromJson(path);
    mend(stops, path);
    std::array<std::array<uint8_t, 3>, 256> table{};
    size_t next = 1;
    for (size_t i = 0; i < table.size(); ++i) {
        const double share = double(i) / double(table.size() - 1);
        const double at = std::lerp(stops.front().at, stops.back().at, share);
        while (next + 1 < stops.size() && stops[next].at < at) ++next;
        const Stop &a = stops[next - 1], &b = stops[next];
        for (size_t k = 0; k < 3; ++k)
            table[i][k] = uint8_t(
                std::lround(std::lerp(a.color[k], b.color[k], (at - a.at) / (b.at - a.at))));
    }
    return table;
}

}  // namespace spindrift
