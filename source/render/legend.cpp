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
    if (!(step > 0)) return fmt::format("{:.4g}", value);  // it is alone
    const double digits = std::ceil(std::log10(largest / step) - 1e-6) + 1;
    if (largest >= 1e6 || largest < 1e-3)
        return fmt::format("{:.{}g}", value, int(std::clamp(digits, 3.0, 9.0)));
    const int decimals = std::clamp(int(std::ceil(-std::log10(step) - 1e-6)), 0, 8);
    return fmt::format("{:.{}f}", value, decimals);
}

std::vector<Mark> fittingMarks(double min, double max, float bar, float overhang,
                               const std::function<float(std::string_view)>& widthOf) {
    std::vector<Mark> marks;
    for (int count = 5; count > 0; --count) {
        const std::vector<double> values = ticks(min, max, count);
        const double step = values.size() > 1 ? values[1] - values[0] : 0;
        marks.clear();
        bool fits = true;
        float end = -1e9f;  // of the label before
        for (double value : values) {
            const std::string label = tickLabel(value, step);
            const float half = 0.5f * widthOf(label),
                        at = bar * (max > min ? float((value - min) / (max - min)) : 0);
            const float last = std::max(bar + overhang - half, half - overhang);
            const float middle = std::clamp(at, half - overhang, last);
            fits &= middle - half > end;
            end = middle + half + widthOf("0");
            marks.push_back({value, label, at, middle});
        }
        if (fits && !marks.empty()) return marks;
    }
    return {
        {min, tickLabel(min, 0), 0, std::max(0.0f, 0.5f * widthOf(tickLabel(min, 0)) - overhang)}};
}

namespace {

const Rgba bright{0.94f, 0.95f, 0.97f}, dim{0.66f, 0.69f, 0.74f};

// Grows with the picture, so that it reads the same at every size and on dense screens.
float unitOf(int width, int height) {
    return std::clamp(std::min(float(height) / 760, float(width) / 760), 0.9f, 4.0f);
}

Rgba opaque(const std::array<uint8_t, 3>& c) {
    return {c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f};
}

// The box, so many units high, its title, and the first of the notes for which there is room. At
// the lower left: the tank's near corner stands at the lower right of the first view.
struct Box {
    float unit, x, top, bar;
};
Box drawBox(Overlay& overlay, int width, int height, float units, const LegendText& text,
            const std::vector<std::string>& notes) {
    const float unit = unitOf(width, height);
    overlay.textSize(14 * unit);
    const float pad = 14 * unit, bar = std::min(270 * unit, 0.6f * float(width)),
                boxHeight = units * unit;
    const float left = 16 * unit, top = float(height) - boxHeight - 16 * unit;
    overlay.panel(left, top, bar + 2 * pad + 12 * unit, boxHeight, 8 * unit,
                  {0.04f, 0.05f, 0.07f, 0.62f});
    const float x = std::round(left + pad + 6 * unit), titleLine = top + 23 * unit;
    overlay.text(x, titleLine, text.title, bright);
    overlay.text(x + overlay.textWidth(text.title + " "), titleLine, text.unit, dim);
    const float titleWidth = overlay.textWidth(text.title + " " + text.unit + " ");
    for (const std::string& note : notes) {
        if (titleWidth + overlay.textWidth(note) > bar) continue;
        overlay.text(x + bar - overlay.textWidth(note), titleLine, note, dim);
        break;
    }
    return {unit, x, top, bar};
}

}  // namespace

void drawLegend(Overlay& overlay, int width, int height, const LegendText& text, ColorMap map,
                float min, float max) {
    const std::vector<std::string> notes{std::string(colorMapName(map)) + ", " + text.note,
                                         text.note};
    const auto [unit, x, top, bar] = drawBox(overlay, width, height, 80, text, notes);
    const ColorTable table = colorTable(map);
    const float barTop = std::round(top + 34 * unit), thick = 12 * unit;
    for (size_t i = 0; i < table.size(); ++i) {
        const float from = std::round(bar * float(i) / 256),
                    to = std::round(bar * float(i + 1) / 256);
        overlay.rectangle(x + from, barTop, to - from, thick, opaque(table[i]));
    }
    const auto widthOf = [&](std::string_view label) { return overlay.textWidth(label); };
    for (const Mark& mark : fittingMarks(min, max, bar, 12 * unit, widthOf)) {
        const float tick = std::round(x + mark.at);
        overlay.rectangle(tick - std::round(unit) / 2, barTop + thick,
                          std::max(1.0f, std::round(unit)), 5 * unit, dim);
        overlay.text(x + mark.middle - 0.5f * overlay.textWidth(mark.label),
                     barTop + thick + 19 * unit, mark.label, bright);
    }
}

void drawLegend(Overlay& overlay, int width, int height, const LegendText& text,
                const std::vector<Swatch>& swatches) {
    constexpr size_t most = 12;
    const size_t shown = std::min(swatches.size(), most);
    const auto [unit, x, top, bar] =
        drawBox(overlay, width, height, 36 + 22 * float(shown), text, {text.note});
    for (size_t i = 0; i < shown; ++i) {
        const float line = top + (46 + 22 * float(i)) * unit;
        overlay.rectangle(x, std::round(line - 11 * unit), 13 * unit, 13 * unit,
                          opaque(swatches[i].color));
        const bool isLast = i + 1 == most && swatches.size() > most;
        overlay.text(x + 22 * unit, line,
                     isLast ? fmt::format("and {} more", swatches.size() - i) : swatches[i].name,
                     bright);
    }
}

}  // namespace spindrift
