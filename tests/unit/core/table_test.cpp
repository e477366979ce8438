#include "core/table.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace spindrift {
namespace {

const std::string Data = SPINDRIFT_SOURCE_DIR "/configs/validation/data/";

TEST(Table, ReadsColumnsByName) {
    const auto table = readTable(Data + "cavity_u_centreline_computed.csv");
    ASSERT_EQ(table.at("y").size(), 129u);
    EXPECT_EQ(table.at("y").back(), 1);
    EXPECT_EQ(table.at("Re100")[1], -0.005839);
    EXPECT_TRUE(std::isnan(readTable(Data + "lobovsky2014_H300_peak_pressures.csv").at("sensor")[0]));
}

TEST(Table, MissingFileIsAnError) {
    try {
        readTable(Data + "nothing.csv");
        FAIL();
    } catch (const Error& error) { EXPECT_EQ(error.exit, Exit::Scene); }
}

TEST(Table, StrictTablesNameTheLineThatIsWrong) {
    const std::string file = testing::TempDir() + "strict.csv";
    std::ofstream(file) << "# a comment\nt, x\n0, 1\n1, one\n";
    try {
        readStrictTable(file, {"t", "x"});
        FAIL();
    } catch (const Error& error) { EXPECT_NE(std::string(error.what()).find("line 4: x is no number"), std::string::npos) << error.what(); }
    EXPECT_THROW(readStrictTable(file, {"t", "y"}), Error);
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
