#pragma once
// What the window's parts share: the player, the picture, and what the user is doing.
#include "app/frame.h"
#include "app/window/player.h"
#include "app/window/recording.h"
#include "app/window/remedies.h"
#include "app/window/replay.h"

#include <SDL.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

// Where the picture stands in the window, in its pixels from the upper left corner.
struct Area {
    int x = 0, y = 0, width = 1, height = 1;
};

enum class Drag { None, Orbit, Pan, Stir, Solid };

// A scene of the list.
struct SceneEntry {
    std::string name, file, title;
};

// Words over the picture that go away by themselves.
struct Message {
    std::string text;
    bool error = false;
    double until = 0;
};

struct Ui {
    // Needs a current GL context.
    Ui(Loaded loaded, int samples)
        : player(std::move(loaded)), frame(1, 1, samples), knobs(player.scene) {}

    Player player;
    Frame frame;
    KnobHistory knobs;
    Area area;
    float scale = 1;    // of panel and text
    float density = 1;  // the window's pixels / the mouse's units

    bool quit = false, fullscreen = false, screenshot = false;
    bool showPanel = true, showHelp = false;
    bool asking = false;                          // whether to leave a run that is not saved
    bool popupOpen = false, closePopups = false;  // lists of the panel; what Esc wants of them
    bool stale = true;                            // the picture no longer shows the state
    bool rewrite = true;                          // the vertices no longer show the state

    SDL_Keymod held =
        KMOD_NONE;  // modifiers when the event at hand happened, which may be some time ago
    Drag drag = Drag::None;
    float mouseX = 0, mouseY = 0;  // px within the area
    Vec3 stirCenter, stirBefore;   // m, relative to the domain's lower corner
    bool sizing = false;           // the wheel has turned while Ctrl is held: its ring is shown
    bool grabWanted = false;       // if there is an obstacle at stirCenter
    Hold hold;  // of an obstacle that is dragged, its target seen from stirCenter

    // A ruler from one place to another, m from the domain's lower corner; the second follows the
    // mouse until it is put down.
    std::optional<std::array<Vec3, 2>> ruler;
    bool measuring = false;
    std::array<std::optional<Camera>, 4> bookmarks;

    std::optional<std::array<float, 2>> pickAt;  // px within the area
    std::optional<Particle> picked;
    int pickedSolid = -1;

    Replay replay;                         // while the run is looked back at
    double replayedAt = 0;                 // s, of the clock
    std::unique_ptr<Recording> recording;  // null: none

    Message message;
    std::string noGpu;  // why there is no GPU; empty = there is one
    std::vector<SceneEntry>
        scenes;             // that come with the program; read when the list is first opened
    std::string typedFile;  // in the scene list
    std::vector<PassTime> times;
    std::string device, glRenderer;
    std::string colorFile;  // that was looked at last: whether it can be read
    bool onGpu = false;     // steps
    int fluidCount = 0, wallCount = 0;
    double drawMs = 0;  // of the last picture

    bool isSlow = false;           // the run can't keep up with the clock
    double slowSince = 0;          // s, since when that is or isn't so
    std::vector<Remedy> remedies;  // while it is

    OrbitCamera camera() const;
    void moveCamera(const OrbitCamera&);
    void say(const std::string& text, bool error = false);

    // What keys and buttons do.
    void toggleRun();
    void reset();
    void load(const std::string& file);
    void takeLoaded();
    void escape();
    void leave();
    void undo();

    // Of the moments that are kept, the last one; the one nearest to a time, s; so many on or back;
    // all of them, one after the other, or pause.
    bool lookBack();
    void lookAt(double time);
    void lookOn(int moments);
    void playMoments();
    void replayOn();  // while they are played
    void goOnFromHere();
    void returnToPresent();
    // Film and series of what the run does from now on, or the end of them.
    void toggleRecording();
    void endRecording();
    void settleKnobs();        // now that nothing is held
    float stirRadius() const;  // m
    void setStirRadius(float);
    void switchBackend();
    std::string whyNoSwitch() const;  // "" = it can
    void noteDevice();                // of a simulation that is new
    void noteWhetherSlow();
    void take(Remedy::How);
    void colorBy(ColorBy);
    void resetCamera();
    void keepView(size_t bookmark);
    void showView(size_t bookmark);
    // Begins to measure at a place, ends there, or puts the ruler away.
    void useRuler(Vec3 at);
    void stretchRuler(Vec3 to);
    void takeScreenshot();
    bool saveCheckpoint();
    void saveCurves();
    void pick();           // the simulation must be at hand
    void grab();           // likewise
    void refreshPicked();  // likewise
    std::vector<Ring> rings() const;
    std::vector<std::array<Vec3, 2>> marks() const;

private:
    void take(const Remedy&);
};

// What Esc does: the first that there is to do.
enum class Escape {
    Stay,
    CancelLoading,
    ClosePopup,
    CloseHelp,
    ReturnToPresent,
    LeaveFullScreen,
    Ask,
    Leave
};
struct Opened {
    bool question = false, loading = false, popup = false, help = false, looksBack = false,
         fullscreen = false, unsaved = false;
};
Escape escapeFrom(const Opened&);

// The columns of the curves, with units; a line for each sample.
std::string csvOf(const Curves&);

double uiTime();  // s

// "spindrift-001.png" for ".png", or the first number that's free in this folder.
std::string freeName(const std::string& extension, const std::string& folder = ".");

}  // namespace spindrift
