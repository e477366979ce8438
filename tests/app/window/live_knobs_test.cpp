// What is done with knobs, without a window.
#include "app/window/idle_knobs.h"
#include "app/window/input.h"
#include "app/window/live_knobs.h"
#include "app/window/panel.h"
#include "core/error.h"
#include "scene/check.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>
#include <imgui.h>

namespace spindrift {
namespace {

// Another value that its range allows.
void change(float& value, const Knob& knob) {
    value = value == knob.max ? knob.min : std::min(knob.max, value * 1.5f + 0.01f);
}
void change(int& value, const Knob& knob) {
    value = value == int(knob.max) ? int(knob.min) : value + 1;
}
void change(bool& value, const Knob&) { value = !value; }
template <class T> void change(Vec3Of<T>& value, const Knob&) { value.x += T(0.5); }
void change(std::string& value, const Knob&) { value += "x"; }
void change(Keyframes&, const Knob&) {}  // no live knob
void change(Rates&, const Knob&) {}      // nor this
template <class E>
requires std::is_enum_v<E>
void change(E& value, const Knob&) { value = E((int(value) + 1) % int(enumNames(value).size())); }

// Each live knob, one after the other: known as changed, undone alone, put back alone.
TEST(KnobHistory, UndoesEachKnobByItself) {
    const Scene loaded;
    Scene scene = loaded;
    KnobHistory history(scene);
    std::vector<std::string> changed;
    visitLiveKnobs(scene, loaded,
                   [&](const std::string& path, auto& value, const auto&, const Knob& knob) {
                       if (!isOfKind(path, KnobKind::ButCamera)) return;
                       change(value, knob);
                       history.settle(scene);
                       changed.push_back(path);
                       EXPECT_EQ(changedKnobs(scene, loaded, KnobKind::ButCamera), changed);
                   });
    EXPECT_GT(changed.size(), 40u);
    for (; !changed.empty(); changed.pop_back()) {
        EXPECT_EQ(changedKnobs(scene, loaded, KnobKind::ButCamera), changed);
        EXPECT_EQ(history.undo(scene), std::vector<std::string>{changed.back()});
    }
    EXPECT_TRUE(history.undo(scene).empty());
    EXPECT_TRUE(changedKnobs(scene, loaded, KnobKind::All).empty());
}

TEST(KnobHistory, WhatWasDraggedIsOneChangeAndTheCameraIsNone) {
    Scene scene;
    KnobHistory history(scene);
    for (float value : {0.1f, 0.2f, 0.3f})
        scene.fluid.viscosity = value;  // nothing has settled in between
    history.settle(scene);
    scene.view.camera.yaw = 12;
    history.settle(scene);
    EXPECT_EQ(joined(history.undo(scene)), "fluid.viscosity");
    EXPECT_EQ(scene.fluid.viscosity, Scene().fluid.viscosity);
    EXPECT_EQ(scene.view.camera.yaw, 12);
    EXPECT_TRUE(history.undo(scene).empty());
}

bool isRefused(const Scene& scene) {
    try {
        checkScene(scene);
        return false;
    } catch (const Error&) { return true; }
}

// Knobs that are said to have no effect have none, to the last bit, or can't be changed at all.
TEST(IdleKnobs, ChangeNothing) {
    for (const char* formulation : {"wcsph", "delta_sph", "delta_plus", "classic"})
        for (const char* mode : {"cfl", "fixed"}) {
            Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/dam_break_small.json");
            setKnob(scene, std::string("simulation.formulation=") + formulation);
            setKnob(scene, std::string("time.mode=") + mode);
            if (std::string(formulation) == "classic")
                setKnob(scene, "simulation.kernel=cubic_spline");
            scene.compute.backend = Backend::Cpu;
            const auto end = [&](const Scene& s) {
                auto simulation = makeSimulation(scene);
                simulation->apply(s);
                simulation->step(12);
                return simulation->state().particles.positions;
            };
            const std::vector<Vec3> plain = end(scene);
            int idle = 0;
            Scene other = scene;
            visitLiveKnobs(
                other, scene,
                [&](const std::string& path, auto& value, const auto& first, const Knob& k) {
                    if (!isOfKind(path, KnobKind::Physics) || whyIdle(scene, path).empty()) return;
                    change(value, k);
                    ++idle;
                    EXPECT_TRUE(isRefused(other) || end(other) == plain)
                        << path << " " << formulation << " " << mode;
                    value = first;
                });
            EXPECT_GT(idle, 5);
        }
}

TEST(IdleKnobs, OfTheViewGoByWhatIsShown) {
    Scene scene;
    for (const ColorBy by : {ColorBy::Plain, ColorBy::Fluid, ColorBy::Surface, ColorBy::Velocity}) {
        scene.view.colorBy = by;
        for (const char* path : {"view.range", "view.color_map"})
            EXPECT_EQ(whyIdle(scene, path).empty(), by == ColorBy::Velocity) << path << int(by);
    }
    for (const char* path : {"view.slice.position", "view.slice.contours", "view.slice.fluid",
                             "view.threshold.min", "view.arrows.length", "view.color_file"})
        EXPECT_NE(whyIdle(scene, path), "") << path;
    scene.view.slice.axis = Across::X, scene.view.threshold.on = true;
    scene.view.arrows.count = 5, scene.view.colorMap = ColorMap::File;
    for (const char* path : {"view.slice.position", "view.slice.contours", "view.slice.fluid",
                             "view.threshold.min", "view.arrows.length", "view.color_file"})
        EXPECT_EQ(whyIdle(scene, path), "") << path;
}

// The panel is drawn over the one before.
TEST(Panel, LetsNothingShowThrough) {
    ImGui::CreateContext();
    for (const Theme theme : {Theme::Dark, Theme::Light}) {
        setUpPanel(1, theme);
        for (const int background : {ImGuiCol_WindowBg, ImGuiCol_PopupBg})
            EXPECT_EQ(ImGui::GetStyle().Colors[background].w, 1);
        EXPECT_EQ(isLight(), theme == Theme::Light);
        // What is written can be read.
        const ImVec4 paper = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
        for (const ImVec4 ink : {ImGui::GetStyle().Colors[ImGuiCol_Text], amber()})
            EXPECT_GT(std::abs(ink.y - paper.y), 0.45f) << int(theme);
    }
    ImGui::DestroyContext();
}

TEST(Escape, ClosesOneThingAfterTheOther) {
    const std::vector<std::pair<bool Opened::*, Escape>> order = {
        {&Opened::question, Escape::Stay},
        {&Opened::loading, Escape::CancelLoading},
        {&Opened::popup, Escape::ClosePopup},
        {&Opened::help, Escape::CloseHelp},
        {&Opened::looksBack, Escape::ReturnToPresent},
        {&Opened::fullscreen, Escape::LeaveFullScreen},
        {&Opened::unsaved, Escape::Ask}};
    for (unsigned open = 0; open < 1u << order.size(); ++open) {
        Opened opened;
        Escape wanted = Escape::Leave;
        for (size_t i = order.size(); i-- > 0;)
            if (open >> i & 1) opened.*order[i].first = true, wanted = order[i].second;
        EXPECT_EQ(escapeFrom(opened), wanted) << open;
    }
}

TEST(Curves, AreSavedWithUnits) {
    Curves history;
    Measurement m;
    m.time = 0.5, m.kineticEnergy = 1, m.potentialEnergy = 2, m.densityError = 0.01;
    history.add(m);
    EXPECT_EQ(csvOf(history),
              "time [s],kinetic energy [J],potential energy [J],total energy [J],mean density "
              "error\n0.5,1,2,3,0.01\n");
    m.dimensions = 2, m.time = 1;
    history.add(m);
    EXPECT_NE(
        csvOf(history).find("kinetic energy [J/m],potential energy [J/m],total energy [J/m],"),
        std::string::npos);
}

SDL_Event keyEvent(Uint32 type, SDL_Keycode key, Uint16 mod = 0) {
    SDL_Event event{};
    event.type = type, event.key.keysym.sym = key, event.key.keysym.mod = mod;
    return event;
}

// However slow pictures are, each tap of a key is down in one of them, in its order; letters pass.
TEST(Taps, AreSeenInAPicture) {
    std::vector<SDL_Event> queue;
    const std::pair<SDL_Keycode, Uint16> typed[] = {
        {'5', 0}, {SDLK_BACKSPACE, 0}, {SDLK_BACKSPACE, 0},
        {'7', 0}, {'z', KMOD_LCTRL},   {SDLK_RETURN, 0}};
    for (const auto& [key, mod] : typed)
        queue.push_back(keyEvent(SDL_KEYDOWN, key, mod)),
            queue.push_back(keyEvent(SDL_KEYUP, key, mod));
    Taps taps;
    std::vector<std::vector<SDL_Keycode>> pictures;  // what was down in each
    for (size_t next = 0; next < queue.size();) {
        std::set<SDL_Keycode> down;
        if (const auto kept = taps.beginPicture()) {
            EXPECT_EQ(kept->type, Uint32(SDL_KEYUP));
            ++next;
        }
        for (; next < queue.size() && !taps.keeps(queue[next]); ++next) {
            if (queue[next].type == SDL_KEYDOWN) down.insert(queue[next].key.keysym.sym);
            if (queue[next].type == SDL_KEYUP) down.erase(queue[next].key.keysym.sym);
        }
        pictures.push_back({down.begin(), down.end()});
        ASSERT_LT(pictures.size(), 20u);
    }
    const std::vector<std::vector<SDL_Keycode>> expected{
        {SDLK_BACKSPACE}, {SDLK_BACKSPACE}, {'z'}, {SDLK_RETURN}, {}};
    EXPECT_EQ(pictures, expected);
}

}  // namespace
}  // namespace spindrift
