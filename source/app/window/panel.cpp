#include "app/window/panel.h"

#include "app/scene_choice.h"
#include "app/window/input.h"

#include "core/error.h"
#include "scene/check_view.h"
#include "scene/mass.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

namespace spindrift {

namespace {

constexpr float width = 340;  // px at scale 1

template <class... T> void text(fmt::format_string<T...> format, T&&... values) {
    ImGui::TextUnformatted(fmt::format(format, std::forward<T>(values)...).c_str());
}

template <class... T> void row(const char* name, fmt::format_string<T...> format, T&&... values) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(8.8f * ImGui::GetFontSize());
    text(format, std::forward<T>(values)...);
}

void readTitles(Ui& ui) {
    if (!ui.scenes.empty()) return;
    for (const std::string& name : shippedScenes()) {
        const std::string file = findScene(name);
        ui.scenes.push_back({name, file, titleOfFile(file)});
    }
}

// Scenes and checkpoints of the folder of what is typed.
void folderList(Ui& ui) {
    namespace fs = std::filesystem;
    ImGui::SetNextItemWidth(-1);
    const bool entered =
        ImGui::InputTextWithHint("##file", "a path: scene or checkpoint", &ui.typedFile,
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    const fs::path typed = ui.typedFile;
    std::error_code none;
    const fs::path folder = fs::is_directory(typed, none) ? typed
                            : typed.has_parent_path()     ? typed.parent_path()
                                                          : fs::path(".");
    std::vector<fs::path> found;
    for (const auto& entry :
         fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, none)) {
        const std::string kind = entry.path().extension().string();
        const bool hidden = entry.path().filename().string().starts_with(".");
        if (!hidden && (entry.is_directory(none) || kind == ".json" || kind == ".h5"))
            found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    ImGui::BeginChild("folder", {0, 7 * ImGui::GetTextLineHeightWithSpacing()}, true);
    const fs::path here = fs::absolute(folder, none).lexically_normal();
    const fs::path parent =
        here.has_filename() ? here.parent_path() : here.parent_path().parent_path();
    if (ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups))
        ui.typedFile = (parent / "").string();
    for (const fs::path& path : found) {
        const bool inside = fs::is_directory(path, none);
        if (!ImGui::Selectable((path.filename().string() + (inside ? "/" : "")).c_str(), false,
                               ImGuiSelectableFlags_DontClosePopups))
            continue;
        ui.typedFile = inside ? (path / "").string() : path.string();
        if (!inside) ui.load(ui.typedFile), ImGui::CloseCurrentPopup();
    }
    ImGui::EndChild();
    if (entered && !ui.typedFile.empty()) ui.load(ui.typedFile), ImGui::CloseCurrentPopup();
}

void sceneList(Ui& ui) {
    ImGui::SetNextItemWidth(-1);
    ui.popupOpen = ImGui::BeginCombo("##scene", titleOf(ui.player.scene).c_str(),
                                     ImGuiComboFlags_HeightLargest);
    if (!ui.popupOpen) return;
    readTitles(ui);
    const float lines = float(std::min<size_t>(ui.scenes.size(), 20));
    ImGui::BeginChild("shipped", {0, lines * ImGui::GetTextLineHeightWithSpacing()});
    for (const SceneEntry& scene : ui.scenes) {
        const bool current = scene.file == ui.player.file();
        if (ImGui::Selectable(fmt::format("{}##{}", scene.title, scene.name).c_str(), current))
            ui.load(scene.file), ImGui::CloseCurrentPopup();
        if (current && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
        ImGui::SameLine(0.55f * ImGui::GetContentRegionMax().x);
        ImGui::TextDisabled("%s", scene.name.c_str());
    }
    ImGui::EndChild();
    ImGui::Separator();
    folderList(ui);
    if (ui.closePopups) ImGui::CloseCurrentPopup();
    ImGui::EndCombo();
}

void transport(Ui& ui) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 third{(ImGui::GetContentRegionAvail().x - 2 * gap) / 3, 0};
    ImGui::BeginDisabled(ui.player.looksBack());
    if (ImGui::Button(ui.player.running ? "Pause" : "Run", third)) ui.toggleRun();
    ImGui::SameLine();
    if (ImGui::Button("Step", third)) ui.player.stepOnce();
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Reset", third)) ui.reset();
    const ImVec2 half{(ImGui::GetContentRegionAvail().x - gap) / 2, 0};
    if (ImGui::Button("Save checkpoint", half)) ui.saveCheckpoint();
    ImGui::SameLine();
    if (ImGui::Button(ui.recording ? "End recording" : "Record", half)) ui.toggleRecording();
}

void rememberPopup(Ui& ui) {
    ui.popupOpen =
        ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    if (std::exchange(ui.closePopups, false) && ui.popupOpen) ImGui::ClosePopupToLevel(0, true);
}

// How fast it plays, in large letters, and how fast it is asked to.
void speed(Ui& ui) {
    const double factor = ui.player.realTimeFactor();
    float& wanted = ui.player.scene.view.speed;
    const bool late = ui.player.running && factor < 0.9 * double(wanted);
    ImGui::SetWindowFontScale(1.5f);
    const std::string shown = ui.player.running       ? fmt::format("{:.2g} x", factor)
                              : ui.player.looksBack() ? "past"
                                                      : "paused";
    ImGui::TextColored(
        late || !ui.player.running ? amber() : ImGui::GetStyle().Colors[ImGuiCol_Text], "%s",
        shown.c_str());
    ImGui::SetWindowFontScale(1);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("real time; wanted %.3g x", double(wanted));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat("##speed", &wanted, 0.01f, 10, "",  // its number would hide behind the grab
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "view.speed, keys - and +: slow motion and fast motion\nin amber: this computer can't "
            "keep up");
}

void status(Ui& ui) {
    const Measurement& m = ui.player.measurement();
    speed(ui);
    row("method", "{}", enumNames(Formulation{})[size_t(ui.player.scene.simulation.formulation)]);
    row("time", "{:.4f} s", m.time);
    row("steps", "{}, {:.0f} a second", m.steps, ui.player.stepsPerSecond());
    row("time step", "{:.3g} ms", 1e3 * m.dt);
    row("particles", "{} + {} walls", ui.fluidCount, ui.wallCount);
    row("fastest particle", "{:.3g} m/s", m.maxSpeed);
    if (m.solvesPressure)
        row("pressure", "{} iterations", m.solve.iterations);
    else
        row("speed of sound", "{:.3g} m/s", m.soundSpeed);
    row("device", "{}", ui.device.substr(0, ui.device.find(',')));
    row("drawing", "{:.1f} ms a picture", ui.drawMs);
    if (ui.player.remarks().empty()) return;
    ImGui::PushTextWrapPos();
    ImGui::TextColored(amber(), "outside what the method is valid for:");
    for (const Remark& r : ui.player.remarks()) ImGui::TextUnformatted(r.text.c_str());
    ImGui::PopTextWrapPos();
}

// What a run that can't keep up spends its time on, and what would make it quicker.
void slowness(Ui& ui) {
    if (!ui.isSlow || ui.player.looksBack()) return;
    const Measurement& m = ui.player.measurement();
    double each = 0;  // ms, a step
    for (const PassTime& t : ui.times)
        if (t.runs > 0) each += t.ms / double(t.runs);
    ImGui::TextColored(amber(), "can't keep up with the clock:");
    if (m.dt > 0 && each > 0) text("a second takes {:.0f} steps of {:.2g} ms", 1 / m.dt, each);
    if (const std::string passes = slowestPasses(ui.times); !passes.empty()) text("{}", passes);
    std::optional<Remedy::How> taken;
    for (const Remedy& remedy : ui.remedies) {
        if (ImGui::Button(remedy.label.c_str(), {-1, 0})) taken = remedy.how;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", remedy.help.c_str());
    }
    if (taken) ui.take(*taken);
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

void curves(Ui& ui) {
    const Curves& h = ui.player.curves();
    const std::optional<double> shown =
        ui.player.looksBack() ? std::optional(ui.player.measurement().time) : std::nullopt;
    plot("energy", perDepth("J", h.dimensions).c_str(), h.time, shown,
         {{"total", h.total, ImGui::GetColorU32(ImGuiCol_Text)},
          {"kinetic", h.kinetic,
           isLight() ? IM_COL32(20, 100, 190, 255) : IM_COL32(96, 180, 255, 255)},
          {"potential", h.potential,
           isLight() ? IM_COL32(190, 110, 0, 255) : IM_COL32(255, 190, 90, 255)}});
    plot("mean density error", "", h.time, shown,
         {{"", h.densityError,
           isLight() ? IM_COL32(20, 130, 60, 255) : IM_COL32(120, 220, 150, 255)}});
    if (ImGui::Button("Save curves as CSV", {-1, 0})) ui.saveCurves();
}

// Disabled with its reason as tooltip, as long as there is no GPU.
void backend(Ui& ui) {
    const std::string why = ui.whyNoSwitch();
    ImGui::BeginDisabled(!why.empty());
    if (ImGui::Button(ui.onGpu ? "Run on the CPU" : "Run on the GPU", {-1, 0})) ui.switchBackend();
    ImGui::EndDisabled();
    if (!why.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", why.c_str());
}

bool section(const char* title, bool open = false) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

// What a knob that is 0 leaves to the program.
std::string inForce(const Ui& ui, const std::string& path) {
    const Scene& scene = ui.player.scene;
    const double sound = ui.player.measurement().soundSpeed;
    const int gamma =
        scene.fluid.equationOfState == EquationOfState::Linear ? 1 : scene.fluid.gamma;
    if (path == "fluid.sound_speed") return fmt::format("{:.4g} m/s", sound);
    if (path == "fluid.stiffness")
        return fmt::format("{:.4g} Pa", scene.fluid.restDensity * sound * sound / gamma);
    if (path == "view.camera.distance") return fmt::format("{:.3g} m", ui.camera().distance);
    if (path == "view.stir.radius") return fmt::format("{:.3g} m", ui.stirRadius());
    if (path == "window.interface_scale") return fmt::format("{:.3g}", ui.scale);
    if (path == "contact.stiffness") return "what the step bears";
    return "";
}

// A file of colours may be named letter by letter: the picture says that there is none.
void putBackIfRefused(Ui& ui, const View& before) {
    Scene scene = ui.player.scene;
    if (scene.view.colorMap == ColorMap::File) scene.view.colorMap = ColorMap::Viridis;
    try {
        checkView(scene);
    } catch (const Error& error) {
        ui.player.scene.view = before;
        ui.say(error.what(), true);
    }
}

// Once its name is whole.
void tryColorFile(Ui& ui) {
    const View& view = ui.player.scene.view;
    const std::string file = view.colorMap == ColorMap::File ? view.colorFile : "";
    if (ImGui::IsAnyItemActive() || ui.colorFile == file) return;
    ui.colorFile = file;
    if (view.colorMap != ColorMap::File) return;
    try {
        checkView(ui.player.scene);
    } catch (const Error& error) { ui.say(error.what(), true); }
}

void knobs(Ui& ui) {
    Scene& scene = ui.player.scene;
    const auto edited = [&](const char* title, const std::string& group, bool open = false) {
        return section(title, open) &&
               editKnobs(scene, ui.player.loadedScene(), group,
                         [&](const std::string& path) { return inForce(ui, path); });
    };
    const View before = scene.view;
    bool asked = edited("View", "view", true);
    asked |= edited("Slice: C, [ and ]", "view.slice");
    asked |= edited("Clip box", "view.clip");
    asked |= edited("Thresholds", "view.threshold");
    if (asked) putBackIfRefused(ui, before), ui.stale = ui.rewrite = true;
    tryColorFile(ui);
    if (edited("Arrows: A", "view.arrows")) ui.stale = ui.rewrite = true;
    if (edited("Stirrer: Ctrl + drag", "view.stir")) ui.stale = true;
    if (edited("Camera", "view.camera")) ui.stale = true;
    bool physics = edited("Fluid", "fluid", true);
    physics |= edited("Forces", "simulation");
    physics |= edited("Walls", "walls");
    if (!scene.objects.empty()) physics |= edited("Contact", "contact");
    physics |= edited("Time", "time");
    if (edited("Window", "window")) ui.stale = true;
    if (physics) ui.player.knobsChanged();
}

void panel(Ui& ui, int windowHeight) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({float(panelWidth(ui)), float(windowHeight - timeLineHeight(ui))});
    ImGui::Begin("panel", nullptr, fixedWindow);
    sceneList(ui);
    transport(ui);
    ImGui::Spacing();
    status(ui);
    slowness(ui);
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
    rememberPopup(ui);
}

// In the middle of the picture, or over the panel too where the picture is too narrow; what the
// window has no room for scrolls.
void beginBox(const Ui& ui, const char* name) {
    const ImVec2 all{float(ui.area.x + ui.area.width), float(ui.area.height)};
    const ImGuiWindow* before = ImGui::FindWindowByName(name);
    const float half = before ? 0.5f * before->Size.x : 0,
                middle = float(ui.area.x) + 0.5f * float(ui.area.width);
    ImGui::SetNextWindowPos(
        {std::max(std::min(middle, all.x - half), std::min(half, 0.5f * all.x)), 0.5f * all.y},
        ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, all);
    ImGui::Begin(name, nullptr, noteWindow);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
}

void help(const Ui& ui) {
    beginBox(ui, "help");
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit))
        for (const Control& control : controls) {
            ImGui::TableNextColumn();
            ImGui::TextColored(amber(), "%s", control.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(control.action);
        }
    ImGui::EndTable();
    ImGui::End();
}

void question(Ui& ui) {
    const Measurement& m = ui.player.measurement();
    beginBox(ui, "question");
    text("This run is not saved: {} steps, {:.4g} s.", m.steps, m.time);
    if (ImGui::Button("Save and leave (S)")) pressKey(ui, SDLK_s);
    ImGui::SameLine();
    if (ImGui::Button("Leave (Enter)")) pressKey(ui, SDLK_RETURN);
    ImGui::SameLine();
    if (ImGui::Button("Stay (Esc)")) pressKey(ui, SDLK_ESCAPE);
    ImGui::End();
}

// At the upper right, below notes that reach so far, as wide as its rows are, and never narrower
// than `least`, px at scale 1.
void beginPicked(const Ui& ui, const char* name, float least) {
    const float edge = margin * ui.scale, right = float(ui.area.x + ui.area.width) - edge;
    const ImGuiWindow *before = ImGui::FindWindowByName(name),
                      *notes = ImGui::FindWindowByName("notes");
    const float left = right - (before ? before->Size.x : least * ui.scale);
    const bool isBelow = notes && notes->Active && notes->Pos.x + notes->Size.x > left;
    ImGui::SetNextWindowPos({right, isBelow ? notes->Pos.y + notes->Size.y + edge / 2 : edge},
                            ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowSizeConstraints({least * ui.scale, 0}, {1e4f, 1e4f});
    ImGui::Begin(name, nullptr, noteWindow);
}

void pickedSolid(const Ui& ui) {
    const size_t index = size_t(ui.pickedSolid);
    const auto& solids = ui.player.measurement().solids;
    if (ui.pickedSolid < 0 || index >= solids.size()) return;
    const SolidMeasurement& s = solids[index];
    const Scene& scene = ui.player.scene;
    const auto unit = [&](const char* of) { return perDepth(of, scene.simulation.dimensions); };
    const auto vec = [](Vec3d v) {
        return fmt::format("{:.4g}  {:.4g}  {:.4g}", v.x + 0.0, v.y + 0.0, v.z + 0.0);
    };
    beginPicked(ui, "solid", 350);
    ImGui::TextColored(red(), "%s", s.name.c_str());
    row("middle", "{} m", vec(s.position));
    row("velocity", "{} m/s", vec(s.velocity));
    row("spin", "{} rad/s", vec(s.spin));
    row("force", "{} {}", vec(s.pressureForce + s.viscousForce), unit("N"));
    row("of it viscous", "{} {}", vec(s.viscousForce), unit("N"));
    row("torque", "{} {}", vec(s.torque), unit("N m"));
    if (scene.solids[index].floats())
        row("mass", "{:.4g} {}", massOf(scene, scene.solids[index]).mass, unit("kg"));
    else
        row("mass", "none: it moves as prescribed");
    ImGui::End();
}

void pickedParticle(Ui& ui) {
    if (!ui.picked) return;
    const Particle& p = *ui.picked;
    beginPicked(ui, "particle", 310);
    ImGui::TextColored(red(), "particle %d", p.id);
    row("position", "{:.4f}  {:.4f}  {:.4f} m", p.position.x, p.position.y, p.position.z);
    row("velocity", "{:.3f}  {:.3f}  {:.3f} m/s", p.velocity.x, p.velocity.y, p.velocity.z);
    row("speed", "{:.4g} m/s", length(p.velocity));
    row("density", "{:.5g} kg/m³", p.density);
    row("pressure", "{:.4g} Pa", p.pressure);
    ImGui::End();
}

}  // namespace

int panelWidth(const Ui& ui) { return ui.showPanel ? int(width * ui.scale) : 0; }

void showLoading(const Task& task, float x, float y) {
    ImGui::SetNextWindowPos({x, y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("loading", nullptr, noteWindow);
    text("{} ...", task.doing.load());
    ImGui::ProgressBar(float(task.share), {20 * ImGui::GetFontSize(), 0});
    ImGui::TextDisabled("Esc cancels");
    ImGui::End();
}

void showPanel(Ui& ui, int windowHeight) {
    if (ui.showPanel)
        panel(ui, windowHeight);
    else
        rememberPopup(ui);
    showTimeLine(ui, windowHeight);
    showNotes(ui);
    pickedParticle(ui);
    pickedSolid(ui);
    if (ui.showHelp) help(ui);
    if (ui.asking) question(ui);
    const Area& a = ui.area;
    if (const Task* task = ui.player.loading())
        showLoading(*task, float(a.x) + 0.5f * float(a.width), 0.3f * float(a.height));
    if (!ImGui::IsAnyItemActive()) ui.settleKnobs();
}

}  // namespace spindrift
