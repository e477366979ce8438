#include "core/table.h"

#include "core/error.h"
#include "core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <tuple>

namespace spindrift {
namespace {

const std::string Data = SPINDRIFT_SOURCE_DIR "/configs/validation/data/";

TEST(Table, ReadsColumnsByName) {
    const auto table = readTable(Data + "cavity_u_centreline_computed.csv");
    ASSERT_EQ(table.at("y").size(), 129u);
    EXPECT_EQ(table.at("y").back(), 1);
    EXPECT_EQ(table.at("Re100")[1], -0.005839);
    EXPECT_TRUE(
        std::isnan(readTable(Data + "lobovsky2014_H300_peak_pressures.csv").at("sensor")[0]));
}

TEST(Table, MissingFileIsAnError) {
    try {
        readTable(Data + "nothing.csv");
        FAIL();
    } catch (const Error& error) { EXPECT_EQ(error.failure, Failure::Scene); }
}

TEST(Table, StrictTablesNameTheLineThatIsWrong) {
    const std::string file = testing::TempDir() + "strict.csv";
    std::ofstream(file) << "# a comment\nt, x\n0, 1\n1, one\n";
    try {
        readStrictTable(file, {{"t", "s", true}, {"x", "m", true}});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("line 4: x is no number"), std::string::npos)
            << error.what();
    }
    EXPECT_THROW(readStrictTable(file, {{"t", "s"}, {"x", "m"}, {"y", "m", true}}), Error);
}

// Every way to separate, to mark decimals, to quote, to begin and to end lines gives the same
// table.
TEST(Table, TheSameHoweverItIsWritten) {
    const std::string file = testing::TempDir() + "spelt.csv";
    int ways = 0;
    for (const std::string separator : {",", ";", "\t", " ", " , ", " ;\t"})
        for (const std::string mark : {".", ","})
            for (const std::string quote : {"", "\"", "'"})
                for (const std::string start : {"", "\xef\xbb\xbf"})
                    for (const std::string end : {"\n", "\r\n"})
                        for (const std::string unit :
                             {"", " [m]", " (M)", "[ m ]", " / m", "/mm"}) {
                            if (mark == "," && separator.find(',') != std::string::npos) continue;
                            if (separator == " " && unit.find('/') != std::string::npos &&
                                quote != "\"")
                                continue;
                            const std::string metre =
                                unit == "/mm" ? "1500" + mark + "0" : "1" + mark + "5";
                            std::ofstream(file, std::ios::binary)
                                << start << "# a comment" << end << quote << "T" << quote
                                << separator << quote << "x" << unit << quote << end << end << "0"
                                << separator << quote << metre << quote << end << "1e1" << separator
                                << "-" << metre << end;
                            const std::string way =
                                separator + "|" + mark + "|" + quote + "|" + unit;
                            try {
                                const Table table =
                                    readStrictTable(file, {{"t", "s", true}, {"x", "m", true}});
                                EXPECT_EQ(table.at("t"), (std::vector<double>{0, 10})) << way;
                                EXPECT_EQ(table.at("x"), (std::vector<double>{1.5, -1.5})) << way;
                                EXPECT_EQ(table.lines, (std::vector<int>{4, 5})) << way;
                                EXPECT_EQ(columnsOf(file), (std::vector<std::string>{"t", "x"}))
                                    << way;
                                EXPECT_EQ(countRows(file), 2) << way;
                                ++ways;
                            } catch (const Error& error) {
                                ADD_FAILURE() << way << ": " << error.what();
                            }
                        }
    EXPECT_GT(ways, 400);
}

TEST(Table, MarksThatContradictEachOtherAndWideTextAreRefused) {
    const std::string file = testing::TempDir() + "marks.csv";
    auto complaint = [&](const std::string& text) -> std::string {
        std::ofstream(file, std::ios::binary) << text;
        try {
            readStrictTable(file, {{"t", "s", true}, {"x", "m", true}});
        } catch (const Error& error) { return error.what(); }
        return "";
    };
    EXPECT_NE(complaint("t;x\n0;1,5\n1;1.5\n").find("line 3: x is no number"), std::string::npos);
    EXPECT_NE(complaint("t;x\n0;1.000,5\n").find("line 2: x is no number"), std::string::npos);
    EXPECT_NE(complaint("t,x\n0,5,1,5\n").find("line 2: 4 values for 2 columns"),
              std::string::npos);
    EXPECT_NE(complaint(std::string("\xff\xfet\0,\0", 6)).find("UTF-16"), std::string::npos);
    EXPECT_NE(complaint("t;x [furlong]\n0;1\n")
                  .find("\"furlong\" is no unit of it that is known; use m, mm, cm"),
              std::string::npos);
    EXPECT_NE(complaint("t;x;y\n0;1;1\n").find("unknown column \"y\"; known: t, x"),
              std::string::npos);
}

TEST(Units, FactorsOfEverySpelling) {
    const std::tuple<const char*, const char*, double> cases[] = {
        {"mm", "m", 1e-3},
        {"µm", "m", 1e-6},
        {"\xb5m", "m", 1e-6},
        {"km", "m", 1e3},
        {"nm", "m", 1e-9},
        {"MM", "m", 1e-3},
        {"ft", "m", 0.3048},
        {"cm/s", "m/s", 1e-2},
        {"km/h", "m/s", 1 / 3.6},
        {"m s^-1", "m/s", 1},
        {"m s-1", "m/s", 1},
        {"m·s⁻¹", "m/s", 1},
        {"M/S", "m/s", 1},
        {"kg/m³", "kg/m^3", 1},
        {"kg/m3", "kg/m^3", 1},
        {"kg m-3", "kg/m^3", 1},
        {"kg/m**3", "kg/m^3", 1},
        {"g/cm^3", "kg/m^3", 1e3},
        {"g/cm³", "kg/m^3", 1e3},
        {"g/cc", "kg/m^3", 1e3},
        {"g/ml", "kg/m^3", 1e3},
        {"g/mL", "kg/m^3", 1e3},
        {"kg/l", "kg/m^3", 1e3},
        {"KG/M^3", "kg/m^3", 1},
        {"KG/M3", "kg/m³", 1},
        {"kg/m^3", "kg/m³", 1},
        {"g/cm^3", "kg/m³", 1e3},
        {"t/m^3", "kg/m^3", 1e3},
        {"mg/mm^3", "kg/m^3", 1e3},
        {"hPa", "Pa", 1e2},
        {"kPa", "Pa", 1e3},
        {"MPa", "Pa", 1e6},
        {"bar", "Pa", 1e5},
        {"mbar", "Pa", 1e2},
        {"atm", "Pa", 101325},
        {"psi", "Pa", 6894.757293168361},
        {"N/m^2", "Pa", 1},
        {"kg/(m s^2)", "Pa", 1},
        {"MPA", "Pa", 1e6},
        {"ms", "s", 1e-3},
        {"min", "s", 60},
        {"h", "s", 3600},
        {"rad", "degrees", 180 / 3.141592653589793},
        {"°", "degrees", 1},
        {"rad/s", "degrees/s", 180 / 3.141592653589793},
        {"deg/min", "degrees/s", 1.0 / 60}};
    for (const auto& [unit, to, factor] : cases) {
        const std::optional<double> found = unitFactor(unit, to);
        ASSERT_TRUE(found) << unit << " to " << to;
        EXPECT_NEAR(*found / factor, 1, 1e-14) << unit << " to " << to;
    }
    const std::string goals[] = {"m", "m/s", "kg/m³", "Pa", "s", "degrees", "degrees/s"};
    for (const std::string& to : goals) {
        EXPECT_EQ(unitFactor(to, to), 1.0);
        for (const char* wrong :
             {"", "furlong", "m/", "/s", "kg/m", "mpa", "kgm3", "1", "-", "m//s", "m^0", "%"})
            EXPECT_FALSE(unitFactor(wrong, to)) << wrong << " to " << to;
        for (const std::string& other : goals)
            EXPECT_EQ(unitFactor(other, to).has_value(), other == to) << other << " to " << to;
    }
}

TEST(Table, ValuesBetweenAndBeyondPoints) {
    const std::vector<double> x{0, 1, 3}, y{5, 7, 3};
    EXPECT_EQ(valueAt(x, y, -1), 5);
    EXPECT_EQ(valueAt(x, y, 0.5), 6);
    EXPECT_EQ(valueAt(x, y, 2), 5);
    EXPECT_EQ(valueAt(x, y, 9), 3);
}

}  // namespace
}  // namespace spindrift
