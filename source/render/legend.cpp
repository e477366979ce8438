#include "render/legend.h"

#include "render/color_map.h"
#include "render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace {

// The round number that splits `span` into at most `count` steps.
double tickStep(double span, int count) {
    const double power = std::pow(10.0, std::floor(std::log10(span / count)));
    for (double factor : {1.0, 2.0, 5.0})
        if (span / (factor * power) <= count) return factor * power;
    return 10 * power;
}

}  // namespace

std::vector<double> ticks(double min, double max, int count) {
    std::vector<double> found;
    if (!(max > min) || !std::isfinite(max - min)) return {min};
    const double step = tickStep(max - min, count);
    const double slack = 1e-6 * step;
    for (double i = std::ceil((min - slack) / step); i * step <= max + slack; ++i)
        found.push_back(i == 0 ? 0 : i * step);  // never -0
    return found;
}

std::string tickLabel(double value, double step) {
    const double largest = std::max(std::abs(value), std::abs(step));
    if (value == 0) return "0";
    if (largest >= 1e6 || largest < 1e-3) return fmt::format("{:.3g}", value);
    const int decimals = step > 0 ? std::clamp(int(std::ceil(-std::log10(step) - 1e-6)), 0, 6) : 3;
    return fmt::format("{:.{}f}", value, decimals);
}

void drawLegend(Overlay& overlay, int width, int height, const LegendText& text, ColorMap map,
                float min, float max) {
    // Grows with the picture, so that it reads the same at every size and on dense screens.
    const float unit = std::clamp(std::min(float(height) / 760, float(width) / 760), 0.9f, 4.0f);
    overlay.textSize(14 * unit);
    const float pad = 14 * unit, bar = std::min(270 * unit, 0.6f * float(width)), thick = 12 * unit;
    const float boxWidth = bar + 2 * pad + 12 * unit, boxHeight = 80 * unit;
    // At the lower left: the tank's near corner stands at the lower right of the first view.
    const float left = 16 * unit, top = float(height) - boxHeight - 16 * unit;
    overlay.panel(left, top, boxWidth, boxHeight, 8 * unit, {0.04f, 0.05f, 0.07f, 0.62f});

    const float x = std::round(left + pad + 6 * unit), titleLine = top + 23 * unit;
    const Rgba bright{0.94f, 0.95f, 0.97f}, dim{0.66f, 0.69f, 0.74f};
    overlay.text(x, titleLine, text.title, bright);
    overlay.text(x + overlay.textWidth(text.title + " "), titleLine, text.unit, dim);
    const std::string note = std::string(colorMapName(map)) + ", " + text.note;
    const float titleWidth = overlay.textWidth(text.title + " " + text.unit + " ");
    if (titleWidth + overlay.textWidth(note) <= bar)
        overlay.text(x + bar - overlay.textWidth(note), titleLine, note, dim);

    const ColorTable table = colorTable(map);
    const float barTop = std::round(top + 34 * unit);
    for (size_t i = 0; i < table.size(); ++i) {
        const float from = std::round(bar * float(i) / 256),
                    to = std::round(bar * float(i + 1) / 256);
        overlay.rectangle(x + from, barTop, to - from, thick,
                          {table[i][0] / 255.0f, table[i][1] / 255.0f, table[i][2] / 255.0f});
    }
    const std::vector<double> marks = ticks(min, max, 5);
    const double step = marks.size() > 1 ? marks[1] - marks[0] : 0;
    for (double mark : marks) {
        const float at = max > min ? float((mark - min) / (max - min)) : 0.5f;
        const std::string label = tickLabel(mark, step);
        const float tick = std::round(x + at * bar);
        overlay.rectangle(tick - std::round(unit) / 2, barTop + thick,
                          std::max(1.0f, std::round(unit)), 5 * unit, dim);
        overlay.text(tick - 0.5f * overlay.textWidth(label), barTop + thick + 19 * unit, label,
                     bright);
    }
}

}  // namespace spindrift
