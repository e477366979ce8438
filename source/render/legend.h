#pragma once
// What is written into the picture itself: the colour legend, a bar of the table with title, unit
// and ticks; and the scale of lengths.
#include "core/color_map.h"
#include "render/color_map.h"
#include "render/overlay.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift {

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

// The round number, 1, 2 or 5 times a power of ten, that splits `span` into at most `count` steps.
double tickStep(double span, int count);
// Round numbers within [min, max], about `count` of them: steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double min, double max, int count);
// `value` as short as its neighbours `step` apart can be told.
std::string tickLabel(double value, double step);
// The same for a scale of logarithms: powers of ten, with `dense` also 2 and 5 times them, or every
// `stride`-th.
std::vector<double> logarithmicTicks(double min, double max, bool dense, int stride);

// The marks of a bar so many pixels long: as many as fit, labels a little apart and within
// `overhang` of the bar's ends.
struct Mark {
    double value;
    std::string label;
    float at, middle;  // px from the bar's left end: of the tick and of its label
};
std::vector<Mark> fittingMarks(double min, double max, bool logarithmic, float bar, float overhang,
                               const std::function<float(std::string_view)>& widthOf);

// What is written with, on a dark or a light picture.
struct Ink {
    Rgba bright, dim, panel;
};
Ink inkOf(Theme);

// Colours and the values at their ends.
struct ColorBar {
    ColorTable table;
    const char* name;
    float min, max;
    bool logarithmic;
};
void drawLegend(Overlay&, int width, int height, const LegendText&, const Ink&, const ColorBar&);
void drawLegend(Overlay&, int width, int height, const LegendText&, const Ink&,
                const std::vector<Swatch>&);
// A bar of a round length beside the axes, for a picture of so many metres a pixel, and how large
// the ground's cells are, m; 0 = there is none.
void drawScale(Overlay&, int width, int height, const Ink&, float metres, float cell);

}  // namespace spindrift
