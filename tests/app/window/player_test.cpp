// Running, loading and resetting without a window.
#include "app/window/player.h"

#include "core/error.h"
#include "measure/checkpoint.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <unistd.h>

namespace spindrift {
namespace {

const std::string small = SPINDRIFT_SOURCE_DIR "/configs/test/dam_break_small.json";

// Plays until `done` or for ten seconds.
template <class Done>
bool play(Player& player, Done done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < end) {
        bool moved = false;
        if (player.collect(moved)) {
            if (done()) return true;
            player.proceed(0.005);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

TEST(Player, RunsAndKeepsItsHistory) {
    Player player(loadScene(small));
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps >= 30; }));
    EXPECT_GT(player.measurement().time, 0);
    EXPECT_GE(player.history().time.size(), 3u);
    EXPECT_EQ(player.history().time.size(), player.history().densityError.size());
}

TEST(Player, SingleStepIsOneStepAndPauses) {
    Player player(loadScene(small));
    player.stepOnce();
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps >= 1; }));
    play(player, [tries = 0]() mutable { return ++tries > 50; });
    EXPECT_EQ(player.measurement().steps, 1);
    EXPECT_FALSE(player.running);
}

TEST(Player, StopsAfterTheStepsAskedFor) {
    Scene scene = loadScene(small);
    scene.compute.steps = 7;
    Player player(scene);
    EXPECT_TRUE(play(player, [&] { return !player.running; }));
    EXPECT_EQ(player.measurement().steps, 7);
}

TEST(Player, ResetStartsAgainAndKeepsTheKnobs) {
    Player player(loadScene(small));
    player.scene.fluid.viscosity = 0.5f;
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 10; }));
    player.reset();
    EXPECT_EQ(player.measurement().steps, 0);
    EXPECT_EQ(player.scene.fluid.viscosity, 0.5f);
    EXPECT_LE(player.history().time.size(), 1u);
}

TEST(Player, BrokenFileChangesNothing) {
    const std::string broken = (std::filesystem::temp_directory_path() /
                                ("spindrift-broken-" + std::to_string(getpid()) + ".json"))
                                   .string();
    std::ofstream(broken) << R"({"version": 2, "fluid": {"viscosity": "thick"}})";
    Player player(loadScene(small));
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 5; }));
    const std::string before = writeScene(player.scene);
    const int64_t steps = player.measurement().steps;
    const int generation = player.generation();
    for (const std::string& file : {broken, std::string("/no/such/file.json")}) {
        try {
            player.load(file);
            ADD_FAILURE() << file << " was loaded";
        } catch (const Error& error) {
            EXPECT_EQ(error.exit, Exit::Scene);
            EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
        }
    }
    std::filesystem::remove(broken);
    EXPECT_EQ(writeScene(player.scene), before);
    EXPECT_EQ(player.measurement().steps, steps);
    EXPECT_EQ(player.generation(), generation);
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps > steps; }))
        << "it still runs";
}

TEST(Player, LoadReplacesSceneAndSimulation) {
    Player player(loadScene(small));
    const int count = player.simulation().fluidCount();
    player.load(SPINDRIFT_SOURCE_DIR "/configs/test/ball_drop_small.json");
    EXPECT_NE(player.simulation().fluidCount(), count);
    EXPECT_EQ(player.measurement().steps, 0);
    EXPECT_EQ(player.generation(), 2);
}

TEST(Player, TroubleThatShorterStepsCantHelpHaltsTheRunAndMarksParticles) {
    Scene scene = loadScene(small);
    scene.time.mode = TimeMode::Fixed, scene.time.step = 0.5f, scene.time.retries = 1;
    Player player(scene);
    ASSERT_TRUE(play(player, [&] { return !player.halted.empty(); }));
    EXPECT_FALSE(player.running);
    EXPECT_NE(player.notice.find("try 1 of 1"), std::string::npos) << player.notice;
    EXPECT_NE(player.halted.find("diverged at step"), std::string::npos) << player.halted;
    EXPECT_FALSE(player.culprits.empty());
    const auto file = std::filesystem::temp_directory_path() / ("spindrift-good-" + std::to_string(getpid()) + ".h5");
    player.saveCheckpoint(file.string());
    EXPECT_EQ(readCheckpoint(file.string()).state.clock.steps, 0) << "the last good state";
    std::filesystem::remove(file);
    player.reset();
    EXPECT_TRUE(player.halted.empty() && player.notice.empty() && player.culprits.empty());
}

TEST(History, ThinsOutInsteadOfGrowing) {
    History history;
    Measurement m;
    for (int i = 0; i < 10000; ++i) {
        m.time = i;
        history.add(m);
    }
    EXPECT_LE(history.time.size(), 1024u);
    EXPECT_EQ(history.time.front(), 0);
    EXPECT_GT(history.time.back(), 9950);
    // The beginning keeps as many samples as the end.
    for (size_t i = 1; i < history.time.size(); ++i) {
        EXPECT_GT(history.time[i], history.time[i - 1]);
        EXPECT_LT(history.time[i] - history.time[i - 1], 40);
    }
}

}  // namespace
}  // namespace spindrift
