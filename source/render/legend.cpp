#include "render/legend.h"

#include "render/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {

double tickStep(double span, int count) {
    const double power = std::pow(10.0, std::floor(std::log10(span / count)));
    for (double factor : {1.0, 2.0, 5.0})
        if (span / (factor * power) <= count) return factor * power;
    return 10 * power;
}

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

std::vector<double> logarithmicTicks(double min, double max, bool dense, int stride) {
    std::vector<double> found;
    const auto lowest = int(std::floor(std::log10(min))), highest = int(std::ceil(std::log10(max)));
    for (int power = lowest; power <= highest; ++power)
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * std::pow(10.0, power);
            if ((factor > 1 && !dense) || power % stride != 0) continue;
            if (value >= (1 - 1e-6) * min && value <= (1 + 1e-6) * max) found.push_back(value);
        }
    return found;
}

namespace {

// Choices of marks, those with most of them first.
std::vector<std::vector<double>> choicesOf(double min, double max, bool logarithmic) {
    std::vector<std::vector<double>> choices;
    if (logarithmic) choices.push_back(logarithmicTicks(min, max, true, 1));
    for (int k = 1; k <= 5; ++k)
        choices.push_back(logarithmic ? logarithmicTicks(min, max, false, k)
                                      : ticks(min, max, 6 - k));
    return choices;
}

}  // namespace

std::vector<Mark> fittingMarks(double min, double max, bool logarithmic, float bar, float overhang,
                               const std::function<float(std::string_view)>& widthOf) {
    std::vector<Mark> marks;
    const auto scaled = [&](double value) { return logarithmic ? std::log(value) : value; };
    // Where fewer than two of 1, 2 and 5 times a power of ten are in the range it has even marks.
    const bool byPowers =
        logarithmic && max > min && logarithmicTicks(min, max, true, 1).size() > 1;
    for (const std::vector<double>& values : choicesOf(min, max, byPowers)) {
        const double step = values.size() > 1 && !byPowers ? values[1] - values[0] : 0;
        marks.clear();
        bool fits = true;
        float end = -1e9f;  // of the label before
        for (double value : values) {
            const std::string label = tickLabel(value, step);
            const double share = (scaled(value) - scaled(min)) / (scaled(max) - scaled(min));
            const float half = 0.5f * widthOf(label), at = bar * (max > min ? float(share) : 0);
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

Ink inkOf(Theme theme) {
    if (theme == Theme::Light)
        return {{0.08f, 0.09f, 0.11f}, {0.34f, 0.37f, 0.42f}, {0.99f, 0.99f, 1, 0.72f}};
    return {{0.94f, 0.95f, 0.97f}, {0.66f, 0.69f, 0.74f}, {0.04f, 0.05f, 0.07f, 0.62f}};
}

namespace {

Rgba opaque(const std::array<uint8_t, 3>& c) {
    return {c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f};
}

// The box, so many units high, its title, and the first of the notes for which there is room. At
// the lower left: the tank's near corner stands at the lower right of the first view.
struct Box {
    float unit, x, top, bar;
};
Box drawBox(Overlay& overlay, int width, int height, float units, const LegendText& text,
            const Ink& ink, const std::vector<std::string>& notes) {
    const float unit = unitOf(width, height);
    overlay.textSize(14 * unit);
    const float pad = 14 * unit, bar = std::min(270 * unit, 0.6f * float(width)),
                boxHeight = units * unit;
    const float left = 16 * unit, top = float(height) - boxHeight - 16 * unit;
    overlay.panel(left, top, bar + 2 * pad + 12 * unit, boxHeight, 8 * unit, ink.panel);
    const float x = std::round(left + pad + 6 * unit), titleLine = top + 23 * unit;
    overlay.text(x, titleLine, text.title, ink.bright);
    overlay.text(x + overlay.textWidth(text.title + " "), titleLine, text.unit, ink.dim);
    const float titleWidth = overlay.textWidth(text.title + " " + text.unit + " ");
    for (const std::string& note : notes) {
        if (titleWidth + overlay.textWidth(note) > bar) continue;
        overlay.text(x + bar - overlay.textWidth(note), titleLine, note, ink.dim);
        break;
    }
    return {unit, x, top, bar};
}

}  // namespace

void drawLegend(Overlay& overlay, int width, int height, const LegendText& text, const Ink& ink,
                const ColorBar& colors) {
    const std::vector<std::string> notes{std::string(colors.name) + ", " + text.note, text.note};
    const auto [unit, x, top, bar] = drawBox(overlay, width, height, 80, text, ink, notes);
    const ColorTable& table = colors.table;
    const float barTop = std::round(top + 34 * unit), thick = 12 * unit;
    for (size_t i = 0; i < table.size(); ++i) {
        const float from = std::round(bar * float(i) / 256),
                    to = std::round(bar * float(i + 1) / 256);
        overlay.rectangle(x + from, barTop, to - from, thick, opaque(table[i]));
    }
    const auto widthOf = [&](std::string_view label) { return overlay.textWidth(label); };
    for (const Mark& mark :
         fittingMarks(colors.min, colors.max, colors.logarithmic, bar, 12 * unit, widthOf)) {
        const float tick = std::round(x + mark.at);
        overlay.rectangle(tick - std::round(unit) / 2, barTop + thick,
                          std::max(1.0f, std::round(unit)), 5 * unit, ink.dim);
        overlay.text(x + mark.middle - 0.5f * overlay.textWidth(mark.label),
                     barTop + thick + 19 * unit, mark.label, ink.bright);
    }
}

void drawLegend(Overlay& overlay, int width, int height, const LegendText& text, const Ink& ink,
                const std::vector<Swatch>& swatches) {
    constexpr size_t most = 12;
    const size_t shown = std::min(swatches.size(), most);
    const auto [unit, x, top, bar] =
        drawBox(overlay, width, height, 36 + 22 * float(shown), text, ink, {text.note});
    for (size_t i = 0; i < shown; ++i) {
        const float line = top + (46 + 22 * float(i)) * unit;
        overlay.rectangle(x, std::round(line - 11 * unit), 13 * unit, 13 * unit,
                          opaque(swatches[i].color));
        const bool isLast = i + 1 == most && swatches.size() > most;
        overlay.text(x + 22 * unit, line,
                     isLast ? fmt::format("and {} more", swatches.size() - i) : swatches[i].name,
                     ink.bright);
    }
}

void drawScale(Overlay& overlay, int width, int height, const Ink& ink, float metres, float cell) {
    const float unit = unitOf(width, height), right = float(width) - 124 * unit,
                line = float(height) - 30 * unit;
    overlay.textSize(14 * unit);
    const double length = tickStep(150 * double(unit * metres), 2);
    const float bar = std::round(float(length) / metres), x = std::round(right - bar),
                thick = std::max(1.0f, std::round(1.5f * unit));
    const std::string label = fmt::format("{:g} m", length);
    overlay.rectangle(x, line, bar, thick, ink.bright);
    for (const float end : {x, x + bar - thick})
        overlay.rectangle(end, line - 5 * unit, thick, 5 * unit + thick, ink.bright);
    overlay.text(right - bar / 2 - overlay.textWidth(label) / 2, line - 8 * unit, label,
                 ink.bright);
    if (cell <= 0) return;
    const std::string cells = fmt::format("grid {:g} m", cell);
    overlay.text(right - overlay.textWidth(cells), line + 19 * unit, cells, ink.dim);
}

}  // namespace spindrift
