#pragma once
// The colour legend: a bar of the table with title, unit and ticks, drawn into the picture itself.
#include "core/color_map.h"

#include <string>
#include <vector>

namespace spindrift {

class Overlay;

struct LegendText {
    std::string title, unit;  // "velocity", "m/s"
    std::string note;         // "per frame", "over the run", "fixed"
};

// Round numbers within [min, max], about `count` of them: steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double min, double max, int count);
// `value` as short as its neighbours `step` apart can be told.
std::string tickLabel(double value, double step);

void drawLegend(Overlay&, int width, int height, const LegendText&, ColorMap, float min, float max);

}  // namespace spindrift
