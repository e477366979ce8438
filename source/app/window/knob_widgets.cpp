// The panel's sliders: one for each live knob of the schema.
#include "app/window/panel.h"

#include "app/window/idle_knobs.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace spindrift {

namespace {

// Ranges over several powers of ten get a logarithmic slider; sides without a bound in practice get
// a drag field.
bool isOpen(const Knob& knob) { return knob.min < 0 && knob.max > 1000; }
ImGuiSliderFlags scaleOf(const Knob& knob) {
    const bool wide = knob.min >= 0 && knob.max > 100;
    return ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
}
// What 0 stands for is shown behind it.
std::string formatOf(const Knob& knob, float value, const std::string& inForce) {
    std::string format = "%.4g";
    if (*knob.unit) format.append(" ").append(knob.unit);
    if (value == 0 && !inForce.empty()) format = "0: " + inForce;
    return format;
}

bool edit(float& value, const Knob& knob, const std::string& inForce) {
    const std::string format = formatOf(knob, value, inForce);
    if (isOpen(knob)) {
        const float speed = 0.005f * std::max(std::abs(value), 0.1f);
        return ImGui::DragFloat("", &value, speed, knob.min, knob.max, format.c_str(),
                                ImGuiSliderFlags_AlwaysClamp);
    }
    return ImGui::SliderFloat("", &value, knob.min, knob.max, format.c_str(), scaleOf(knob));
}

bool edit(int& value, const Knob& knob, const std::string&) {
    if (knob.max > 1e6f) {  // no slider hits one of so many
        const bool changed = ImGui::InputInt("", &value);
        value = std::clamp(value, int(knob.min), int(knob.max));
        return changed;
    }
    return ImGui::SliderInt("", &value, int(knob.min), int(knob.max), "%d", scaleOf(knob));
}

bool edit(bool& value, const Knob&, const std::string&) { return ImGui::Checkbox("", &value); }

bool edit(Keyframes&, const Knob&, const std::string&) { return false; }  // no live knob
bool edit(Rates&, const Knob&, const std::string&) { return false; }      // nor is this
bool edit(Vec3d&, const Knob&, const std::string&) { return false; }      // nor is this
bool edit(std::string& value, const Knob&, const std::string&) {
    return ImGui::InputText("", &value);
}

bool edit(Vec3& value, const Knob& knob, const std::string&) {
    return ImGui::DragFloat3("", &value.x, std::min(0.05f, 0.001f * (knob.max - knob.min)),
                             knob.min, knob.max, "%.3g", ImGuiSliderFlags_AlwaysClamp);
}

template <class E>
requires std::is_enum_v<E>
bool edit(E& value, const Knob&, const std::string&) {
    constexpr auto names = enumNames(E{});
    int chosen = int(value);
    const bool changed = ImGui::Combo("", &chosen, names.data(), int(names.size()));
    value = E(chosen);
    return changed;
}

// "fluid.rest_density" -> "rest density"
std::string labelOf(const std::string& path, const std::string& group) {
    std::string label = path.substr(group.size() + 1);
    std::replace(label.begin(), label.end(), '_', ' ');
    return label;
}

// An arrow that turns back. True when it is clicked.
bool backButton() {
    const float side = ImGui::GetFrameHeight(), radius = 0.26f * side;
    const ImVec2 corner = ImGui::GetCursorScreenPos(),
                 middle{corner.x + side / 2, corner.y + side / 2};
    const bool clicked = ImGui::InvisibleButton("back", {side, side});
    const ImU32 color =
        ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_SliderGrab);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PathArcTo(middle, radius, -2.2f, 2.6f);
    list.PathStroke(color, 0, 0.09f * side);
    const ImVec2 tip{middle.x + radius * std::cos(-2.2f), middle.y + radius * std::sin(-2.2f)};
    list.AddTriangleFilled({tip.x - 0.20f * side, tip.y + 0.04f * side},
                           {tip.x + 0.14f * side, tip.y - 0.14f * side},
                           {tip.x + 0.10f * side, tip.y + 0.18f * side}, color);
    return clicked;
}

}  // namespace

bool editKnobs(Scene& scene, const Scene& loaded, const std::string& group,
               const InForce& inForce) {
    bool changed = false;
    const float widget = 0.50f * ImGui::GetContentRegionAvail().x, button = ImGui::GetFrameHeight();
    visitLiveKnobs(
        scene, loaded,
        [&](const std::string& path, auto& value, const auto& first, const Knob& knob) {
            if (path.substr(0, path.rfind('.')) != group) return;
            ImGui::PushID(path.c_str());
            const std::string idle = whyIdle(scene, path), unit = knob.unit;
            const bool differs = !(value == first);
            const std::string tip =
                fmt::format("{}\n{}{}{}{}", knob.help, path, unit.empty() ? "" : ", ", unit,
                            idle.empty() ? "" : "\nno effect: " + idle);
            ImGui::AlignTextToFramePadding();
            const ImVec4 text =
                ImGui::GetStyle().Colors[idle.empty() ? ImGuiCol_Text : ImGuiCol_TextDisabled];
            ImGui::TextColored(differs ? amber() : text, "%s", labelOf(path, group).c_str());
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip.c_str());
            if (differs) {
                ImGui::SameLine(ImGui::GetContentRegionMax().x - widget - button);
                if (backButton()) value = first, changed = true;
                if (ImGui::IsItemHovered()) ImGui::SetTooltip("as it was loaded");
            }
            ImGui::SameLine(ImGui::GetContentRegionMax().x - widget);
            ImGui::SetNextItemWidth(widget);
            ImGui::BeginDisabled(!idle.empty());
            changed |= edit(value, knob, inForce(path));
            ImGui::EndDisabled();
            if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
                ImGui::SetTooltip("%s", tip.c_str());
            ImGui::PopID();
        });
    return changed;
}

}  // namespace spindrift
