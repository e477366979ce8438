#include "measure/reference.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

const std::string Data = SPINDRIFT_SOURCE_DIR "/configs/validation/data/";

TEST(Reference, ReadsColumnsByName) {
    const auto table = readTable(Data + "cavity_u_centreline_computed.csv");
    ASSERT_EQ(table.at("y").size(), 129u);
    EXPECT_EQ(table.at("y").back(), 1);
    EXPECT_EQ(table.at("Re100")[1], -0.005839);
    EXPECT_TRUE(std::isnan(readTable(Data + "lobovsky2014_H300_peak_pressures.csv").at("sensor")[0]));
}

TEST(Reference, MissingFileIsAnError) {
    try {
        readTable(Data + "nothing.csv");
        FAIL();
    } catch (const Error& error) { EXPECT_EQ(error.exit, Exit::Scene); }
}

TEST(Reference, ValuesBetweenAndBeyondPoints) {
    const std::vector<double> x{0, 1, 3}, y{5, 7, 3};
    EXPECT_EQ(valueAt(x, y, -1), 5);
    EXPECT_EQ(valueAt(x, y, 0.5), 6);
    EXPECT_EQ(valueAt(x, y, 2), 5);
    EXPECT_EQ(valueAt(x, y, 9), 3);
}

}  // namespace
}  // namespace spindrift
