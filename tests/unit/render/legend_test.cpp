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
        const std::vector<Mark> marks = fittingMarks(value, value, false, 270, 16, widthOf);
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
                const std::vector<Mark> marks =
                    fittingMarks(from, from + span, false, bar, 16, widthOf);
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

// Powers of ten, evenly apart, however many there are; within one 2 and 5 times them too.
TEST(LogarithmicMarks, AreEvenAndFit) {
    const auto widthOf = [](std::string_view label) { return 8 * float(label.size()); };
    for (const double low : {1e-6, 3e-3, 1.0, 40.0})
        for (const double span : {1.5, 8.0, 1e2, 1e4, 1e9})
            for (const float bar : {120.0f, 270.0f}) {
                const double high = low * span;
                const auto marks = fittingMarks(low, high, true, bar, 16, widthOf);
                ASSERT_FALSE(marks.empty());
                float end = -1e9f;
                for (const Mark& m : marks) {
                    EXPECT_GE(m.value, low * (1 - 1e-5));
                    EXPECT_LE(m.value, high * (1 + 1e-5));
                    if (marks.size() > 1) {
                        EXPECT_NEAR(m.at, bar * std::log(m.value / low) / std::log(span), 0.01);
                    }
                    EXPECT_GT(m.middle - 0.5f * widthOf(m.label), end);
                    end = m.middle + 0.5f * widthOf(m.label);
                }
            }
    EXPECT_EQ(logarithmicTicks(0.5, 30, true, 1), (std::vector<double>{0.5, 1, 2, 5, 10, 20}));
    EXPECT_EQ(logarithmicTicks(0.5, 3000, false, 2), (std::vector<double>{1, 100}));
}

}  // namespace
}  // namespace spindrift
