// The real program on a screen without a monitor, driven by keys and mouse; what it shows is
// compared by its screenshots.
#include "xvfb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace spindrift {
namespace {

struct WindowTest : testing::Test {
    static Screen* screen;
    static void SetUpTestSuite() {
        ASSERT_TRUE(allInstalled({"Xvfb", "xdotool"})) << "install xvfb and xdotool";
        screen = new Screen;
    }
    static void TearDownTestSuite() {
        delete screen;
        screen = nullptr;
    }

    // A small scene that stands still until Space is pressed.
    static Window paused(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{
            "test/dam_break_small", "--size", "800x600",         "--steps", "20", "--set",
            "view.range=fixed",     "--set",  "view.range_max=2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return Window(*screen, arguments);
    }
};
Screen* WindowTest::screen = nullptr;

// Share of the pixels that differ visibly.
double difference(const Image& a, const Image& b) {
    if (a.rgb.size() != b.rgb.size() || a.rgb.empty()) return 1;
    size_t changed = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3)
        for (size_t k = i; k < i + 3; ++k)
            if (std::abs(a.rgb[k] - b.rgb[k]) > 12) {
                ++changed;
                break;
            }
    return double(changed) / (double(a.rgb.size()) / 3);
}

// Waits until the picture no longer changes.
Image settled(Window& window) {
    Image last = window.screenshot();
    for (int i = 0; i < 20; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        Image next = window.screenshot();
        if (next == last) return next;
        last = std::move(next);
    }
    ADD_FAILURE() << "the picture doesn't come to rest";
    return last;
}

constexpr double seen = 0.003;

TEST_F(WindowTest, MouseOrbitsPansAndZoomsAndHomeComesBack) {
    Window window = paused();
    const Image home = settled(window);
    const struct {
        const char* what;
        std::function<void()> act;
    } moves[] = {
        {"orbit", [&] { window.drag(1, 550, 300, 650, 250); }},
        {"pan by the middle button", [&] { window.drag(2, 550, 300, 600, 340); }},
        {"pan by Shift",
         [&] {
             window.act("keydown shift");
             window.drag(1, 550, 300, 600, 340);
             window.act("keyup shift");
         }},
        {"zoom in", [&] { window.act(window.at(560, 320) + "click 4 click 4"); }},
        {"zoom out", [&] { window.act(window.at(560, 320) + "click 5 click 5"); }},
    };
    for (const auto& move : moves) {
        move.act();
        EXPECT_GT(difference(home, settled(window)), seen) << move.what;
        window.act("key Home");
        EXPECT_LT(difference(home, settled(window)), 1e-4) << "Home after " << move.what;
    }
}

TEST_F(WindowTest, SpaceRunsAndPausesRightStepsResetGoesBack) {
    Window window(*screen, {"test/dam_break_small", "--size", "800x600", "--set",
                            "view.range=fixed", "--set", "view.range_max=2"});
    window.act("key space sleep 0.3 key r");  // pause, then back to the start
    const Image start = settled(window);
    window.act("key space sleep 1.5 key space");
    const Image later = settled(window);
    EXPECT_GT(difference(start, later), seen) << "Space ran";
    EXPECT_LT(difference(later, settled(window)), 1e-4) << "Space paused";
    for (int i = 0; i < 12; ++i) window.act("key Right sleep 0.05");
    EXPECT_GT(difference(later, settled(window)), 1e-4) << "Right stepped";
    window.act("key r");
    EXPECT_LT(difference(start, settled(window)), 1e-4) << "R went back to the start";
}

TEST_F(WindowTest, KeysChooseColoursWallsAndPanel) {
    Window window = paused();
    window.act("key 2");
    const Image velocity = settled(window);
    for (const char* key : {"1", "3", "4"}) {
        window.act(std::string("key ") + key);
        EXPECT_GT(difference(velocity, settled(window)), seen) << key;
    }
    window.act("key 2");
    EXPECT_LT(difference(velocity, settled(window)), 1e-4);
    window.act("key b");
    EXPECT_GT(difference(velocity, settled(window)), seen) << "B shows the walls";
    window.act("key b");
    EXPECT_LT(difference(velocity, settled(window)), 1e-4);
    window.act("key s");
    EXPECT_GT(difference(velocity, settled(window)), seen) << "S shows the fluid's surface";
    window.act("key s");
    EXPECT_LT(difference(velocity, settled(window)), 1e-4);
    for (const char* key : {"o", "c", "a", "c", "c", "c", "a", "o"}) {  // and all the way back
        const Image last = settled(window);
        window.act(std::string("key ") + key);
        EXPECT_GT(difference(last, settled(window)), 1e-5) << key;
    }
    EXPECT_LT(difference(velocity, settled(window)), 1e-4);
    window.act("key Tab");
    EXPECT_GT(settled(window).width, velocity.width) << "without the panel the picture is wider";
    window.act("key Tab");
    EXPECT_EQ(settled(window), velocity);
}

TEST_F(WindowTest, HelpPanelAndUnknownKeysDoNotTouchThePicture) {
    Window window = paused();
    const Image before = settled(window);
    window.act("key h key F1 key g key w key k");
    EXPECT_EQ(settled(window), before);
    EXPECT_TRUE(window.running());
}

TEST_F(WindowTest, DoubleClickMarksAParticleAndCtrlDragStirs) {
    Window window = paused();
    const Image before = settled(window);
    window.act(window.at(470, 330) + "click --repeat 2 --delay 60 1");
    const Image marked = settled(window);
    EXPECT_GT(difference(before, marked), 1e-4) << "the picked particle has a ring";
    EXPECT_LT(difference(before, marked), 0.01);
    window.act("keydown ctrl " + window.at(470, 330) + "mousedown 1 sleep 0.2 " +
               window.at(500, 320) + "sleep 0.3");
    EXPECT_GT(difference(marked, window.screenshot()), 5e-4) << "the stirrer is shown";
    window.act("mouseup 1 keyup ctrl");
    EXPECT_TRUE(window.running());
}

TEST_F(WindowTest, CtrlWheelShowsHowFarAroundItStirs) {
    Window window = paused();
    const Image before = settled(window);
    window.act("keydown ctrl " + window.at(470, 330) + "click 4 sleep 0.3");
    const Image small = window.screenshot();
    EXPECT_GT(difference(before, small), 5e-4);
    window.act("click --repeat 5 4 sleep 0.3");
    EXPECT_GT(difference(small, window.screenshot()), 5e-4) << "it grows";
    window.act("keyup ctrl sleep 0.3");
    EXPECT_LT(difference(before, settled(window)), 1e-4) << "it goes with the key";
}

// A ball in the middle of an otherwise calm scene goes with the mouse, one that stands still and
// one that floats; beside it there is nothing to be dragged.
TEST_F(WindowTest, CtrlDragPullsAnObstacle) {
    for (const char* density : {"0", "500"}) {
        SCOPED_TRACE(density);
        Window window(
            *screen,
            {"test/dam_break_small", "--size", "800x600", "--color", "plain", "--set",
             "simulation.gravity=0,0,0", "--set", "fluid.sound_speed=10", "--set",
             "domain.max=1,1,1", "--set",
             "fluid.bodies=[{\"shape\":\"block\",\"min\":[0,0,0],\"max\":[1,0.1,1]}]", "--set",
             std::string("solids=[{\"shape\":\"sphere\",\"center\":[0.5,0.5,0.5],\"radius\":0.12,"
                         "\"density\":") +
                 density + "}]"});
        window.act("key Tab sleep 1");  // the picture's middle is the window's
        const Image before = window.screenshot();
        window.act("keydown ctrl");
        window.drag(1, 400, 120, 480, 120);
        window.act("keyup ctrl");
        EXPECT_LT(difference(before, window.screenshot()), seen) << "nothing is there";
        window.act("keydown ctrl " + window.at(400, 300) + "mousedown 1 sleep 0.4 " +
                   window.at(450, 300) + "sleep 0.2 " + window.at(500, 300));
        double moved = 0;  // it follows as fast as the run goes
        for (int i = 0; i < 15 && moved <= 0.01; ++i) {
            window.act("sleep 1");
            moved = difference(before, window.screenshot());
        }
        window.act("mouseup 1 keyup ctrl");
        EXPECT_GT(moved, 0.01) << "the ball has gone";
    }
}

TEST_F(WindowTest, CtrlSSavesACheckpoint) {
    Window window = paused();
    const Image before = settled(window);
    // The keys are up again before a busy window gets to see them.
    window.actWhileStopped("key s key ctrl+s");
    EXPECT_TRUE(window.prints("spindrift-001.h5")) << window.log();
    EXPECT_EQ(window.log().find("spindrift-002.h5"), std::string::npos) << "S alone does nothing";
}

TEST_F(WindowTest, PausedAndLeftAloneItRests) {
    Window window = paused();
    settled(window);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double before = window.cpuTime();
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_GT(before, 0.05) << "nothing is measured";
    EXPECT_LT(window.cpuTime() - before, 0.03 * 3);
}

TEST_F(WindowTest, FullScreenAndBack) {
    Window window = paused();
    const Image before = settled(window);
    window.act("key f sleep 0.5");
    const Image full = settled(window);
    EXPECT_GT(full.height, before.height);
    window.act("key f sleep 0.5");
    EXPECT_EQ(settled(window).height, before.height);
}

TEST_F(WindowTest, EscapeClosesHelpThenFullScreenThenAsksThenLeaves) {
    Window window = paused();
    const Image before = settled(window);
    window.act("key f sleep 0.5 key h sleep 0.3");
    const int full = settled(window).height;
    window.act("key Escape sleep 0.5");  // the help
    EXPECT_EQ(settled(window).height, full);
    window.act("key Escape sleep 0.5");  // full screen
    EXPECT_EQ(settled(window).height, before.height);
    window.act("key Escape sleep 0.5 key Escape sleep 0.5");  // the question, and no
    EXPECT_TRUE(window.running());
    window.act("key Escape sleep 0.5 key Return");
    EXPECT_EQ(window.wait(20), 0) << window.log();
}

// By the keys and by the mouse, into the past and back.
TEST_F(WindowTest, TimeLineLooksBackAndReturns) {
    Window window(
        *screen, {"test/dam_break_small", "--size", "800x600", "--set", "view.range=fixed", "--set",
                  "view.range_max=2", "--set", "view.speed=0.2"});
    window.act("sleep 2.5 key space");
    const Image present = settled(window);
    window.act("key Left sleep 0.3 key Left sleep 0.3");
    const Image before = settled(window);
    EXPECT_GT(difference(present, before), 1e-4) << "Left looked back";
    window.act("key Right sleep 0.3 key Right sleep 0.3");
    EXPECT_LT(difference(present, settled(window)), 1e-4) << "Right came back";
    window.act("key Escape sleep 0.5");
    EXPECT_LT(difference(present, settled(window)), 1e-4) << "Esc returned to now";
    EXPECT_TRUE(window.running());
    window.drag(1, 700, 553, 90, 553);  // along the line below the picture
    const Image start = settled(window);
    EXPECT_GT(difference(before, start), seen) << "the beginning is farther back";
    window.act("key Escape sleep 0.5");
    EXPECT_LT(difference(present, settled(window)), 1e-4);
    window.act("key l key p sleep 0.5");
    EXPECT_GT(difference(present, window.screenshot()), 1e-4)
        << "it plays from the start, in a loop";
    window.act("key space key Escape sleep 0.5");
    EXPECT_LT(difference(present, settled(window)), 1e-4);
    // From the beginning on, until it has gone another way: then now is not what it was.
    window.drag(1, 700, 553, 90, 553);
    EXPECT_EQ(settled(window), start);
    window.act("key Return sleep 2 key space");
    EXPECT_GT(difference(start, settled(window)), seen) << "Enter went on from there";
}

TEST_F(WindowTest, RecordingIsAFilmAndASeriesAndOverwritesNothing) {
    if (!allInstalled({"ffmpeg"})) GTEST_SKIP() << "there is no ffmpeg";
    Window window(*screen, {"test/dam_break_small", "--size", "640x480"});
    for (const char* number : {"001", "002"}) {
        window.act("key v sleep 2 key v");
        for (const char* kind : {".mp4", ".csv"})
            EXPECT_TRUE(window.prints(std::string("-") + number + kind)) << window.log();
    }
    window.act("key v sleep 1");
    window.send(SIGTERM);
    EXPECT_EQ(window.wait(20), 128 + SIGTERM) << window.log();
    EXPECT_TRUE(window.prints("-003.mp4")) << "it is whole all the same";
}

// Without a question, as a run without a window does.
TEST_F(WindowTest, SignalsEndIt) {
    for (const int signal : {SIGTERM, SIGINT}) {
        Window window = paused();
        settled(window);
        window.send(signal);
        EXPECT_EQ(window.wait(20), 128 + signal) << window.log();
        EXPECT_NE(window.log().find("stopped by a signal"), std::string::npos) << window.log();
    }
}

// A run without a step has nothing to lose.
TEST_F(WindowTest, EscapeLeavesAtOnceWhatHasNotBegun) {
    Window window = paused();
    settled(window);
    window.act("key r");
    settled(window);
    window.act("key Escape");
    EXPECT_EQ(window.wait(20), 0) << window.log();
}

TEST_F(WindowTest, KeysOfKnobsAreUndone) {
    Window window = paused();
    const Image before = settled(window);
    window.act("key 3 sleep 0.3");
    EXPECT_GT(difference(before, settled(window)), seen);
    window.act("key ctrl+z sleep 0.3");
    EXPECT_LT(difference(before, settled(window)), 1e-4);
}

TEST_F(WindowTest, WithoutAScreenItIsAnErrorOfItsOwn) {
    for (const char* driver : {"offscreen", "dummy"}) {
        const std::string command = std::string("DISPLAY= SDL_VIDEODRIVER=") + driver +
                                    " timeout 30 " + SPINDRIFT_PROGRAM +
                                    " test/dam_break_small >/dev/null 2>&1";
        EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5) << driver;
    }
}

}  // namespace
}  // namespace spindrift
