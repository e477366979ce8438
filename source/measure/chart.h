#pragma once
// Line charts as SVG: text that any browser shows and that two runs can be compared by.
#include <string>
#include <vector>

namespace spindrift {

struct Curve {
    std::string name;
    std::vector<double> x, y;
    enum Style { Line, Dashed, Points } style = Line;
    std::vector<std::string> labels =
        {};  // beside its points, where there is room; fewer or none is allowed
};

struct Chart {
    std::string title, xLabel, yLabel;
    std::vector<Curve> curves;
    bool logX = false, logY = false;
};

// Values that are not finite, or not positive on a logarithmic axis, are left out.
std::string svg(const Chart&);

}  // namespace spindrift
