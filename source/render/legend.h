#pragma once
// The colour legend: a bar of the table with title, unit and ticks, drawn into the picture itself.
#include "core/color_map.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift {

class Overlay;

struct LegendText {
    std::string title, unit;  // "velocity", "m/s"
    std::string note;         // "per frame", "over the run", "fixed"
};

// A value that has a name and a colour instead of a place on a scale.
struct Swatch {
    std::string name;
    float value;
    std::array<uint8_t, 3> color;
};

// Round numbers within [min, max], about `count` of them: steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double min, double max, int count);
// `value` as short as its neighbours `step` apart can be told.
std::string tickLabel(double value, double step);

// The marks of a bar so many pixels long: as many as fit, labels a little apart and within
// `overhang` of the bar's ends.
struct Mark {
    double value;
    std::string label;
    float at, middle;  // px from the bar's left end: of the tick and of its label
};
std::vector<Mark> fittingMarks(double min, double max, float bar, float overhang,
                               const std::function<float(std::string_view)>& widthOf);

void drawLegend(Overlay&, int width, int height, const LegendText&, ColorMap, float min, float max);
void drawLegend(Overlay&, int width, int height, const LegendText&, const std::vector<Swatch>&);

}  // namespace spindrift
