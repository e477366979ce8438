// The time line below picture and panel: what is kept of the run, where it is looked at.
#include "app/window/panel.h"

#include "render/legend.h"

#include <imgui.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace spindrift {

namespace {

constexpr float height = 56, padding = 6, track = 6;  // px at scale 1

// Where times are on the line.
struct Line {
    ImVec2 corner;
    float width;
    double begin, end;  // s
    float at(double time) const {
        return corner.x + width * float((time - begin) / std::max(end - begin, 1e-30));
    }
    double timeAt(float x) const {
        return begin + std::clamp(double((x - corner.x) / width), 0.0, 1.0) * (end - begin);
    }
};

// Moments as they lie, those that would touch each other once.
void drawMoments(const Line& line, const History& history, float scale) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float middle = line.corner.y + 0.5f * ImGui::GetTextLineHeight(),
                half = 0.5f * track * scale;
    list.AddRectFilled({line.corner.x, middle - half}, {line.corner.x + line.width, middle + half},
                       ImGui::GetColorU32(ImGuiCol_ButtonHovered, 0.5f), half);
    float last = -1e9f;
    for (size_t i = 0; i < history.size(); ++i) {
        const float x = line.at(history[i].time());
        if (x - last < 3 * scale) continue;
        list.AddLine({x, middle - half}, {x, middle + half}, ImGui::GetColorU32(ImGuiCol_Text),
                     scale);
        last = x;
    }
}

void drawThumb(const Line& line, double time, bool looksBack, float scale) {
    const float x = line.at(time), middle = line.corner.y + 0.5f * ImGui::GetTextLineHeight();
    const ImU32 color =
        looksBack ? ImGui::GetColorU32(amber()) : ImGui::GetColorU32(ImGuiCol_SliderGrab);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({x - 3 * scale, middle - 8 * scale}, {x + 3 * scale, middle + 8 * scale},
                       color, 2 * scale);
}

// Its ends say their times.
void line(Ui& ui) {
    const History& history = ui.player.history();
    const double now = ui.player.looksBack() ? history.back().time() : ui.player.measurement().time,
                 begin = history.empty() ? now : history[0].time();
    const std::string first = fmt::format("{:.3g} s", begin), last = fmt::format("{:.4g} s", now);
    const float gap = ImGui::GetStyle().ItemSpacing.x,
                room = ImGui::CalcTextSize("0.000e-00 s").x;  // the same whatever they are
    ImGui::TextDisabled("%s", first.c_str());
    ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + room + gap);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Line line{corner, std::max(ImGui::GetContentRegionAvail().x - room - gap, 1.0f), begin,
                    now};
    ImGui::InvisibleButton("line", {line.width, ImGui::GetTextLineHeight()});
    const double pointed = line.timeAt(ImGui::GetIO().MousePos.x);
    if (ImGui::IsItemActive() && !history.empty()) {
        const size_t moment = history.at(pointed);
        if (!ui.player.looksBack() || ui.player.lookedAt() != moment) ui.lookAt(pointed);
    }
    if (ImGui::IsItemHovered() && !history.empty()) {  // above: below are the buttons
        ImGui::SetNextWindowPos({ImGui::GetIO().MousePos.x, corner.y - 4 * ui.scale},
                                ImGuiCond_Always, {0.5f, 1});
        ImGui::SetTooltip("%.4g s", history[history.at(pointed)].time());
    }
    drawMoments(line, history, ui.scale);
    drawThumb(line, ui.player.measurement().time, ui.player.looksBack(), ui.scale);
    ImGui::SameLine(0, gap);
    ImGui::TextDisabled("%s", last.c_str());
}

// Whether an item as wide as this label, and so many pixels more, has room behind the last one;
// what hasn't is left out, its key does the same.
bool follows(const char* label, float more) {
    ImGui::SameLine();
    const float left =
        ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x - ImGui::GetCursorPosX();
    return ImGui::CalcTextSize(label).x + more <= left;
}

bool button(const char* label, const char* tip) {
    const bool pressed = ImGui::Button(label);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", tip);
    return pressed;
}

void buttons(Ui& ui) {
    const float frame = 2 * ImGui::GetStyle().FramePadding.x,
                box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    if (button(ui.replay.playing ? "Pause" : "Play ", "P: plays the moments that are kept"))
        ui.playMoments();
    if (follows("loop", box)) {
        ImGui::Checkbox("loop", &ui.replay.loops);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("L: again and again");
    }
    if (follows("even", box)) {
        ImGui::Checkbox("even", &ui.replay.isEven);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%g moments a second,\ninstead of view.speed times real time",
                              Replay::evenRate);
    }
    ImGui::BeginDisabled(!ui.player.looksBack());
    if (follows("Go on here", frame) &&
        button("Go on here", "Enter: the run goes on from this moment,\nwhat came after it goes"))
        ui.goOnFromHere();
    if (follows("Back to now", frame) && button("Back to now", "Esc: where the run has come to"))
        ui.returnToPresent();
    ImGui::EndDisabled();
    const History& history = ui.player.history();
    const std::string kept =
        fmt::format("{} moments, {:.3g} of {:g} MB", history.size(), 1e-6 * double(history.bytes()),
                    ui.player.scene.view.history);
    if (follows(kept.c_str(), 0)) {
        ImGui::SetCursorPosX(ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x -
                             ImGui::CalcTextSize(kept.c_str()).x);
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", kept.c_str());
    }
}

}  // namespace

int timeLineHeight(const Ui& ui) {
    const bool isWanted = ui.player.scene.view.history > 0 && ui.showPanel;
    return isWanted || ui.player.looksBack() ? int(height * ui.scale) : 0;
}

void showTimeLine(Ui& ui, int windowHeight) {
    const int size = timeLineHeight(ui);
    if (size == 0) return;
    ImGui::SetNextWindowPos({0, float(windowHeight - size)});
    ImGui::SetNextWindowSize({float(ui.area.x + ui.area.width), float(size)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * ui.scale, padding * ui.scale});
    ImGui::Begin("time line", nullptr, fixedWindow);
    line(ui);
    buttons(ui);
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace spindrift
