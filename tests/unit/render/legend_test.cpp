#include "render/legend.h"

#include <gtest/gtest.h>

#include <cmath>
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

// A tank in free fall: all have the same speed, which is not zero.
TEST(Legend, OneValueHasOneLabelAtTheLowEnd) {
    const auto widthOf = [](std::string_view text) { return 8 * float(text.size()); };
    for (const auto& [value, label] :
         {std::pair{0.0, "0"}, {0.0245, "0.0245"}, {1000.0, "1000"}, {-2e-5, "-2e-05"}}) {
        const std::vector<Mark> marks = fittingMarks(value, value, 270, 16, widthOf);
        ASSERT_EQ(marks.size(), 1u) << value;
        EXPECT_EQ(marks[0].label, label);
        EXPECT_EQ(marks[0].at, 0);
    }
}

TEST(Legend, LabelsTellNeighboursApart) {
    EXPECT_EQ(tickLabel(0, 1), "0");
    EXPECT_EQ(tickLabel(1000, 0.5), "1000.0");
    EXPECT_EQ(tickLabel(0.05, 0.05), "0.05");
    EXPECT_EQ(tickLabel(2.5e7, 5e6), "2.5e+07");
    EXPECT_NE(tickLabel(998.2, 0.2), tickLabel(998.4, 0.2));
}

// Ranges of every size and place, on bars of every length: labels never touch, stay within the box,
// and tell their values apart.
TEST(Legend, LabelsNeverOverlap) {
    const auto widthOf = [](std::string_view text) { return 8 * float(text.size()); };
    for (double from : {0.0, -1.0, 998.0, 1e6, -3e7, 1e-7, 0.0245})
        for (double span : {3e-7, 1e-5, 3e-3, 0.07, 1.0, 6.5, 440.0, 3e4, 7e9})
            for (float bar : {60.0f, 120.0f, 270.0f, 900.0f}) {
                if (span < 1e-6 * std::abs(from)) continue;  // what floats can't tell apart
                const std::vector<Mark> marks = fittingMarks(from, from + span, bar, 16, widthOf);
                ASSERT_FALSE(marks.empty());
                for (size_t i = 0; i < marks.size(); ++i) {
                    const float half = widthOf(marks[i].label) / 2;
                    if (2 * half <= bar + 32) {
                        EXPECT_LE(marks[i].middle + half, bar + 16.01f)
                            << from << " " << span << " " << bar;
                    }
                    EXPECT_GE(marks[i].middle - half, -16.01f);
                    if (i == 0) continue;
                    EXPECT_GT(marks[i].middle - half,
                              marks[i - 1].middle + widthOf(marks[i - 1].label) / 2)
                        << from << " " << span << " " << bar;
                    EXPECT_NE(marks[i].label, marks[i - 1].label) << from << " " << span;
                }
            }
}

}  // namespace
}  // namespace spindrift
