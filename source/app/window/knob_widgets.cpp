// The panel's sliders: one for each live knob of the schema.
#include "app/window/panel.h"

#include "scene/schema.h"

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
std::string formatOf(const Knob& knob) {
    std::string format = "%.4g";
    if (*knob.unit) format += std::string(" ") + knob.unit;
    return format;
}

bool edit(float& value, const Knob& knob) {
    const std::string format = formatOf(knob);
    if (isOpen(knob)) {
        const float speed = 0.005f * std::max(std::abs(value), 0.1f);
        return ImGui::DragFloat("", &value, speed, knob.min, knob.max, format.c_str(),
                                ImGuiSliderFlags_AlwaysClamp);
    }
    return ImGui::SliderFloat("", &value, knob.min, knob.max, format.c_str(), scaleOf(knob));
}

bool edit(int& value, const Knob& knob) {
    return ImGui::SliderInt("", &value, int(knob.min), int(knob.max), "%d", scaleOf(knob));
}

bool edit(bool& value, const Knob&) { return ImGui::Checkbox("", &value); }

bool edit(Keyframes&, const Knob&) { return false; }   // no live knob
bool edit(std::string& value, const Knob&) { return ImGui::InputText("", &value); }

bool edit(Vec3& value, const Knob& knob) {
    return ImGui::DragFloat3("", &value.x, std::min(0.05f, 0.001f * (knob.max - knob.min)),
                             knob.min, knob.max, "%.3g", ImGuiSliderFlags_AlwaysClamp);
}

template <class E>
requires std::is_enum_v<E>
bool edit(E& value, const Knob&) {
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

}  // namespace

bool editKnobs(Scene& scene, const std::string& group) {
    bool changed = false;
    const float widget = 0.50f * ImGui::GetContentRegionAvail().x;
    visitKnobs(scene, [&](const std::string& path, auto& value, const Knob& knob) {
        if (!knob.live || path.substr(0, path.rfind('.')) != group) return;
        ImGui::PushID(path.c_str());
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(labelOf(path, group).c_str());
        const std::string tip =
            fmt::format("{}\n{}{}{}", knob.help, path, *knob.unit ? ", " : "", knob.unit);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip.c_str());
        ImGui::SameLine(ImGui::GetContentRegionMax().x - widget);
        ImGui::SetNextItemWidth(widget);
        changed |= edit(value, knob);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip.c_str());
        ImGui::PopID();
    });
    return changed;
}

}  // namespace spindrift
