#include "app/window/panel.h"

#include <imgui.h>

#include <fmt/format.h>

#include <algorithm>

namespace spindrift {

namespace {

struct Frame2d {
    ImVec2 corner, size;
    float xMax, yMax;
};

ImVec2 place(const Frame2d& f, float x, float y) {
    return {f.corner.x + f.size.x * (f.xMax > 0 ? x / f.xMax : 0),
            f.corner.y + f.size.y * (1 - (f.yMax > 0 ? y / f.yMax : 0))};
}

void drawCurve(const Frame2d& f, const std::vector<float>& x, const Curve& curve) {
    std::vector<ImVec2> points;
    for (size_t i = 0; i < x.size(); ++i) points.push_back(place(f, x[i], curve.y[i]));
    ImGui::GetWindowDrawList()->AddPolyline(points.data(), int(points.size()), curve.color, 0,
                                            1.6f);
}

// The title's line: name, largest value, and the curves' names in their colours.
void drawTitle(const char* title, const char* unit, float yMax, const std::vector<Curve>& curves) {
    ImGui::TextUnformatted(title);
    ImGui::SameLine();
    ImGui::TextDisabled("%s", fmt::format("up to {:.3g} {}", yMax, unit).c_str());
    if (curves.size() < 2) return;
    for (const Curve& curve : curves) {
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.color), "%s", curve.name);
        ImGui::SameLine();
    }
    ImGui::NewLine();
}

}  // namespace

void plot(const char* title, const char* unit, const std::vector<float>& x,
          std::vector<Curve> curves) {
    float yMax = 0;
    for (const Curve& curve : curves)
        for (float y : curve.y) yMax = std::max(yMax, y);
    drawTitle(title, unit, yMax, curves);
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, 3.4f * line};
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                                              ImGui::GetColorU32(ImGuiCol_FrameBg), 4);
    const Frame2d frame{
        {corner.x + 4, corner.y + 4}, {size.x - 8, size.y - 8}, x.empty() ? 0 : x.back(), yMax};
    for (const Curve& curve : curves) drawCurve(frame, x, curve);
    ImGui::Dummy(size);
    if (ImGui::IsItemHovered() && !x.empty())
        ImGui::SetTooltip("%s", fmt::format("0 to {:.3g} s", x.back()).c_str());
}

}  // namespace spindrift
