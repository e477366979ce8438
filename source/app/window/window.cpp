#include "app/exit_code.h"
#include "app/window/window.h"

#include "app/scene_choice.h"
#include "app/window/input.h"
#include "app/window/panel.h"
#include "app/window/ui.h"
#include "core/error.h"
#include "core/system.h"

#include <SDL.h>
#include <backends/imgui_impl_opengl3.h>
#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <utility>

namespace spindrift {

namespace {

[[noreturn]] void noDisplay(const std::string& why) {
    throw Error(Failure::NoDisplay, "no window: " + why + ": set DISPLAY, or use --headless");
}

// SDL, the window and its GL context; closed in the opposite order.
struct Screen {
    SDL_Window* window = nullptr;
    SDL_GLContext context = nullptr;

    explicit Screen(const Scene& scene) {
        SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // they would only ask whether to leave
        if (SDL_Init(SDL_INIT_VIDEO) != 0) noDisplay(SDL_GetError());
        // Without a screen SDL falls back to drivers that show nothing, and says nothing.
        const std::string driver = SDL_GetCurrentVideoDriver();
        if (driver == "offscreen" || driver == "dummy") {
            SDL_Quit();
            noDisplay("the screen that DISPLAY or WAYLAND_DISPLAY names does not answer");
        }
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 4);
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 5);
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
        SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 0);
        SDL_Rect room{0, 0, scene.window.width, scene.window.height};
        SDL_GetDisplayUsableBounds(0, &room);
        window = SDL_CreateWindow(
            (scene.window.title + " - " + scene.name).c_str(), SDL_WINDOWPOS_CENTERED,
            SDL_WINDOWPOS_CENTERED, std::min(scene.window.width, room.w),
            std::min(scene.window.height, room.h),
            SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
        context = window ? SDL_GL_CreateContext(window) : nullptr;
        if (!context) {
            const std::string why = SDL_GetError();
            close();
            noDisplay("OpenGL 4.5: " + why);
        }
        SDL_SetWindowMinimumSize(window, 480, 360);
        SDL_GL_SetSwapInterval(1);
    }
    ~Screen() { close(); }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

private:
    void close() {
        if (context) SDL_GL_DeleteContext(context);
        if (window) SDL_DestroyWindow(window);
        SDL_Quit();
    }
};

struct Gui {
    explicit Gui(const Screen& screen) {
        ImGui::CreateContext();
        ImGui_ImplSDL2_InitForOpenGL(screen.window, screen.context);
        ImGui_ImplOpenGL3_Init("#version 450");
    }
    ~Gui() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplSDL2_Shutdown();
        ImGui::DestroyContext();
    }
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    // Between pictures.
    void setLook(float scale, Theme theme) {
        if (scale == scale_ && theme == theme_) return;
        scale_ = scale, theme_ = theme;
        setUpPanel(scale, theme);
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    void beginPicture(SDL_Window* window) const {
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplSDL2_NewFrame();
        // The backend asks for the global mouse, which stands still under Xvfb while a button is
        // held.
        if (SDL_GetMouseFocus() == window) {
            int x = 0, y = 0;
            SDL_GetMouseState(&x, &y);
            ImGui::GetIO().MousePos = {float(x), float(y)};
        }
        ImGui::NewFrame();
    }
    void endPicture(SDL_Window* window) const {
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        SDL_GL_SwapWindow(window);
    }

private:
    float scale_ = 0;
    Theme theme_ = Theme::Dark;
};

// The window's pixels for one unit of the mouse.
float densityOf(SDL_Window* window) {
    int width = 1, pixels = 1, height = 1;
    SDL_GetWindowSize(window, &width, &height);
    SDL_GL_GetDrawableSize(window, &pixels, &height);
    return float(pixels) / float(std::max(width, 1));
}

// How much larger than usual things must be to read well: by the system's scale, or by the screen's
// dots an inch.
float scaleOf(SDL_Window* window) {
    const float density = densityOf(window);
    float dots = 96;
    if (density > 1 ||
        SDL_GetDisplayDPI(SDL_GetWindowDisplayIndex(window), nullptr, &dots, nullptr) != 0)
        return density;
    constexpr float dense = 120;  // where letters of the usual size begin to be small
    return std::clamp(std::round(dots / dense * 4) / 4, 1.0f, 3.0f);
}

float interfaceScale(SDL_Window* window, const Scene& scene) {
    return scene.window.interfaceScale > 0 ? scene.window.interfaceScale : scaleOf(window);
}

// Thrown when the window is closed before the first run is ready.
struct Left {};

// Makes the first run ready while the window shows how far that is.
Loaded loadFirst(const Screen& screen, Gui& gui, Start start) {
    start.scene = onDrawingDevice(std::move(start.scene));
    gui.setLook(interfaceScale(screen.window, start.scene), start.scene.view.theme);
    Loader loader([&] { return std::move(start); });
    while (!loader.done()) {
        for (SDL_Event event; SDL_PollEvent(&event);)
            if (event.type == SDL_QUIT ||
                (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE))
                throw Left{};
        if (os::StopSignals::received() != 0) throw Left{};
        int width = 1, height = 1;
        SDL_GL_GetDrawableSize(screen.window, &width, &height);
        gui.beginPicture(screen.window);
        showLoading(loader.progress(), 0.5f * float(width), 0.5f * float(height));
        ImGui::Render();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glClearColor(0.07f, 0.08f, 0.10f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        gui.endPicture(screen.window);
        SDL_Delay(16);
    }
    return loader.take();
}

class Desktop {
public:
    explicit Desktop(Start start)
        : screen_(start.scene),
          samples_((loadGl(), start.scene.window.samples)),
          gui_(screen_),
          ui_(loadFirst(screen_, gui_, std::move(start)), samples_) {
        Scene any;
        any.compute.device = ui_.player.scene.compute.device;
        ui_.noGpu = whyNoGpu(any);
        ui_.glRenderer = glName();
    }

    int run() {
        while (!ui_.quit && os::StopSignals::received() == 0) {
            handleEvents();
            ui_.takeLoaded();
            followWindow();
            advance();
            if (ui_.stale) drawPicture();
            if (drawn_ || settle_ > 0 || ui_.player.loading()) present();
            limitRate();
            if (ui_.screenshot) ui_.takeScreenshot();
        }
        ui_.endRecording();
        return int(Exit::Ok);
    }

private:
    // ImGui needs a few frames after an event until hover and focus have settled.
    static constexpr int settleFrames = 4;

    bool idle() const {
        return !ui_.player.running && !ui_.player.busy() && !ui_.player.loading() && !ui_.stale &&
               !ui_.replay.playing && settle_ <= 0;
    }

    void handleEvents() {
        SDL_Event event;
        bool any = true;
        if (std::optional<SDL_Event> kept = taps_.beginPicture())
            event = *kept;
        else
            any = idle() ? SDL_WaitEventTimeout(&event, 200) : SDL_PollEvent(&event);
        const bool came = any;
        for (; any && !taps_.keeps(event); any = SDL_PollEvent(&event)) {
            ImGui_ImplSDL2_ProcessEvent(&event);
            handleEvent(ui_, event);
        }
        settle_ = notesChanged() || came ? settleFrames : settle_ - 1;
    }

    // Notes have come or gone; in between nothing needs to be drawn. A box needs two pictures to
    // fit its text.
    bool notesChanged() {
        std::string notes = notesOf(ui_);
        return std::exchange(notes_, notes) != notes;
    }

    // Size, full screen and panel may have changed: the picture takes what the panel leaves.
    void followWindow() {
        setFullScreen();
        ui_.scale = interfaceScale(screen_.window, ui_.player.scene);
        gui_.setLook(ui_.scale, ui_.player.scene.view.theme);
        int width = 1, height = 1;
        SDL_GL_GetDrawableSize(screen_.window, &width, &height);
        ui_.density = densityOf(screen_.window);
        const int left = std::min(panelWidth(ui_), width - 1);
        const int below = std::min(timeLineHeight(ui_), height - 1);
        ui_.area = {left, 0, std::max(width - left, 1), std::max(height - below, 1)};
        windowHeight_ = height;
        if (ui_.frame.width() == ui_.area.width && ui_.frame.height() == ui_.area.height) return;
        ui_.frame.resize(ui_.area.width, ui_.area.height);
        ui_.stale = true;
    }

    void setFullScreen() {
        const bool full = SDL_GetWindowFlags(screen_.window) & SDL_WINDOW_FULLSCREEN_DESKTOP;
        if (full == ui_.fullscreen) return;
        if (!full) SDL_GetWindowSize(screen_.window, &windowed_[0], &windowed_[1]);
        SDL_SetWindowFullscreen(screen_.window, full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
        // Without a window manager nobody else gives the size back.
        if (full) SDL_SetWindowSize(screen_.window, windowed_[0], windowed_[1]);
    }

    void advance() {
        noteDrag();
        bool moved = false;
        if (!ui_.player.collect(moved)) return;
        if (generation_ != ui_.player.generation()) startOver();
        moved_ |= moved;
        if (!ui_.player.notice.empty()) ui_.say(std::exchange(ui_.player.notice, {}), true);
        ui_.stale |= !ui_.player.culprits.empty() && moved;
        ui_.replayOn();
        try {
            if (ui_.rewrite || (moved_ && (timeForPicture() || ui_.pickAt))) updateVertices();
            record();
            if (ui_.pickAt) ui_.pick();
            if (ui_.grabWanted) ui_.grab();
        } catch (const Error& error) {  // a GPU was lost
            ui_.player.halt(error.what());
            ui_.pickAt.reset();
        }
        readTimes();
        ui_.noteWhetherSlow();
        // While one picture is drawn, the steps for the next are made; a slow picture leaves time
        // for more.
        constexpr double least = 0.012, most = 0.050;  // s
        ui_.player.proceed(std::clamp(ui_.stale ? 1e-3 * ui_.drawMs : 0, least, most));
    }

    void updateVertices() {
        ui_.rewrite = moved_ = false;
        ui_.stale = true;
        ui_.frame.update(ui_.player.simulation(), ui_.player.scene, ui_.player.looksBack());
        ui_.fluidCount = ui_.player.simulation().fluidCount();
        ui_.refreshPicked();
    }

    void record() {
        ui_.player.watchAt = std::numeric_limits<double>::max();
        Recording* recording = ui_.recording.get();
        if (!recording || ui_.player.looksBack()) return;
        try {
            recording->follow(ui_.player.simulation(), ui_.player.measurement(),
                              ui_.player.remarks());
            if (recording->wantsPicture()) {
                if (moved_) updateVertices();
                drawForFilm(*recording);
            }
            ui_.player.watchAt = recording->next();
        } catch (const Error& error) {  // a disk is full
            ui_.endRecording();
            ui_.say(error.what(), true);
        }
    }

    // As large as the film began, and as smooth as the window allows.
    void drawForFilm(Recording& recording) {
        const bool isAsLarge =
            recording.width() == ui_.area.width && recording.height() == ui_.area.height;
        ui_.frame.setSamples(samples_);
        if (!isAsLarge) ui_.frame.resize(recording.width(), recording.height());
        ui_.frame.draw(ui_.player.scene, ui_.rings(), ui_.marks());
        recording.add(ui_.frame.image(), double(ui_.player.scene.view.speed));
        if (!isAsLarge) ui_.frame.resize(ui_.area.width, ui_.area.height);
        ui_.stale = !isAsLarge, drawn_ = true;
    }

    // Where the processor draws, a run that's late gets at least as much of it as the pictures do.
    bool timeForPicture() const {
        return !software_ || !ui_.player.running || uiTime() - pictureEnd_ > 1e-3 * ui_.drawMs;
    }

    void startOver() {
        generation_ = ui_.player.generation();
        const Scene& scene = ui_.player.scene;
        ui_.frame.restart();
        Simulation& simulation = ui_.player.simulation();
        ui_.noteDevice();
        ui_.wallCount = simulation.wallCount();
        SDL_SetWindowTitle(screen_.window, (scene.window.title + " - " + scene.name).c_str());
    }

    void noteDrag() {
        const double now = uiTime(), passed = std::max(now - stirTime_, 1e-3);
        if (ui_.player.busy()) return;
        const Vec3 origin = ui_.player.scene.domain.min;
        if (ui_.drag == Drag::Solid)
            ui_.player.hold({ui_.hold.solid, ui_.stirCenter + origin + ui_.hold.target});
        if (ui_.drag != Drag::Stir) return;
        // What the mouse does in a second of the clock, fluid does in view.speed seconds of its
        // own.
        const View& view = ui_.player.scene.view;
        const Vec3 velocity =
            float(1 / (passed * double(view.speed))) * (ui_.stirCenter - ui_.stirBefore);
        ui_.player.stir(stirOf(view.stir, ui_.stirCenter + origin, ui_.stirRadius(),
                               passed < 0.5 ? velocity : Vec3{}));
        ui_.stirBefore = ui_.stirCenter;
        stirTime_ = now;
    }

    void readTimes() {
        if (uiTime() < nextTimes_) return;
        nextTimes_ = uiTime() + 0.5;
        // While it stands still those that were measured before hold.
        if (std::vector<PassTime> times = ui_.player.simulation().times(); !times.empty())
            ui_.times = std::move(times);
        ui_.player.simulation().resetTimes();
    }

    void drawPicture() {
        const double begin = uiTime();
        ui_.stale = false;
        // Smoothing doubles the time of a software picture, so it waits until nothing moves.
        const bool moving = ui_.player.running || ui_.drag != Drag::None;
        ui_.frame.setSamples(software_ && moving ? 1 : samples_);
        ui_.frame.draw(ui_.player.scene, ui_.rings(), ui_.marks());
        glFinish();
        pictureEnd_ = uiTime();
        ui_.drawMs = 1e3 * (pictureEnd_ - begin);
        drawn_ = true;
    }

    void present() {
        gui_.beginPicture(screen_.window);
        showPanel(ui_, windowHeight_);
        ImGui::Render();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        ui_.frame.blit(ui_.area.x, windowHeight_ - ui_.area.y - ui_.area.height);
        gui_.endPicture(screen_.window);
        drawn_ = false;
    }

    // Software GL knows no vertical sync. Steps that are done early needn't wait for the next
    // frame.
    void limitRate() {
        constexpr double period = 1.0 / 60;
        const double rest = period - (uiTime() - frameBegin_);
        if (rest > 0 && ui_.player.busy())
            ui_.player.wait(rest);
        else if (rest > 0)
            SDL_Delay(Uint32(1e3 * rest));
        frameBegin_ = uiTime();
    }

    Screen screen_;
    int samples_;
    Gui gui_;
    Ui ui_;
    int settle_ = settleFrames, windowHeight_ = 1, generation_ = 0;
    bool software_ = isSoftwareGl();
    bool moved_ = false,
         drawn_ = false;  // since the last update of the vertices; since the last present()
    std::array<int, 2> windowed_{};  // size before full screen
    double pictureEnd_ = 0;
    std::string notes_;  // on the screen
    Taps taps_;
    double frameBegin_ = 0, nextTimes_ = 0, stirTime_ = 0;
};

}  // namespace

int runWindow(Start start) {
    const os::StopSignals signals;
    int code = int(Exit::Ok);
    try {
        code = Desktop(std::move(start)).run();
    } catch (const Left&) {}
    const int signal = os::StopSignals::received();
    if (signal != 0) std::fprintf(stderr, "spindrift: stopped by a signal\n");
    return signal != 0 ? 128 + signal : code;
}

}  // namespace spindrift
