#include "app/window/input.h"

#include <imgui.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {

const std::vector<Control> controls = {
    {"Space", "run, pause"},
    {"Right", "one step; looking back, the next moment"},
    {"Left", "look back, to the moment before"},
    {"P, L", "play the kept moments, in a loop"},
    {"Enter", "go on from that moment (Esc: back to now)"},
    {"V", "record a film and the series, V ends it"},
    {"R", "start again, as it was loaded"},
    {"Left drag", "orbit"},
    {"Middle drag, Shift + left drag", "pan"},
    {"Wheel", "zoom to the cursor"},
    {"Home", "first view"},
    {"X  Y  Z", "look along x, y, z; with Shift from the other side"},
    {"O", "perspective or orthographic"},
    {"F5 to F8, with Shift", "show a view that was kept, keep this one"},
    {"M", "ruler: from here to the mouse, there, away"},
    {"Ctrl + drag", "stir the fluid, or drag an obstacle"},
    {"Ctrl + wheel", "radius of the stirrer"},
    {"Double click", "pick a particle or an obstacle"},
    {"1  2  3  4", "plain, velocity, pressure, density"},
    {"S", "fluid as a surface or as particles"},
    {"C", "slice across z, x, y, or none"},
    {"[  ]", "move the slice"},
    {"A", "arrows of velocity"},
    {"B", "boundary particles"},
    {"G", "CPU or GPU"},
    {"Tab", "panel"},
    {"F", "full screen"},
    {"F12", "screenshot"},
    {"Ctrl + S", "checkpoint"},
    {"Ctrl + Z", "undo the last change of a knob"},
    {"-  +", "slower, faster"},
    {"H, F1", "this help"},
    {"Esc", "close what is open, then leave"},
    {"Drop a file", "load a scene or a checkpoint"},
};

namespace {

// The panel knows that the mouse is over it one picture later.
bool isOverPicture(const Ui& ui) {
    return ui.mouseX >= 0 && ui.mouseY >= 0 && ui.mouseX < float(ui.area.width) &&
           ui.mouseY < float(ui.area.height);
}

// What is seen under the mouse, or where nothing is, as far away as the camera's target.
Vec3 underMouse(const Ui& ui, const OrbitCamera& camera) {
    return ui.frame.surfaceAt(int(ui.mouseX), int(ui.mouseY))
        .value_or(camera.onPlane(ui.mouseX, ui.mouseY, float(ui.area.width), float(ui.area.height),
                                 camera.target));
}

void startStir(Ui& ui) {
    if (ui.player.looksBack()) return ui.say("nothing moves while you look back");
    ui.stirCenter = ui.stirBefore = underMouse(ui, ui.camera());
    ui.drag = Drag::Stir;  // until it turns out that an obstacle is there
    ui.grabWanted = true;
    ui.stale = true;
}

void pressButton(Ui& ui, const SDL_MouseButtonEvent& event) {
    const bool left = event.button == SDL_BUTTON_LEFT;
    if (event.button == SDL_BUTTON_MIDDLE || (left && ui.held & KMOD_SHIFT))
        ui.drag = Drag::Pan;
    else if (left && ui.held & KMOD_CTRL)
        startStir(ui);
    else if (left && event.clicks == 2)
        ui.pickAt = {ui.mouseX, ui.mouseY};
    else if (left)
        ui.drag = Drag::Orbit;
}

void releaseButton(Ui& ui) {
    if (ui.drag == Drag::Stir) ui.player.stir({});
    if (ui.drag == Drag::Solid) ui.player.hold({});
    ui.grabWanted = false;
    if (ui.drag != Drag::None) ui.stale = true;
    ui.drag = Drag::None;
}

void dragMouse(Ui& ui, float dx, float dy) {
    OrbitCamera camera = ui.camera();
    const float width = float(ui.area.width), height = float(ui.area.height);
    // Half a turn for a drag over the picture's height.
    if (ui.drag == Drag::Orbit) camera.orbit(-dx * 180 / height, dy * 180 / height);
    if (ui.drag == Drag::Pan) camera.pan(dx, dy, height);
    if (ui.drag == Drag::Orbit || ui.drag == Drag::Pan) ui.moveCamera(camera);
    if (ui.drag != Drag::Stir && ui.drag != Drag::Solid) return;
    ui.stirCenter = camera.onPlane(ui.mouseX, ui.mouseY, width, height, ui.stirCenter);
    ui.stale = true;
}

void turnWheel(Ui& ui, float notches) {
    const Scene& scene = ui.player.scene;
    const float diagonal = length(scene.domain.max - scene.domain.min);
    OrbitCamera camera = ui.camera();
    const Vec3 anchor = underMouse(ui, camera);
    if (ui.held & KMOD_CTRL) {
        ui.setStirRadius(ui.stirRadius() * std::pow(1.15f, notches));
        ui.sizing = true;
        if (ui.drag == Drag::None) ui.stirCenter = anchor;
        return ui.say(fmt::format("stirs within {:.3g} m of the mouse", ui.stirRadius()));
    }
    const float wanted = camera.distance * std::pow(0.85f, notches);
    const float allowed = std::clamp(wanted, 0.02f * diagonal, 20 * diagonal);
    camera.zoom(allowed / camera.distance, anchor);
    ui.moveCamera(camera);
}

// Halves or doubles, within what the knob allows.
void changeSpeed(Ui& ui, float factor) {
    float& speed = ui.player.scene.view.speed;
    speed = std::clamp(speed * factor, 0.01f, 10.0f);
    ui.say(fmt::format("plays at {:.3g} x real time, if it can", speed));
}

void changeStyle(Ui& ui) {
    DrawStyle& style = ui.player.scene.view.style;
    style = style == DrawStyle::Surface ? DrawStyle::Spheres : DrawStyle::Surface;
    ui.stale = true;
}

// Across z, x, y, none; across z or none in two dimensions.
void changeSlice(Ui& ui) {
    const Scene& scene = ui.player.scene;
    Across& axis = ui.player.scene.view.slice.axis;
    const Across first = scene.simulation.dimensions == 2 ? Across::None : Across::X;
    axis = axis == Across::None ? Across::Z
           : axis == Across::Z  ? first
           : axis == Across::X  ? Across::Y
                                : Across::None;
    ui.stale = ui.rewrite = true;
}

// By this share of the domain.
void moveSlice(Ui& ui, float by) {
    if (ui.player.scene.view.slice.axis == Across::None)
        return ui.say("there is no slice to move: C shows one");
    float& position = ui.player.scene.view.slice.position;
    position = std::clamp(position + by, 0.0f, 1.0f);
    ui.stale = ui.rewrite = true;
}

void toggleArrows(Ui& ui) {
    int& count = ui.player.scene.view.arrows.count;
    count = count > 0 ? 0 : 24;
    ui.stale = ui.rewrite = true;
}

void changeProjection(Ui& ui) {
    Projection& projection = ui.player.scene.view.projection;
    projection =
        projection == Projection::Perspective ? Projection::Orthographic : Projection::Perspective;
    ui.stale = true;
}

void lookAlong(Ui& ui, int axis) {
    OrbitCamera camera = ui.camera();
    Vec3 from{0, 0, 0};
    from[axis] = ui.held & KMOD_SHIFT ? -1 : 1;
    camera.lookFrom(from);
    ui.moveCamera(camera);
}

// While the program asks whether to leave.
void answer(Ui& ui, SDL_Keycode key) {
    if (key == SDLK_RETURN || key == SDLK_y || key == SDLK_q) ui.quit = true;
    if (key == SDLK_s) ui.quit = ui.saveCheckpoint();
    if (key == SDLK_s || key == SDLK_n || key == SDLK_ESCAPE) ui.asking = false;
}

// Keys that change what is seen only; whether this is one.
bool pressViewKey(Ui& ui, SDL_Keycode key) {
    View& view = ui.player.scene.view;
    if (ui.held & KMOD_CTRL) return false;
    if (key >= SDLK_1 && key <= SDLK_4)
        return ui.colorBy(ColorBy(key - SDLK_1)), true;  // their order
    if (key >= SDLK_x && key <= SDLK_z) return lookAlong(ui, key - SDLK_x), true;
    if (key >= SDLK_F5 && key <= SDLK_F8) {
        const auto bookmark = size_t(key - SDLK_F5);
        ui.held& KMOD_SHIFT ? ui.keepView(bookmark) : ui.showView(bookmark);
        return true;
    }
    switch (key) {
        case SDLK_HOME:
            return ui.resetCamera(), true;
        case SDLK_b:
            view.showWalls = !view.showWalls;
            ui.stale = ui.rewrite = true;
            return true;
        case SDLK_s:
            return changeStyle(ui), true;
        case SDLK_m:
            return ui.useRuler(underMouse(ui, ui.camera())), true;
        case SDLK_o:
            return changeProjection(ui), true;
        case SDLK_c:
            return changeSlice(ui), true;
        case SDLK_LEFTBRACKET:
            return moveSlice(ui, -0.025f), true;
        case SDLK_RIGHTBRACKET:
            return moveSlice(ui, 0.025f), true;
        case SDLK_a:
            return toggleArrows(ui), true;
        default:
            return false;
    }
}

// Keys that run, step and look back; whether this is one.
bool pressTimeKey(Ui& ui, SDL_Keycode key) {
    switch (key) {
        case SDLK_SPACE:
            return ui.toggleRun(), true;
        case SDLK_RIGHT:
            ui.player.looksBack() ? ui.lookOn(1) : ui.player.stepOnce();
            return true;
        case SDLK_LEFT:
            return ui.lookOn(-1), true;
        case SDLK_p:
            return ui.playMoments(), true;
        case SDLK_l:
            ui.replay.loops = !ui.replay.loops;
            ui.say(ui.replay.loops ? "kept moments play in a loop" : "kept moments play once");
            return true;
        case SDLK_RETURN:
        case SDLK_KP_ENTER:
            return ui.goOnFromHere(), true;
        case SDLK_v:
            return ui.toggleRecording(), true;
        default:
            return false;
    }
}

}  // namespace

void pressKey(Ui& ui, SDL_Keycode key) {
    if (ui.asking) return answer(ui, key);
    if (key == SDLK_MINUS || key == SDLK_KP_MINUS) return changeSpeed(ui, 0.5f);
    if (key == SDLK_PLUS || key == SDLK_EQUALS || key == SDLK_KP_PLUS) return changeSpeed(ui, 2);
    if (pressViewKey(ui, key)) return;
    if (pressTimeKey(ui, key)) return;
    switch (key) {
        case SDLK_r:
            ui.reset();
            break;
        case SDLK_g:
            ui.switchBackend();
            break;
        case SDLK_f:
            ui.fullscreen = !ui.fullscreen;
            break;
        case SDLK_F12:
            ui.screenshot = true;
            break;
        case SDLK_s:  // with Ctrl, as the next one
            ui.saveCheckpoint();
            break;
        case SDLK_z:
            ui.undo();
            break;
        case SDLK_h:
        case SDLK_F1:
            ui.showHelp = !ui.showHelp;
            break;
        case SDLK_TAB:
            ui.showPanel = !ui.showPanel;
            break;
        case SDLK_ESCAPE:
            ui.escape();
            break;
        default:
            break;
    }
}

std::optional<SDL_Event> Taps::beginPicture() {
    pressed_.clear();
    return std::exchange(kept_, {});
}

bool Taps::keeps(const SDL_Event& event) {
    if (event.type != SDL_KEYDOWN && event.type != SDL_KEYUP) return false;
    const SDL_Keysym key = event.key.keysym;
    const bool isLetter = key.sym >= ' ' && key.sym < SDLK_DELETE && !(key.mod & KMOD_CTRL);
    if (event.type == SDL_KEYDOWN && !isLetter) pressed_.insert(key.sym);
    if (event.type == SDL_KEYDOWN || !pressed_.contains(key.sym)) return false;
    kept_ = event;
    return true;
}

void handleEvent(Ui& ui, const SDL_Event& event) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto moveTo = [&](int x, int y) {
        ui.mouseX = float(x) * ui.density - float(ui.area.x);
        ui.mouseY = float(y) * ui.density - float(ui.area.y);
    };
    switch (event.type) {
        case SDL_QUIT:
            ui.leave();
            break;
        case SDL_DROPFILE:
            ui.load(event.drop.file);
            SDL_free(event.drop.file);
            break;
        case SDL_KEYUP:
            ui.held = SDL_Keymod(event.key.keysym.mod);
            if (ui.sizing && !(ui.held & KMOD_CTRL)) ui.sizing = false, ui.stale = true;
            break;
        case SDL_KEYDOWN:
            ui.held = SDL_Keymod(event.key.keysym.mod);
            // A key that is held repeats single steps only.
            if (!io.WantTextInput && (!event.key.repeat || event.key.keysym.sym == SDLK_RIGHT ||
                                      event.key.keysym.sym == SDLK_LEFT))
                pressKey(ui, event.key.keysym.sym);
            break;
        case SDL_MOUSEBUTTONDOWN:
            moveTo(event.button.x, event.button.y);
            if (!io.WantCaptureMouse && isOverPicture(ui)) pressButton(ui, event.button);
            break;
        case SDL_MOUSEBUTTONUP:
            releaseButton(ui);
            break;
        case SDL_MOUSEMOTION: {
            const float x = ui.mouseX, y = ui.mouseY;
            moveTo(event.motion.x, event.motion.y);
            if (ui.sizing && ui.drag == Drag::None)
                ui.stirCenter = underMouse(ui, ui.camera()), ui.stale = true;
            if (ui.measuring) ui.stretchRuler(underMouse(ui, ui.camera()));
            dragMouse(ui, ui.mouseX - x, ui.mouseY - y);
            break;
        }
        case SDL_MOUSEWHEEL:
            if (!io.WantCaptureMouse && isOverPicture(ui)) turnWheel(ui, event.wheel.preciseY);
            break;
        default:
            break;
    }
}

}  // namespace spindrift
