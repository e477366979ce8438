#include "app/window/panel.h"

#include "app/scene_choice.h"
#include "app/window/input.h"

#include <imgui.h>

#include <fmt/format.h>

namespace spindrift {

namespace {

constexpr float width = 340, margin = 12;  // px at scale 1
const ImVec4 red{1.0f, 0.52f, 0.48f, 1}, amber{1.0f, 0.80f, 0.42f, 1};

template <class... T>
void text(fmt::format_string<T...> format, T&&... values) {
    ImGui::TextUnformatted(fmt::format(format, std::forward<T>(values)...).c_str());
}

template <class... T>
void row(const char* name, fmt::format_string<T...> format, T&&... values) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(0.42f * ImGui::GetContentRegionMax().x);
    text(format, std::forward<T>(values)...);
}

void sceneList(Ui& ui) {
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##scene", ui.player.scene.name.c_str(), ImGuiComboFlags_HeightLarge))
        return;
    for (const std::string& name : ui.scenes)
        if (ImGui::Selectable(name.c_str())) ui.load(findScene(name));
    ImGui::EndCombo();
}

void transport(Ui& ui) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 third{(ImGui::GetContentRegionAvail().x - 2 * gap) / 3, 0};
    if (ImGui::Button(ui.player.running ? "Pause" : "Run", third)) ui.toggleRun();
    ImGui::SameLine();
    if (ImGui::Button("Step", third)) ui.player.stepOnce();
    ImGui::SameLine();
    if (ImGui::Button("Reset", third)) ui.reset();
    if (ImGui::Button("Save checkpoint", {-1, 0})) ui.saveCheckpoint();
}

void status(const Ui& ui) {
    const Measurement& m = ui.player.measurement();
    row("device", "{}", ui.device.substr(0, ui.device.find(',')));
    row("particles", "{} + {} walls", ui.fluidCount, ui.wallCount);
    row("time", "{:.4f} s", m.time);
    row("time step", "{:.3g} ms", 1e3 * m.dt);
    row("steps", "{}, {:.0f} a second", m.steps, ui.player.stepsPerSecond());
    row("speed", "{:.2f} x real time", ui.player.realTimeFactor());
    row("fastest particle", "{:.3g} m/s", m.maxSpeed);
    row("drawing", "{:.1f} ms a picture", ui.drawMs);
}

void passTimes(const Ui& ui) {
    double sum = 0;
    for (const PassTime& t : ui.times) {
        const double each = t.runs > 0 ? t.ms / double(t.runs) : 0;
        row(t.name, "{:.3f} ms", each);
        sum += each;
    }
    row("together", "{:.3f} ms", sum);
}

void curves(const Ui& ui) {
    const History& h = ui.player.history();
    plot("energy", "J", h.time,
         {{"total", h.total, IM_COL32(240, 240, 245, 255)},
          {"kinetic", h.kinetic, IM_COL32(96, 180, 255, 255)},
          {"potential", h.potential, IM_COL32(255, 190, 90, 255)}});
    plot("density error", "", h.time, {{"", h.densityError, IM_COL32(120, 220, 150, 255)}});
}

// Disabled with its reason as tooltip, as long as there is no GPU.
void backend(Ui& ui) {
    ImGui::BeginDisabled(!ui.noGpu.empty());
    if (ImGui::Button(ui.onGpu ? "Run on the CPU" : "Run on the GPU", {-1, 0})) ui.switchBackend();
    ImGui::EndDisabled();
    if (!ui.noGpu.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", ui.noGpu.c_str());
}

bool section(const char* title, bool open = false) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void knobs(Ui& ui) {
    bool physics = false;
    if (section("View", true) && editKnobs(ui.player.scene, "view")) ui.stale = ui.rewrite = true;
    if (section("Camera") && editKnobs(ui.player.scene, "view.camera")) ui.stale = true;
    if (section("Fluid", true)) physics |= editKnobs(ui.player.scene, "fluid");
    if (section("Forces")) physics |= editKnobs(ui.player.scene, "simulation");
    if (section("Walls")) physics |= editKnobs(ui.player.scene, "walls");
    if (section("Time")) physics |= editKnobs(ui.player.scene, "time");
    if (section("Window") && editKnobs(ui.player.scene, "window")) ui.stale = true;
    if (physics) ui.player.knobsChanged();
}

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoNav;
constexpr ImGuiWindowFlags note =
    fixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing;

void panel(Ui& ui, int windowHeight) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({float(panelWidth(ui)), float(windowHeight)});
    ImGui::Begin("panel", nullptr, fixed);
    sceneList(ui);
    transport(ui);
    ImGui::Spacing();
    status(ui);
    ImGui::Spacing();
    if (section("Curves", true)) curves(ui);
    knobs(ui);
    if (section("Time per pass")) passTimes(ui);
    if (section("Machine", true)) {
        ImGui::PushTextWrapPos();
        text("{}", ui.device);
        text("{}", ui.glRenderer);
        if (ui.frame.copiesVertices()) text("vertices are copied: another device draws");
        ImGui::PopTextWrapPos();
        backend(ui);
    }
    ImGui::TextDisabled("H shows keys and mouse");
    ImGui::End();
}

void help(const Ui& ui) {
    ImGui::SetNextWindowPos(
        {float(ui.area.x) + 0.5f * float(ui.area.width), 0.5f * float(ui.area.height)},
        ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("help", nullptr, note);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit))
        for (const Control& control : controls) {
            ImGui::TableNextColumn();
            ImGui::TextColored(amber, "%s", control.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(control.action);
        }
    ImGui::EndTable();
    ImGui::End();
}

// What the run says at the picture's upper left: why it stands still, and the last message.
void notes(Ui& ui) {
    const bool message = uiTime() < ui.message.until;
    if (ui.player.running && !message) return;
    const float edge = margin * ui.scale;
    ImGui::SetNextWindowPos({float(ui.area.x) + edge, edge});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {float(ui.area.width) - 2 * edge, 1e4f});
    ImGui::Begin("notes", nullptr, note);
    ImGui::PushTextWrapPos(float(ui.area.width) - 4 * edge);
    if (!ui.player.halted.empty())
        ImGui::TextColored(red, "%s", ui.player.halted.c_str());
    else if (!ui.player.running)
        ImGui::TextColored(amber, "paused: Space runs, Right steps once");
    if (message && ui.message.error)
        ImGui::TextColored(red, "%s", ui.message.text.c_str());
    else if (message)
        ImGui::TextUnformatted(ui.message.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void pickedParticle(Ui& ui) {
    if (!ui.picked) return;
    const Particle& p = *ui.picked;
    const float edge = margin * ui.scale;
    ImGui::SetNextWindowPos({float(ui.area.x + ui.area.width) - edge, edge}, ImGuiCond_Always,
                            {1, 0});
    ImGui::SetNextWindowSize({310 * ui.scale, 0});
    ImGui::Begin("particle", nullptr, note);
    ImGui::TextColored(red, "particle %d", p.id);
    row("position", "{:.4f}  {:.4f}  {:.4f} m", p.position.x, p.position.y, p.position.z);
    row("velocity", "{:.3f}  {:.3f}  {:.3f} m/s", p.velocity.x, p.velocity.y, p.velocity.z);
    row("speed", "{:.4g} m/s", length(p.velocity));
    row("density", "{:.5g} kg/m³", p.density);
    row("pressure", "{:.4g} Pa", p.pressure);
    ImGui::End();
}

}  // namespace

int panelWidth(const Ui& ui) { return ui.showPanel ? int(width * ui.scale) : 0; }

void showPanel(Ui& ui, int windowHeight) {
    if (ui.showPanel) panel(ui, windowHeight);
    notes(ui);
    pickedParticle(ui);
    if (ui.showHelp) help(ui);
}

}  // namespace spindrift
