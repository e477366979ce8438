#include "measure/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spindrift {
namespace {

TEST(Chart, ShowsEveryCurveAndLeavesOutWhatHasNoPlace) {
    Chart chart{"a < b & c", "x", "y", {{"ours", {1, 10, 100}, {1e-3, 0, 1}, Curve::Line}},
                true,        true};
    chart.curves.push_back({"theirs", {1, 2}, {std::nan(""), 0.5}, Curve::Points});
    const std::string text = svg(chart);
    EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
    EXPECT_NE(text.find(">theirs<"), std::string::npos);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
    // Two of three points are positive: from the left to the right edge, from bottom to top.
    const size_t points = text.find("points='");
    double x1, y1, x2, y2;
    ASSERT_EQ(std::sscanf(text.c_str() + points, "points='%lf,%lf %lf,%lf '", &x1, &y1, &x2, &y2),
              4)
        << text.substr(points, 60);
    EXPECT_LT(x1, x2);
    EXPECT_GT(y1, y2);
}

// Where they stand in the picture; three points at one place, one by itself.
TEST(Chart, LabelsDoNotCoverEachOther) {
    Chart chart{"",
                "x",
                "y",
                {{"front",
                  {1, 1, 1, 2},
                  {1, 1, 1, 2},
                  Curve::Points,
                  {"first", "second", "third", "alone"}}}};
    const std::string text = svg(chart);
    double left[3], top[3];
    const char* names[] = {"first", "second", "third"};
    for (int k = 0; k < 3; ++k) {
        const size_t at = text.find(std::string(">") + names[k] + "</text>");
        ASSERT_NE(at, std::string::npos) << names[k];
        const std::string element = text.substr(text.rfind("<text", at));
        ASSERT_EQ(std::sscanf(element.c_str(), "<text x='%lf' y='%lf'", &left[k], &top[k]), 2)
            << element.substr(0, 60);
        for (int o = 0; o < k; ++o)
            EXPECT_TRUE(std::abs(top[k] - top[o]) > 10 || std::abs(left[k] - left[o]) > 30)
                << names[k];
    }
}

TEST(Chart, CopesWithNothing) {
    EXPECT_NE(svg(Chart{}).find("</svg>"), std::string::npos);
    EXPECT_EQ(svg({"", "", "", {{"flat", {0, 1}, {2, 2}, Curve::Line}}}).find("nan"),
              std::string::npos);
}

}  // namespace
}  // namespace spindrift
