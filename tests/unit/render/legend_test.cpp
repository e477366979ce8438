#include "render/legend.h"

#include <gtest/gtest.h>

#include <limits>

namespace spindrift {
namespace {

TEST(Legend, TicksAreRoundAndWithinTheRange) {
    EXPECT_EQ(ticks(0, 4.1, 5), (std::vector<double>{0, 1, 2, 3, 4}));
    EXPECT_EQ(ticks(-0.5, 0.5, 5).size(), 5u);
    for (double span : {1e-7, 0.37, 12.0, 9.9e5}) {
        const std::vector<double> marks = ticks(3, 3 + span, 5);
        EXPECT_GE(marks.size(), 2u) << span;
        EXPECT_LE(marks.size(), 6u) << span;
        EXPECT_GE(marks.front(), 3 - 1e-6 * span);
        EXPECT_LE(marks.back(), 3 + span * (1 + 1e-6));
    }
}

TEST(Legend, EmptyOrEndlessRangesHaveOneTick) {
    EXPECT_EQ(ticks(2, 2, 5).size(), 1u);
    EXPECT_EQ(ticks(0, std::numeric_limits<double>::infinity(), 5).size(), 1u);
    EXPECT_EQ(ticks(0, std::numeric_limits<double>::quiet_NaN(), 5).size(), 1u);
}

TEST(Legend, LabelsTellNeighboursApart) {
    EXPECT_EQ(tickLabel(0, 1), "0");
    EXPECT_EQ(tickLabel(1000, 0.5), "1000.0");
    EXPECT_EQ(tickLabel(0.05, 0.05), "0.05");
    EXPECT_EQ(tickLabel(2.5e7, 5e6), "2.5e+07");
    EXPECT_NE(tickLabel(998.2, 0.2), tickLabel(998.4, 0.2));
}

}  // namespace
}  // namespace spindrift
