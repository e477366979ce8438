#include "scene/particle_file.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "core/table.h"
#include "core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

namespace spindrift {
namespace {

constexpr const char* Names[] = {"x", "y", "z", "vx", "vy", "vz", "rho", "p", "mass", "fluid"};
constexpr const char* Units[] = {"m", "m", "m", "m/s", "m/s", "m/s", "kg/m³", "Pa", "kg", ""};
constexpr size_t Columns = std::size(Names), Rho = 6, P = 7, M = 8, F = 9;
using Values =
    std::array<std::vector<double>, Columns>;  // of each column, empty where there is none

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(Failure::Scene, fmt::format("{}: {}", path, what));
}

// Which columns there are must make sense together. A density of 0 says nothing: lone particles of
// the classic formulation, which don't count themselves, have it.
ParticleTable tableOf(const std::string& path, Values v, std::vector<int> lines) {
    for (size_t k = 0; k < 3; ++k)
        if (v[k].empty())
            refuse(path, fmt::format("has no particles, or no column {}; it needs x, y, z, and may "
                                     "have vx, vy, vz, rho, p, mass, fluid",
                                     Names[k]));
    for (size_t k = 1; k < Columns; ++k)
        if (!v[k].empty() && v[k].size() != v[0].size())
            refuse(path,
                   fmt::format("{} values of {}, but {} of x", v[k].size(), Names[k], v[0].size()));
    if (v[3].empty() != v[4].empty() || v[4].empty() != v[5].empty())
        refuse(path, "has some of the columns vx, vy, vz; give all three or none");
    if (!v[M].empty() && !v[F].empty())
        refuse(path,
               "has both mass and fluid; leave mass out: each particle has spacing^3 of its "
               "fluid then");
    ParticleTable table;
    table.lines = std::move(lines);
    std::vector<std::string> complaints;
    for (size_t i = 0; i < v[0].size(); ++i) {
        table.positions.push_back({v[0][i], v[1][i], v[2][i]});
        table.velocities.push_back(v[3].empty() ? Vec3d{} : Vec3d{v[3][i], v[4][i], v[5][i]});
        for (size_t k = 0; k < Columns; ++k)
            if (!v[k].empty() && !std::isfinite(v[k][i]))
                complaints.push_back(fmt::format("{}: {} is no number", table.nameOf(i), Names[k]));
        if (!v[Rho].empty() && v[Rho][i] < 0)
            complaints.push_back(
                fmt::format("{}: rho = {:g} kg/m³ is below 0", table.nameOf(i), v[Rho][i]));
        if (!v[M].empty() && v[M][i] <= 0)
            complaints.push_back(
                fmt::format("{}: mass = {:g} kg is not above 0", table.nameOf(i), v[M][i]));
        if (!v[F].empty() && !(v[F][i] >= 0 && v[F][i] == std::floor(v[F][i])))
            complaints.push_back(
                fmt::format("{}: fluid = {:g} is no number of an entry of "
                            "fluid.bodies, from 0 on",
                            table.nameOf(i), v[F][i]));
    }
    refuseAny(path, complaints);
    table.densities = std::move(v[Rho]), table.pressures = std::move(v[P]);
    table.masses = std::move(v[M]), table.fluids = std::move(v[F]);
    return table;
}

ParticleTable readCsv(const std::string& path) {
    std::vector<TableColumn> known;
    for (size_t k = 0; k < Columns; ++k) known.push_back({Names[k], Units[k], k < 3});
    Table file = readStrictTable(path, known);
    Values values;
    for (size_t k = 0; k < Columns; ++k)
        if (file.has(Names[k])) values[k] = std::move(file.columns[Names[k]]);
    return tableOf(path, std::move(values), std::move(file.lines));
}

ParticleTable readHdf5(const std::string& path, hid_t file) {
    Values values;
    for (size_t k = 0; k < Columns; ++k) {
        if (H5Lexists(file, Names[k], H5P_DEFAULT) <= 0) continue;
        values[k] = hdf5::readNumbers(file, Names[k]);
        const std::string unit = hdf5::readUnit(file, Names[k]);
        const std::optional<double> factor = unit.empty() ? 1 : unitFactor(unit, Units[k]);
        if (!factor)
            refuse(path, fmt::format("dataset {}: \"{}\" is no unit of it that is known; use {}",
                                     Names[k], unit.substr(0, 40), commonUnits(Units[k])));
        for (double& value : values[k]) value *= *factor;
    }
    return tableOf(path, std::move(values), {});
}

// Calls f with the opened file, and says in one line what is wrong with it.
template <class F> auto withHdf5(const std::string& path, const F& f) {
    try {
        const hdf5::Handle file = hdf5::openFile(path);
        return f(file);
    } catch (const hdf5::Trouble& trouble) {
        refuse(path,
               fmt::format("the HDF5 file is damaged, or {} is no list of numbers", trouble.what));
    }
}

}  // namespace

std::string ParticleTable::nameOf(size_t particle) const {
    return lines.empty() ? fmt::format("particle {}", particle)
                         : fmt::format("line {}", lines[particle]);
}

ParticleTable readParticles(const std::string& path) {
    return hdf5::isFile(path) ? withHdf5(path, [&](hid_t file) { return readHdf5(path, file); })
                              : readCsv(path);
}

int64_t countParticlesIn(const std::string& path) {
    if (path.empty()) refuse("\"\"", "no file is named; give its path");
    if (!hdf5::isFile(path)) return countRows(path);
    return withHdf5(path,
                    [](hid_t file) { return int64_t(hdf5::Array(file, Names[0], 1).size[0]); });
}

// Most files have none: their header says so without reading the rest.
static bool mayHaveMasses(const std::string& path) {
    if (hdf5::isFile(path))
        return withHdf5(path,
                        [](hid_t file) { return H5Lexists(file, Names[M], H5P_DEFAULT) > 0; });
    countRows(path);  // or says why it can't be read
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        const size_t at = line.find_first_not_of(" \t\r");
        if (at == std::string::npos || line[at] == '#') continue;
        std::transform(line.begin(), line.end(), line.begin(),
                       [](unsigned char c) { return char(std::tolower(c)); });
        return line.find(Names[M]) != std::string::npos;
    }
    return false;
}

double massInFile(const std::string& path) {
    if (path.empty()) refuse("\"\"", "no file is named; give its path");
    struct Known {
        std::filesystem::file_time_type time;
        uintmax_t size;
        double mass;
    };
    static std::mutex mutex;
    static std::map<std::string, Known> known;
    const std::lock_guard lock(mutex);
    std::error_code none;
    const auto time = std::filesystem::last_write_time(path, none);
    const uintmax_t size = std::filesystem::file_size(path, none);
    const auto k = known.find(path);
    if (k != known.end() && (none || (k->second.time == time && k->second.size == size)))
        return k->second.mass;
    std::vector<double> masses;
    if (mayHaveMasses(path)) masses = readParticles(path).masses;
    const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
    const double mean = masses.empty() ? 0 : sum / double(masses.size());
    known[path] = {time, size, mean};
    return mean;
}

namespace {

std::vector<double> columnOf(const ParticleTable& table, size_t k) {
    if (k == Rho) return table.densities;
    if (k == P) return table.pressures;
    if (k == M) return table.masses;
    if (k == F) return table.fluids;
    std::vector<double> values;
    for (const Vec3d& v : k < 3 ? table.positions : table.velocities)
        values.push_back(v[int(k % 3)]);
    return values;
}

bool writeCsv(const std::string& path, const std::vector<std::vector<double>>& values) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) return false;
    std::string text;
    for (size_t k = 0; k < Columns; ++k)
        if (!values[k].empty())
            text += fmt::format("{}{}{}", k ? "," : "", Names[k],
                                *Units[k] ? fmt::format(" [{}]", Units[k]) : "");
    text += '\n';
    bool written = true;
    for (size_t i = 0; i < values[0].size() && written; ++i) {
        for (size_t k = 0; k < Columns; ++k)
            if (!values[k].empty())
                fmt::format_to(std::back_inserter(text), "{}{}", k ? "," : "", values[k][i]);
        text += '\n';
        if (text.size() < (1 << 16) && i + 1 < values[0].size()) continue;
        written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
        text.clear();
    }
    return std::fclose(file) == 0 && written;
}

}  // namespace

bool writeParticles(const std::string& path, bool hdf5, const ParticleTable& table) {
    std::vector<std::vector<double>> values;
    for (size_t k = 0; k < Columns; ++k) values.push_back(columnOf(table, k));
    if (!hdf5) return writeCsv(path, values);
    return hdf5::writeFile(path, [&](hid_t file) {
        for (size_t k = 0; k < Columns; ++k)
            if (!values[k].empty()) hdf5::writeNumbers(file, Names[k], Units[k], values[k]);
    });
}

}  // namespace spindrift
