#include "app/window/panel.h"

#include "render/legend.h"

#include <imgui.h>

#include <fmt/format.h>

#include <algorithm>

namespace spindrift {

namespace {

// Where a plot's data are on the screen, and which.
struct Axes {
    ImVec2 corner, size;
    float xMin, xMax, yMin, yMax;

    ImVec2 at(float x, float y) const {
        return {corner.x + size.x * (x - xMin) / (xMax - xMin),
                corner.y + size.y * (1 - (y - yMin) / (yMax - yMin))};
    }
};

void drawCurve(const Axes& axes, const std::vector<float>& x, const Curve& curve) {
    std::vector<ImVec2> points;
    for (size_t i = 0; i < x.size(); ++i) points.push_back(axes.at(x[i], curve.y[i]));
    ImGui::GetWindowDrawList()->AddPolyline(points.data(), int(points.size()), curve.color, 0,
                                            1.6f);
}

// Lines at round numbers, which stand beside them.
void drawGrid(const Axes& axes) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 line = isLight() ? IM_COL32(0, 0, 0, 30) : IM_COL32(255, 255, 255, 24),
                color = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const ImVec2 end{axes.corner.x + axes.size.x, axes.corner.y + axes.size.y};
    const std::vector<double> across = ticks(axes.xMin, axes.xMax, 4),
                              up = ticks(axes.yMin, axes.yMax, 3);
    const auto stepOf = [](const std::vector<double>& marks) {
        return marks.size() > 1 ? marks[1] - marks[0] : 0;
    };
    for (double y : up) {
        const float at = axes.at(axes.xMin, float(y)).y;
        const std::string label = tickLabel(y, stepOf(up));
        const ImVec2 size = ImGui::CalcTextSize(label.c_str());
        list.AddLine({axes.corner.x, at}, {end.x, at}, line);
        list.AddText({axes.corner.x - size.x - 0.3f * size.y, at - 0.5f * size.y}, color,
                     label.c_str());
    }
    for (double x : across) {
        const float at = axes.at(float(x), axes.yMin).x;
        const std::string label = tickLabel(x, stepOf(across)) + (x == across.back() ? " s" : "");
        const ImVec2 size = ImGui::CalcTextSize(label.c_str());
        list.AddLine({at, axes.corner.y}, {at, end.y}, line);
        list.AddText({std::min(at - 0.5f * size.x, end.x - size.x), end.y + 0.1f * size.y}, color,
                     label.c_str());
    }
}

// The title's line, and the curves' names in their colours with their last values.
void drawTitle(const char* title, const char* unit, const std::vector<Curve>& curves) {
    ImGui::TextUnformatted(title);
    ImGui::SameLine();
    ImGui::TextDisabled("%s", unit);
    if (curves.size() == 1) ImGui::SameLine();
    for (const Curve& curve : curves) {
        if (curve.y.empty()) continue;
        const std::string last = fmt::format("{} {:.4g}", curve.name, curve.y.back());
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.color), "%s", last.c_str());
        if (&curve != &curves.back()) ImGui::SameLine();
    }
}

void showValues(const Axes& axes, const char* unit, const std::vector<float>& x,
                const std::vector<Curve>& curves) {
    const float share = (ImGui::GetIO().MousePos.x - axes.corner.x) / axes.size.x;
    const float wanted = axes.xMin + share * (axes.xMax - axes.xMin);
    const size_t i =
        std::min(size_t(std::lower_bound(x.begin(), x.end(), wanted) - x.begin()), x.size() - 1);
    std::string tip = fmt::format("{:.4g} s", x[i]);
    for (const Curve& curve : curves)
        tip += fmt::format("\n{}{}{:.4g} {}", curve.name, *curve.name ? " " : "", curve.y[i], unit);
    ImGui::SetTooltip("%s", tip.c_str());
}

}  // namespace

void plot(const char* title, const char* unit, const std::vector<float>& x,
          std::optional<double> shown, std::vector<Curve> curves) {
    float yMin = 0, yMax = 0;
    for (const Curve& curve : curves)
        for (float y : curve.y) yMin = std::min(yMin, y), yMax = std::max(yMax, y);
    if (!(yMax > yMin)) yMax = yMin + 1;
    drawTitle(title, unit, curves);
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, 5.4f * line};
    const Axes axes{{corner.x + 3.6f * line, corner.y + 0.5f * line},
                    {size.x - 4.2f * line, size.y - 1.8f * line},
                    x.empty() ? 0 : x.front(),
                    x.size() < 2 ? (x.empty() ? 1 : x.front() + 1) : x.back(),
                    yMin,
                    yMax};
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                                              ImGui::GetColorU32(ImGuiCol_FrameBg), 4);
    drawGrid(axes);
    for (const Curve& curve : curves) drawCurve(axes, x, curve);
    if (shown && *shown <= double(axes.xMax))
        ImGui::GetWindowDrawList()->AddLine(axes.at(float(*shown), yMin),
                                            axes.at(float(*shown), yMax),
                                            ImGui::GetColorU32(amber()), 1.5f);
    ImGui::Dummy(size);
    if (ImGui::IsItemHovered() && !x.empty()) showValues(axes, unit, x, curves);
}

}  // namespace spindrift
