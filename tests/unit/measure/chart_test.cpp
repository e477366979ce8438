#include "measure/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spindrift {
namespace {

TEST(Chart, ShowsEveryCurveAndLeavesOutWhatHasNoPlace) {
    Chart chart{"a < b & c", "x", "y", {{"ours", {1, 10, 100}, {1e-3, 0, 1}, Curve::Line}}, true, true};
    chart.curves.push_back({"theirs", {1, 2}, {std::nan(""), 0.5}, Curve::Points});
    const std::string text = svg(chart);
    EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
    EXPECT_NE(text.find(">theirs<"), std::string::npos);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
    // Two of three points are positive: from the left to the right edge, from bottom to top.
    const size_t points = text.find("points='");
    double x1, y1, x2, y2;
    ASSERT_EQ(std::sscanf(text.c_str() + points, "points='%lf,%lf %lf,%lf '", &x1, &y1, &x2, &y2), 4) << text.substr(points, 60);
    EXPECT_LT(x1, x2);
    EXPECT_GT(y1, y2);
}

TEST(Chart, CopesWithNothing) {
    EXPECT_NE(svg(Chart{}).find("</svg>"), std::string::npos);
    EXPECT_EQ(svg({"", "", "", {{"flat", {0, 1}, {2, 2}, Curve::Line}}}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace spindrift
