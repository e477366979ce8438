// Running, loading and resetting without a window.
#include "core/error.h"
#include "measure/checkpoint.h"
#include "play.h"

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

// Waits for what is made ready in the background. Throws what went wrong.
void finishLoading(Player& player) {
    while (!player.takeLoaded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(Player, RunsAndKeepsItsHistory) {
    Player player(ready(loadScene(small)));
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps >= 30; }));
    EXPECT_GT(player.measurement().time, 0);
    EXPECT_GE(player.curves().time.size(), 3u);
    EXPECT_EQ(player.curves().time.size(), player.curves().densityError.size());
}

TEST(Player, SingleStepIsOneStepAndPauses) {
    Player player(ready(loadScene(small)));
    player.stepOnce();
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps >= 1; }));
    play(player, [tries = 0]() mutable { return ++tries > 50; });
    EXPECT_EQ(player.measurement().steps, 1);
    EXPECT_FALSE(player.running);
}

TEST(Player, StopsAfterTheStepsAskedFor) {
    Scene scene = loadScene(small);
    scene.compute.steps = 7;
    Player player(ready(scene));
    EXPECT_TRUE(play(player, [&] { return !player.running; }));
    EXPECT_EQ(player.measurement().steps, 7);
}

TEST(Player, ResetBringsBackTheSceneAsLoadedButTheCamera) {
    Player player(ready(loadScene(small)));
    const Scene loaded = player.scene;
    player.scene.fluid.viscosity = 0.5f, player.scene.view.colorBy = ColorBy::Density,
    player.scene.view.camera.yaw = 77;
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 10; }));
    EXPECT_TRUE(player.unsaved());
    player.reset();
    finishLoading(player);
    EXPECT_EQ(player.measurement().steps, 0);
    EXPECT_FALSE(player.unsaved());
    EXPECT_TRUE(changedKnobs(player.scene, loaded, KnobKind::ButCamera).empty());
    EXPECT_EQ(player.scene.view.camera.yaw, 77);
    EXPECT_LE(player.curves().time.size(), 1u);
}

TEST(Player, ResetOfARunFromACheckpointIsTheCheckpoint) {
    Player first(ready(loadScene(small)));
    ASSERT_TRUE(play(first, [&] { return first.measurement().steps >= 5; }));
    const auto file = std::filesystem::temp_directory_path() /
                      ("spindrift-reset-" + std::to_string(getpid()) + ".h5");
    first.saveCheckpoint(file.string());
    EXPECT_FALSE(first.unsaved());
    const int64_t steps = first.measurement().steps;
    first.load(file.string());
    finishLoading(first);
    std::filesystem::remove(file);
    EXPECT_EQ(first.measurement().steps, steps);
    ASSERT_TRUE(play(first, [&] { return first.measurement().steps >= steps + 5; }));
    first.reset();
    finishLoading(first);
    EXPECT_EQ(first.measurement().steps, steps);
}

// What makes no sense in this scene, by the same checks as a file's.
TEST(Player, KnobsThatMakeNoSenseArePutBackWithAReason) {
    Player player(ready(loadScene(small)));
    const Scene before = player.scene;
    player.scene.fluid.surfaceTension = 1;  // of wcsph
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 3; }));
    EXPECT_TRUE(changedKnobs(player.scene, before, KnobKind::All).empty());
    EXPECT_NE(player.notice.find("fluid.surface_tension"), std::string::npos) << player.notice;
}

// A fluid that is made stiff at once would burst: its compression would be that much more energy.
TEST(Player, SpeedOfSoundIsReachedWithoutABlow) {
    for (const float wanted : {300.0f, 5.0f}) {
        Player player(ready(loadScene(small)));
        player.scene.view.speed = 10;
        ASSERT_TRUE(play(player, [&] { return player.measurement().time >= 0.01; }));
        const double energy =
            player.measurement().kineticEnergy + player.measurement().potentialEnergy;
        player.scene.fluid.soundSpeed = wanted;
        player.knobsChanged();
        double fastest = 0;
        EXPECT_TRUE(play(player, [&] {
            fastest = std::max(fastest, player.measurement().maxSpeed);
            return std::abs(player.measurement().soundSpeed / double(wanted) - 1) < 1e-3;
        })) << player.measurement().soundSpeed;
        EXPECT_LT(fastest, 6) << wanted;  // m/s: falls of 0.5 m and jets
        EXPECT_LT(player.measurement().kineticEnergy + player.measurement().potentialEnergy,
                  1.01 * energy)
            << wanted;
        EXPECT_TRUE(player.notice.empty()) << player.notice;
    }
}

// A fixed step that the run can't take: the guard goes back, and so does the knob.
TEST(Player, ChangesThatTheRunCannotFollowArePutBack) {
    Player player(ready(loadScene(small)));
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 5; }));
    player.scene.time.mode = TimeMode::Fixed, player.scene.time.step = 0.1f;
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return !player.notice.empty(); }));
    EXPECT_NE(player.notice.find("put back: time.mode, time.step"), std::string::npos)
        << player.notice;
    EXPECT_EQ(player.scene.time.mode, TimeMode::Cfl);
    const double time = player.measurement().time;
    EXPECT_TRUE(play(player, [&] { return player.measurement().time > time; })) << player.halted;
    EXPECT_GE(player.realTimeFactor(), 0);
    EXPECT_GE(player.stepsPerSecond(), 0);
}

TEST(Player, PlaysAsFastAsItIsAskedTo) {
    Scene scene = loadScene(small);
    scene.view.speed = 0.01f, scene.time.mode = TimeMode::Fixed, scene.time.step = 1e-4f;
    Player player(ready(scene));
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 10; }));
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_GE(wall, 0.09);  // 1 ms of the fluid's time, a hundred times slowed down
}

TEST(Player, LoadingIsCancelled) {
    Player player(ready(loadScene(small)));
    player.load(SPINDRIFT_SOURCE_DIR "/configs/oil_and_water.json");
    ASSERT_NE(player.loading(), nullptr);
    while (player.loading()->share == 0 && !player.takeLoaded())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    player.cancelLoading();
    EXPECT_EQ(player.loading(), nullptr);
    EXPECT_EQ(player.generation(), 1);
    EXPECT_TRUE(play(player, [&] { return player.measurement().steps >= 3; })) << "it still runs";
}

TEST(Player, BrokenFileChangesNothing) {
    const std::string broken = (std::filesystem::temp_directory_path() /
                                ("spindrift-broken-" + std::to_string(getpid()) + ".json"))
                                   .string();
    std::ofstream(broken) << R"({"version": 2, "fluid": {"viscosity": "thick"}})";
    Player player(ready(loadScene(small)));
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 5; }));
    const std::string before = writeScene(player.scene);
    const int64_t steps = player.measurement().steps;
    const int generation = player.generation();
    for (const std::string& file : {broken, std::string("/no/such/file.json")}) {
        try {
            player.load(file);
            finishLoading(player);
            ADD_FAILURE() << file << " was loaded";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::Scene);
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
    Player player(ready(loadScene(small)));
    const int count = player.simulation().fluidCount();
    player.load(SPINDRIFT_SOURCE_DIR "/configs/test/ball_drop_small.json");
    finishLoading(player);
    EXPECT_NE(player.simulation().fluidCount(), count);
    EXPECT_EQ(player.measurement().steps, 0);
    EXPECT_EQ(player.generation(), 2);
}

TEST(Player, TroubleThatShorterStepsCantHelpHaltsTheRunAndMarksParticles) {
    Scene scene = loadScene(small);
    scene.time.mode = TimeMode::Fixed, scene.time.step = 0.5f, scene.time.retries = 1;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return !player.halted.empty(); }));
    EXPECT_FALSE(player.running);
    EXPECT_NE(player.notice.find("try 1 of 1"), std::string::npos) << player.notice;
    EXPECT_NE(player.halted.find("diverged at step"), std::string::npos) << player.halted;
    EXPECT_FALSE(player.culprits.empty());
    const auto file = std::filesystem::temp_directory_path() /
                      ("spindrift-good-" + std::to_string(getpid()) + ".h5");
    player.saveCheckpoint(file.string());
    EXPECT_EQ(readCheckpoint(file.string()).state.clock.steps, 0) << "the last good state";
    std::filesystem::remove(file);
    player.reset();
    finishLoading(player);
    EXPECT_TRUE(player.halted.empty() && player.notice.empty() && player.culprits.empty());
}

TEST(Player, ProbesInsideASolidAreNoticed) {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/solids_small.json");
    scene.output.probes = {Probe{}};
    scene.output.probes[0].position = {0.8f, 0.15f, 0.4f};
    EXPECT_NE(Player(ready(scene)).notice.find("(probe) is inside solids[2]"), std::string::npos);
    scene.output.probes[0].position = {0.5f, 0.15f, 0.4f};
    EXPECT_EQ(Player(ready(scene)).notice, "");
}

// Curves go on where the run before had them: in the checkpoint of a window, or in a series.
TEST(Player, CurvesOfARunThatGoesOnShowAllOfIt) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("spindrift-curves-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string kept = (folder / "kept.h5").string(), plain = (folder / "plain.h5").string(),
                      series = (folder / "run.csv").string();
    Player player(ready(loadScene(small)));
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 20; }));
    player.saveCheckpoint(kept);
    const Curves before = player.curves();
    ASSERT_GE(before.time.size(), 2u);
    player.load(kept);
    finishLoading(player);
    // The run may have been a few steps further than what had been measured of it.
    const Curves& after = player.curves();
    ASSERT_GE(after.time.size(), before.time.size());
    for (size_t i = 0; i < before.time.size(); ++i) {
        EXPECT_EQ(after.time[i], before.time[i]);
        EXPECT_FLOAT_EQ(after.total[i], before.total[i]);
        EXPECT_EQ(after.densityError[i], before.densityError[i]);
    }

    // The same run's series, up to its last row and beyond; and one of another run.
    const Checkpoint c = readCheckpoint(kept);
    const auto load = [&](double scale) {
        Scene scene = c.scene;
        scene.output.csv = "run.csv";
        std::ofstream csv(series);
        csv.precision(9);
        csv << "time [s],step,kinetic_energy [J],potential_energy [J],density_error [1]\n";
        for (const double share : {0.0, 0.5, 1.5})
            csv << scale * share * c.state.clock.time << ","
                << int64_t(share * double(c.state.clock.steps)) << ",1,2,0.01\n";
        csv.close();
        writeCheckpoint(plain, scene, c.state);
        player.load(plain);
        finishLoading(player);
        return player.curves();
    };
    const Curves own = load(1), others = load(10);
    ASSERT_EQ(own.time.size(), 3u) << "two rows, and where it stands";
    EXPECT_FLOAT_EQ(own.time[1], float(0.5 * c.state.clock.time));
    EXPECT_EQ(own.total[1], 3);
    EXPECT_EQ(own.densityError[1], 0.01f);
    EXPECT_EQ(others.time.size(), 1u);
    std::filesystem::remove_all(folder);
}

TEST(Curves, ThinsOutInsteadOfGrowing) {
    Curves history;
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
