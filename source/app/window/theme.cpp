#include "app/window/panel.h"

#include "render/font.h"

#include <imgui.h>

#include <cmath>
#include <string>

namespace spindrift {

namespace {

void setDarkColors(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    ImVec4* c = style.Colors;
    const ImVec4 accent{0.26f, 0.56f, 0.86f, 1}, field{0.17f, 0.19f, 0.23f, 1};
    const auto faded = [](ImVec4 color, float alpha) {
        return ImVec4{color.x, color.y, color.z, alpha};
    };
    // Nothing shows through: there is no picture behind the panel, only the panel of before.
    c[ImGuiCol_WindowBg] = {0.086f, 0.096f, 0.118f, 1};
    c[ImGuiCol_PopupBg] = {0.11f, 0.12f, 0.15f, 1};
    c[ImGuiCol_Text] = {0.91f, 0.93f, 0.96f, 1};
    c[ImGuiCol_TextDisabled] = {0.60f, 0.64f, 0.70f, 1};
    c[ImGuiCol_Border] = {1, 1, 1, 0.06f};
    c[ImGuiCol_FrameBg] = field;
    c[ImGuiCol_FrameBgHovered] = {0.21f, 0.24f, 0.29f, 1};
    c[ImGuiCol_FrameBgActive] = {0.24f, 0.28f, 0.34f, 1};
    c[ImGuiCol_SliderGrab] = c[ImGuiCol_CheckMark] = accent;
    c[ImGuiCol_SliderGrabActive] = {0.42f, 0.68f, 0.95f, 1};
    c[ImGuiCol_Button] = field;
    c[ImGuiCol_ButtonHovered] = faded(accent, 0.6f);
    c[ImGuiCol_ButtonActive] = accent;
    c[ImGuiCol_Header] = faded(accent, 0.22f);
    c[ImGuiCol_HeaderHovered] = faded(accent, 0.40f);
    c[ImGuiCol_HeaderActive] = faded(accent, 0.55f);
}

void setLightColors(ImGuiStyle& style) {
    ImGui::StyleColorsLight(&style);
    ImVec4* c = style.Colors;
    c[ImGuiCol_WindowBg] = {0.945f, 0.950f, 0.960f, 1};
    c[ImGuiCol_PopupBg] = {0.985f, 0.985f, 0.99f, 1};
    c[ImGuiCol_Text] = {0.09f, 0.10f, 0.12f, 1};
    c[ImGuiCol_TextDisabled] = {0.36f, 0.39f, 0.44f, 1};
    c[ImGuiCol_FrameBg] = c[ImGuiCol_Button] = {0.855f, 0.870f, 0.895f, 1};
}

}  // namespace

bool isLight() { return ImGui::GetStyle().Colors[ImGuiCol_WindowBg].x > 0.5f; }
ImVec4 amber() { return isLight() ? ImVec4{0.62f, 0.36f, 0, 1} : ImVec4{1.0f, 0.80f, 0.42f, 1}; }
ImVec4 red() { return isLight() ? ImVec4{0.75f, 0.12f, 0.08f, 1} : ImVec4{1.0f, 0.52f, 0.48f, 1}; }

void setUpPanel(float scale, Theme theme) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    ImGuiStyle& style = ImGui::GetStyle();
    style = {};
    theme == Theme::Light ? setLightColors(style) : setDarkColors(style);
    style.WindowRounding = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
    style.WindowPadding = {12, 12};
    style.FramePadding = {7, 4};
    style.ItemSpacing = {8, 5};
    style.ScrollbarSize = 11;
    style.GrabMinSize = 12;
    style.ScaleAllSizes(scale);
    io.Fonts->Clear();
    if (!fontPath().empty())
        io.Fonts->AddFontFromFileTTF(std::string(fontPath()).c_str(), std::round(15 * scale));
}

}  // namespace spindrift
