#include "measure/time_series.h"

#include "core/error.h"
#include "core/hdf5_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include <unistd.h>

namespace spindrift {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TimeSeries example() {
    TimeSeries series({}, {{"sort", ""},
                           {"density", ""},
                           {"density", ""},
                           {"forces: gravity", ""},
                           {"stir", "nobody stirs"}});
    Measurement m;
    m.time = 0.1, m.steps = 3, m.dt = 0.025, m.momentum = {1, 2, 3};
    series.add(m, {});
    m.time = 0.2, m.kineticEnergy = NAN;
    series.add(m, {{"density", 6, 3}, {"sort", 0, 0}});
    return series;
}

TEST(TimeSeries, ForgetsWhatARunHasGoneBackBefore) {
    TimeSeries series = example();
    EXPECT_EQ(series.dropAfter(0.2), 0u);
    EXPECT_EQ(series.dropAfter(0.15), 1u);
    EXPECT_EQ(series.size(), 1u);
    EXPECT_EQ(series.dropAfter(0), 1u);
}

TEST(TimeSeries, GoesOnHoweverUnitsWereSpelt) {
    const auto goOn = [](const char* unit) {
        TimeSeries series({}, {});
        series.goOn(
            {}, {"old.csv", {{"time", "s"}, {"step", ""}, {"mean_density", unit}}, {{0, 0, 998}}});
        return linesOf(series.csv());
    };
    for (const char* same : {"kg/m^3", "kg/m³", "kg m-3"}) {
        const auto lines = goOn(same);
        ASSERT_EQ(lines.size(), 2u) << same;
        EXPECT_NE(lines[0].find("mean_density [kg/m³]"), std::string::npos) << lines[0];
        EXPECT_NE(lines[1].find(",998"), std::string::npos) << lines[1];
    }
    for (const char* other : {"g/cm^3", "Pa", ""}) EXPECT_THROW(goOn(other), Error) << other;
}

// One line for each key, among the rows; reading the file again gives it at the same place.
TEST(TimeSeries, RemarksStandOnceAmongTheRowsInEveryFormat) {
    TimeSeries series;
    Measurement m;
    EXPECT_TRUE(series.remark(0, "a gap: \"narrow\""));
    for (int k = 0; k < 4; ++k) {
        m.time = 0.1 * k, m.steps = k;
        EXPECT_EQ(series.remark(m.time, "Mach number: " + std::to_string(k)), k == 0);
        if (k == 2) series.remark(m.time, "late: now");
        series.add(m, {});
    }
    const std::string path = testing::TempDir() + "spindrift-remarks-" + std::to_string(getpid());
    std::ofstream(path + ".csv") << series.csv();
    std::ofstream(path + ".json") << series.json();
    series.writeHdf5(path + ".h5");
    for (const char* kind : {".csv", ".json", ".h5"}) {
        const SeriesTable table = readSeries(path + kind);
        EXPECT_EQ(table.rows.size(), 4u) << kind;
        ASSERT_EQ(table.remarks.size(), 3u) << kind;
        EXPECT_EQ(table.remarks[0].text, "a gap: \"narrow\"") << kind;
        EXPECT_EQ(table.remarks[2].text, "late: now") << kind;
        EXPECT_EQ(table.remarks[2].row, 2u) << kind;
        std::filesystem::remove(path + kind);
    }
    EXPECT_EQ(series.dropAfter(0.1), 3u) << "two rows and a remark";
    EXPECT_EQ(series.csv().find("late"), std::string::npos);
    EXPECT_NE(series.csv().find("# Mach number: 0\n"), std::string::npos);
}

TEST(TimeSeries, CsvHasUnitsAndEqualRows) {
    const auto lines = linesOf(example().csv());
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].find("time [s],step,dt [s],kinetic_energy [J]"), 0u);
    EXPECT_NE(lines[0].find("evaluations,sort [ms],density [ms]"), std::string::npos)
        << "each pass of the plan once, from the first row on";
    EXPECT_EQ(lines[1].find("0.1,3,0.025,0,"), 0u) << lines[1];
    EXPECT_EQ(lines[2].find("0.2,3,0.025,nan,"), 0u) << lines[2];
    for (const std::string& line : lines)
        EXPECT_EQ(std::count(line.begin(), line.end(), ','),
                  std::count(lines[0].begin(), lines[0].end(), ','))
            << line;
    EXPECT_TRUE(lines[2].ends_with(",0,2")) << "ms of one run of a pass: " << lines[2];
}

// What has a depth says in two dimensions that it is per metre of it, in every format.
TEST(TimeSeries, UnitsArePerMetreOfDepthInTwoDimensions) {
    for (const int dimensions : {2, 3}) {
        Measurement m;
        m.dimensions = dimensions;
        m.solids.push_back({"wall", {}, {}, {}, {}, {}, {}});
        TimeSeries series(std::vector<Column>{{"gauge.height", "m"}, {"gauge.pressure", "Pa"}});
        series.add(m, {}, {0, 0});
        const std::string header = linesOf(series.csv())[0] + ",", json = series.json();
        using Expected = std::tuple<std::string, std::string, bool>;
        for (const auto& [name, unit, hasDepth] :
             std::vector<Expected>{{"kinetic_energy", "J", true},
                                   {"potential_energy", "J", true},
                                   {"momentum_x", "kg m/s", true},
                                   {"momentum_z", "kg m/s", true},
                                   {"angular_momentum_z", "kg m²/s", true},
                                   {"wall.pressure_force_x", "N", true},
                                   {"wall.viscous_force_y", "N", true},
                                   {"wall.torque_z", "N m", true},
                                   {"wall.velocity_x", "m/s", false},
                                   {"mean_density", "kg/m³", false},
                                   {"center_of_mass_x", "m", false},
                                   {"gauge.height", "m", false},
                                   {"gauge.pressure", "Pa", false}}) {
            const std::string expected = unit + (hasDepth && dimensions == 2 ? "/m" : "");
            EXPECT_NE(header.find("," + name + " [" + expected + "],"), std::string::npos) << name;
            const std::string inJson = "\"" + name + "\", \"unit\": \"" + expected + "\"}";
            EXPECT_NE(json.find(inJson), std::string::npos) << name;
        }
    }
}

TEST(TimeSeries, JsonIsValidAndHasNullForNoNumber) {
    const auto json = nlohmann::json::parse(example().json());
    EXPECT_EQ(json["columns"][3]["name"], "kinetic_energy");
    EXPECT_EQ(json["columns"][3]["unit"], "J");
    ASSERT_EQ(json["rows"].size(), 2u);
    EXPECT_EQ(json["rows"][0].size(), json["columns"].size());
    EXPECT_TRUE(json["rows"][1][3].is_null());
    EXPECT_EQ(json["rows"][0][0], 0.1);
}

TEST(TimeSeries, MoreColumnsStandBeforeThePasses) {
    TimeSeries series({{"gauge.height", "m"}, {"wall.pressure", "Pa"}}, {{"sort", ""}});
    series.add({}, {{"sort", 4, 2}}, {0.25, NAN});
    const auto lines = linesOf(series.csv());
    EXPECT_TRUE(lines[0].ends_with(
        "max_speed [m/s],evaluations,gauge.height [m],wall.pressure [Pa],sort [ms]"))
        << lines[0];
    EXPECT_TRUE(lines[1].ends_with(",0.25,nan,2")) << lines[1];
}

TEST(TimeSeries, Hdf5HasADatasetWithItsUnitForEachColumn) {
    const std::string path =
        testing::TempDir() + "spindrift-series-" + std::to_string(getpid()) + ".h5";
    TimeSeries series({{"gauge.height", "m"}}, {{"sort", ""}});
    Measurement m;
    series.add(m, {}, {1.0 / 3});
    m.time = 0.5;
    series.add(m, {{"sort", 4, 2}}, {0.75});
    series.writeHdf5(path);
    {
        const hdf5::Handle file = hdf5::openFile(path);
        EXPECT_EQ(hdf5::readNumbers(file, "time"), (std::vector<double>{0, 0.5}));
        EXPECT_EQ(hdf5::readNumbers(file, "gauge.height"), (std::vector<double>{1.0 / 3, 0.75}));
        EXPECT_EQ(hdf5::readNumbers(file, "sort"), (std::vector<double>{0, 2}));
        const hdf5::Array height(file, "gauge.height", 1);
        const hdf5::Handle unit(H5Aopen(height.set, "unit", H5P_DEFAULT), H5Aclose, "unit");
        const hdf5::Handle type(H5Aget_type(unit), H5Tclose, "type");
        char text[2] = {};
        ASSERT_EQ(H5Tget_size(type), 1u);
        H5Aread(unit, type, text);
        EXPECT_STREQ(text, "m");
    }
    std::filesystem::remove(path);
    EXPECT_THROW(series.writeHdf5("/nowhere/a.h5"), Error);
}

}  // namespace
}  // namespace spindrift
