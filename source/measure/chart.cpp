#include "measure/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {
namespace {

constexpr double Width = 720, Height = 460, Left = 78, Right = 24, Top = 44, Bottom = 58;
// Colours that colour-blind eyes tell apart (Okabe and Ito).
constexpr const char* Colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
    std::string out;
    for (char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else
            out += c;
    }
    return out;
}

// Values to pixels along one axis, and where its ticks are.
struct Scale {
    bool log = false;
    double low = 0, high = 1, from = 0, to = 1;
    std::vector<double> ticks;

    bool shows(double v) const { return std::isfinite(v) && (!log || v > 0); }
    double map(double v) const { return log ? std::log10(v) : v; }
    double pixel(double v) const { return from + (map(v) - low) / (high - low) * (to - from); }
};

// About six of 1, 2 or 5 times a power of ten.
std::vector<double> roundNumbers(double low, double high) {
    const double rough = (high - low) / 6, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = rough <= power       ? power
                        : rough <= 2 * power ? 2 * power
                        : rough <= 5 * power ? 5 * power
                                             : 10 * power;
    std::vector<double> ticks;
    for (double v = std::ceil(low / step) * step; v <= high + 1e-9 * step; v += step)
        ticks.push_back(std::abs(v) < 1e-9 * step ? 0 : v);
    return ticks;
}
// Logarithms of powers of ten, in short ranges of 2 and 5 times them too.
std::vector<double> decades(double low, double high) {
    std::vector<double> ticks;
    for (double power = std::floor(low); power <= high; ++power)
        for (double m : {1.0, 2.0, 5.0})
            if (const double v = power + std::log10(m);
                v >= low && v <= high && (m == 1 || high - low < 3))
                ticks.push_back(v);
    return ticks;
}

Scale scaleOf(const Chart& chart, bool vertical) {
    Scale s;
    s.log = vertical ? chart.logY : chart.logX;
    s.from = vertical ? Height - Bottom : Left, s.to = vertical ? Top : Width - Right;
    double low = 1e300, high = -1e300;
    for (const Curve& c : chart.curves)
        for (double v : vertical ? c.y : c.x)
            if (s.shows(v)) low = std::min(low, s.map(v)), high = std::max(high, s.map(v));
    if (low > high) low = 0, high = 1;
    if (high - low < 1e-12 * std::max(1.0, std::abs(high))) low -= 0.5, high += 0.5;
    s.low = vertical ? low - 0.04 * (high - low) : low,
    s.high = vertical ? high + 0.04 * (high - low) : high;
    s.ticks = s.log ? decades(s.low, s.high) : roundNumbers(s.low, s.high);
    return s;
}

std::string axis(const Scale& s, bool vertical, const std::string& label) {
    std::string out;
    for (double tick : s.ticks) {
        const double at = s.from + (tick - s.low) / (s.high - s.low) * (s.to - s.from);
        const std::string text = fmt::format("{:.3g}", s.log ? std::pow(10, tick) : tick);
        out += vertical ? fmt::format(
                              "<path d='M{} {:.1f}H{}' class='grid'/><text x='{}' y='{:.1f}' "
                              "text-anchor='end'>{}</text>\n",
                              Left, at, Width - Right, Left - 8, at + 4, text)
                        : fmt::format(
                              "<path d='M{:.1f} {}V{}' class='grid'/><text x='{:.1f}' y='{}' "
                              "text-anchor='middle'>{}</text>\n",
                              at, Top, Height - Bottom, at, Height - Bottom + 18, text);
    }
    out +=
        vertical
            ? fmt::format(
                  "<text transform='translate(18 {}) rotate(-90)' text-anchor='middle'>{}</text>\n",
                  (Top + Height - Bottom) / 2, escaped(label))
            : fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>\n",
                          (Left + Width - Right) / 2, Height - 16, escaped(label));
    return out;
}

std::string drawn(const Curve& c, const Scale& x, const Scale& y, const char* color) {
    std::string points, dots;
    for (size_t i = 0; i < std::min(c.x.size(), c.y.size()); ++i) {
        if (!x.shows(c.x[i]) || !y.shows(c.y[i])) continue;
        const double px = x.pixel(c.x[i]), py = y.pixel(c.y[i]);
        points += fmt::format("{:.1f},{:.1f} ", px, py);
        dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3'/>", px, py);
    }
    if (c.style == Curve::Points) return fmt::format("<g fill='{}'>{}</g>\n", color, dots);
    return fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='2'{}/>\n",
                       points, color, c.style == Curve::Dashed ? " stroke-dasharray='7 5'" : "");
}

// Small words beside points: the first of some places around each where they cover nothing that is
// written already.
struct Labels {
    struct Box {
        double left, top, right, bottom;
    };
    std::vector<Box> taken;

    bool free(const Box& b) const {
        return b.left > Left && b.right < Width - Right && b.top > Top &&
               b.bottom < Height - Bottom &&
               std::none_of(taken.begin(), taken.end(), [&](const Box& o) {
                   return b.left < o.right && o.left < b.right && b.top < o.bottom &&
                          o.top < b.bottom;
               });
    }
    std::string put(const std::string& text, double x, double y) {
        const double width = 5.2 * double(text.size());
        for (double away : {0.0, 12.0, 24.0, 36.0, 48.0, 60.0, 80.0})
            for (const auto& [dx, dy] : {std::pair{6.0, 12.0 + away},
                                         {6.0, -4.0 - away},
                                         {-6.0 - width, 12.0 + away},
                                         {-6.0 - width, -4.0 - away}}) {
                const Box b{x + dx, y + dy - 9, x + dx + width, y + dy + 2};
                if (!free(b)) continue;
                taken.push_back(b);
                return fmt::format(
                    "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='#999' "
                    "stroke-width='0.6'/><text x='{:.1f}' y='{:.1f}' font-size='10'>{}</text>\n",
                    x, y, dx > 0 ? b.left : b.right, y + dy - 3, x + dx, y + dy, escaped(text));
            }
        return "";
    }
    std::string beside(const Curve& c, const Scale& x, const Scale& y) {
        std::string out;
        for (size_t i = 0; i < std::min({c.x.size(), c.y.size(), c.labels.size()}); ++i)
            if (x.shows(c.x[i]) && y.shows(c.y[i]))
                out += put(c.labels[i], x.pixel(c.x[i]), y.pixel(c.y[i]));
        return out;
    }
};

// Names of curves that have one, on white, in the upper right corner.
std::string legend(const Chart& chart) {
    size_t longest = 0;
    for (const Curve& c : chart.curves) longest = std::max(longest, c.name.size());
    const double left =
        std::max(Left + 30, Width - Right - 7.2 * double(longest));  // where names begin
    double row = Top + 18;
    std::string keys;
    for (size_t k = 0; k < chart.curves.size(); ++k) {
        const Curve& c = chart.curves[k];
        const char* color = Colors[k % std::size(Colors)];
        if (c.name.empty()) continue;
        keys += c.style == Curve::Points
                    ? fmt::format("<circle cx='{}' cy='{}' r='3' fill='{}'/>", left - 20, row - 4,
                                  color)
                    : fmt::format("<path d='M{} {}h24' stroke='{}' stroke-width='2'{}/>", left - 32,
                                  row - 4, color,
                                  c.style == Curve::Dashed ? " stroke-dasharray='7 5'" : "");
        keys += fmt::format("<text x='{}' y='{}'>{}</text>\n", left, row, escaped(c.name));
        row += 18;
    }
    return fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='white' opacity='0.8'/>\n",
                       left - 36, Top + 2, Width - Right - left + 36, row - Top - 14) +
           keys;
}

}  // namespace

std::string svg(const Chart& chart) {
    const Scale x = scaleOf(chart, false), y = scaleOf(chart, true);
    std::string out = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
        "font-family='sans-serif' font-size='13'>\n<style>.grid{{stroke:#ddd;fill:none}}</style>\n"
        "<rect width='100%' height='100%' fill='white'/>\n<text x='{2}' y='24' "
        "font-size='16'>{3}</text>\n",
        Width, Height, Left, escaped(chart.title));
    out += axis(x, false, chart.xLabel) + axis(y, true, chart.yLabel);
    for (size_t k = 0; k < chart.curves.size(); ++k)
        out += drawn(chart.curves[k], x, y, Colors[k % std::size(Colors)]);
    Labels labels;
    size_t longest = 0, named = 0;
    for (const Curve& c : chart.curves)
        longest = std::max(longest, c.name.size()), named += !c.name.empty();
    labels.taken.push_back({std::max(Left + 30, Width - Right - 7.2 * double(longest)) - 36, Top,
                            Width, Top + 10 + 18 * double(named)});
    out += legend(chart);
    for (const Curve& c : chart.curves) out += labels.beside(c, x, y);
    return out + "</svg>\n";
}

}  // namespace spindrift
