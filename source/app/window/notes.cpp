// What the run says at the picture's upper left.
#include "app/window/panel.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace spindrift {

namespace {

// Why the run stands still; "" while it doesn't.
std::string standstillOf(const Ui& ui) {
    if (ui.player.looksBack())
        return fmt::format(
            "looking back at {:.4g} s, step {}; the run stands still\n"
            "Left and Right go through the moments, P plays them, Enter goes on from "
            "here, Esc returns to now",
            ui.player.measurement().time, ui.player.measurement().steps);
    if (!ui.player.halted.empty()) return ui.player.halted;
    return ui.player.running ? "" : "paused: Space runs, Right steps once, Left looks back";
}
std::string recordingOf(const Ui& ui) {
    if (!ui.recording) return "";
    return fmt::format("recording {}: {:.1f} s of film; V ends it",
                       std::filesystem::path(ui.recording->film()).filename().string(),
                       ui.recording->seconds());
}
std::string messageOf(const Ui& ui) { return uiTime() < ui.message.until ? ui.message.text : ""; }

}  // namespace

std::string notesOf(const Ui& ui) { return recordingOf(ui) + standstillOf(ui) + messageOf(ui); }

void showNotes(const Ui& ui) {
    if (notesOf(ui).empty()) return;
    // Over the panel too where the picture is too narrow.
    const float edge = margin * ui.scale, right = float(ui.area.x + ui.area.width) - edge,
                least = 16 * ImGui::GetFontSize(),
                left = std::max(std::min(float(ui.area.x) + edge, right - least), edge);
    ImGui::SetNextWindowPos({left, edge});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {right - left, float(ui.area.height) - 2 * edge});
    ImGui::Begin("notes", nullptr, noteWindow);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    ImGui::PushTextWrapPos(right - left - 2 * edge);
    const std::string standing = standstillOf(ui), recorded = recordingOf(ui), said = messageOf(ui);
    if (!recorded.empty()) {
        const float line = ImGui::GetTextLineHeight();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + 0.4f * line, at.y + 0.5f * line},
                                                    0.35f * line, IM_COL32(225, 45, 35, 255));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 1.2f * line);
        ImGui::TextUnformatted(recorded.c_str());
    }
    const bool isAmber = ui.player.halted.empty() || ui.player.looksBack();
    if (!standing.empty()) ImGui::TextColored(isAmber ? amber() : red(), "%s", standing.c_str());
    if (!said.empty() && ui.message.error)
        ImGui::TextColored(red(), "%s", said.c_str());
    else if (!said.empty())
        ImGui::TextUnformatted(said.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace spindrift
