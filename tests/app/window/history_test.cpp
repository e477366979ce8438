// Moments of a run: how many are kept and which, and that the run goes on from each with the bits
// that it had.
#include "app/window/replay.h"
#include "core/error.h"
#include "measure/checkpoint.h"
#include "play.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include <unistd.h>

namespace spindrift {
namespace {

const std::string Configs = SPINDRIFT_SOURCE_DIR "/configs/test/";

// --- without a simulation ---

RunState stateAt(double time, int64_t steps, size_t particles) {
    RunState state;
    state.clock.time = time, state.clock.steps = steps;
    state.particles.positions.resize(particles), state.particles.velocities.resize(particles);
    state.particles.walls.resize(particles);
    return state;
}

void keep(History& history, double time, int64_t steps, size_t particles, double cost = 0) {
    const Scene scene;
    history.add(stateAt(time, steps, particles), Measurement{}, scene, scene, cost);
}

// Moments at even times, as long as they are due.
void keepEvenly(History& history, int count, size_t particles) {
    for (int i = 0; i < count; ++i) {
        history.passed(1);
        if (history.isDue(0.1 * i, 10 * i)) keep(history, 0.1 * i, 10 * i, particles);
        ASSERT_LE(double(history.bytes()), 5e6) << i;
    }
}

TEST(History, KeepsToItsBudgetAndCoversAllOfTheRunEvenly) {
    for (const size_t particles : {1, 100, 3000, 10000, 40000}) {
        SCOPED_TRACE(particles);
        History history;
        history.setBudget(5);
        for (const int count : {2, 3, 40, 1000, 3000}) {
            history.clear();
            keepEvenly(history, count, particles);
            ASSERT_GE(history.size(), 2u);
            EXPECT_EQ(history[0].time(), 0) << "the first one stays";
            const double last = 0.1 * (count - 1);
            double widest = 0;
            for (size_t i = 1; i < history.size(); ++i)
                widest = std::max(widest, history[i].time() - history[i - 1].time());
            EXPECT_LE(last - history.back().time(), widest + 0.1) << "up to now";
            // At worst half of the budget has just been emptied, but for the room that the last
            // one needs.
            const double each = 24.0 * double(particles) + 2500,
                         fitting = std::min((5e6 - 12.0 * double(particles)) / each, double(count));
            EXPECT_LE(widest, std::max(4.5 * last / std::max(fitting - 1, 1.0), 0.101)) << count;
        }
    }
}

// It goes back again and again, to its beginning and to other places, and is done once more where
// it was done before: what is kept covers the run as well as at first.
TEST(History, CoversARunThatGoesBackAsEvenly) {
    for (const double to : {-1.0, 0.0, 30.0, 150.0}) {
        SCOPED_TRACE(to);
        History history;
        history.setBudget(5);
        size_t first = 0;
        for (int times = 0; times < 6; ++times) {
            history.dropAfter(to);
            int begin = history.empty() ? 0 : int(std::lround(10 * history.back().time())) + 1;
            for (int i = times > 0 ? begin : 0; i < 3000; ++i) {
                history.passed(1);
                if (history.isDue(0.1 * i, 10 * i) && !history.isNearTheLast(0.1 * i))
                    keep(history, 0.1 * i, 10 * i, 3000);
            }
            double widest = 0;
            for (size_t i = 1; i < history.size(); ++i)
                widest = std::max(widest, history[i].time() - history[i - 1].time());
            if (times == 0) first = history.size();
            EXPECT_GE(2 * history.size(), first) << times;
            EXPECT_LE(widest, 4.5 * 300 / double(first)) << times;
        }
    }
}

TEST(History, KeepsNothingWhereTwoMomentsAreTooMuch) {
    History history;
    history.setBudget(0.5);
    keepEvenly(history, 20, 20000);
    EXPECT_TRUE(history.empty());
    EXPECT_TRUE(history.isTooSmall());
    EXPECT_FALSE(history.isDue(100, 1000)) << "what fails every time costs nothing";
    history.setBudget(5);
    EXPECT_TRUE(history.isDue(100, 1000));
}

TEST(History, BudgetMayChangeAndBeNone) {
    History history;
    history.setBudget(5);
    keepEvenly(history, 200, 1000);
    const size_t before = history.size();
    const double last = history.back().time();
    history.setBudget(1);
    EXPECT_LE(double(history.bytes()), 1e6);
    EXPECT_LT(history.size(), before);
    EXPECT_GT(history.size(), 10u);
    EXPECT_EQ(history.back().time(), last) << "it stays";
    history.setBudget(0);
    EXPECT_TRUE(history.empty());
    EXPECT_FALSE(history.isOn());
    EXPECT_FALSE(history.isDue(1e3, 1000));
}

// What it costs to keep one must have been a small share of the time since the last.
TEST(History, TakesItsShareOfTheRunsTimeAtMost) {
    for (const double cost : {1e-4, 1e-3, 0.05, 2.0}) {
        History history;
        history.setBudget(1000);
        double wall = 0, spent = 0;
        for (int64_t step = 0; wall < 5000 * cost; ++step) {
            if (history.isDue(1e-3 * double(step), step)) {
                keep(history, 1e-3 * double(step), step, 10, cost);
                spent += cost;
            }
            history.passed(0.3 * cost), wall += 0.3 * cost;
        }
        EXPECT_LE(spent - 2 * cost, History::share * wall) << cost;  // the first is free
        if (cost / History::share > 0.05) { EXPECT_GE(spent, 0.9 * History::share * wall) << cost; }
    }
}

TEST(History, FutureIsDroppedAndTimesAreFound) {
    History history;
    history.setBudget(5);
    keepEvenly(history, 10, 10);
    EXPECT_EQ(history.at(-1), 0u);
    EXPECT_EQ(history.at(0.34), 3u);
    EXPECT_EQ(history.at(0.36), 4u);
    EXPECT_EQ(history.at(99), 9u);
    EXPECT_EQ(history.state(4).particles.walls.size(), 10u) << "as the simulation gave it";
    history.dropAfter(0.45);
    ASSERT_EQ(history.size(), 5u);
    EXPECT_DOUBLE_EQ(history.back().time(), 0.4);
    // It is done again where it was done, there alone.
    EXPECT_EQ(history.stepsToNext(40), 10);
    history.passed(1000);
    EXPECT_FALSE(history.isDue(0.44, 44));
    EXPECT_TRUE(history.isDue(0.5, 50));
    history.clear();
    EXPECT_TRUE(history.empty());
    EXPECT_EQ(history.stepsToNext(0), History::never);
    EXPECT_EQ(history.at(1), 0u);
}

TEST(Replay, PlaysAtItsPaceToTheEndOrInALoop) {
    History history;
    history.setBudget(5);
    keepEvenly(history, 11, 10);  // 1 s
    Replay replay;
    EXPECT_EQ(replay.next(history, 3, 10, 1), 3u) << "it doesn't play";
    replay.start();
    size_t at = 0;
    for (int i = 0; i < 21; ++i) at = replay.next(history, at, 0.0101, 2);  // 0.42 s at 2 x
    EXPECT_EQ(at, 4u);
    EXPECT_EQ(replay.next(history, at, 0.3, 1), 7u) << "what comes too late is left out";
    at = replay.next(history, 7, 100, 1);
    EXPECT_EQ(at, 10u);
    EXPECT_FALSE(replay.playing) << "the end";
    replay.loops = true;
    replay.start();
    EXPECT_EQ(replay.next(history, 10, 0.15, 1), 0u);
    EXPECT_TRUE(replay.playing);
    replay.isEven = true;
    replay.start();
    EXPECT_EQ(replay.next(history, 2, 100, 1), 3u) << "none is left out";
    EXPECT_EQ(replay.next(history, 3, 0.5 / Replay::evenRate, 1), 3u);
    EXPECT_EQ(replay.next(history, 3, 0.6 / Replay::evenRate, 100), 4u);
    History one;
    one.setBudget(5);
    keep(one, 0, 0, 10);
    EXPECT_EQ(replay.next(one, 0, 100, 1), 0u);
}

// --- of a run ---

void expectSame(const RunState& a, const RunState& b) {
    EXPECT_EQ(a.clock.time, b.clock.time);
    EXPECT_EQ(a.clock.dt, b.clock.dt);
    EXPECT_EQ(a.particles.positions, b.particles.positions);
    EXPECT_EQ(a.particles.velocities, b.particles.velocities);
    EXPECT_EQ(a.particles.walls, b.particles.walls);
    EXPECT_EQ(a.particles.ids, b.particles.ids);
    EXPECT_EQ(a.particles.heldBy, b.particles.heldBy);
    EXPECT_EQ(a.densities, b.densities);
    EXPECT_EQ(a.pressures, b.pressures);
    EXPECT_EQ(a.objects.positions, b.objects.positions);
    EXPECT_EQ(a.objects.velocities, b.objects.velocities);
    EXPECT_EQ(a.objects.broken, b.objects.broken);
    EXPECT_EQ(a.sources.came, b.sources.came);
    EXPECT_EQ(a.sources.left, b.sources.left);
    ASSERT_EQ(a.solids.size(), b.solids.size());
    for (size_t i = 0; i < a.solids.size(); ++i) {
        EXPECT_EQ(a.solids[i].centre, b.solids[i].centre);
        EXPECT_EQ(a.solids[i].velocity, b.solids[i].velocity);
        EXPECT_EQ(a.solids[i].turn, b.solids[i].turn);
        EXPECT_EQ(a.solids[i].angularMomentum, b.solids[i].angularMomentum);
    }
}

// All that is kept while it plays, by its steps, until so many are; some of it goes again.
std::map<int64_t, RunState> playAndKeep(Player& player, size_t count) {
    std::map<int64_t, RunState> kept;
    const auto look = [&] {
        const History& history = player.history();
        if (!history.empty()) {
            const size_t last = history.size() - 1;
            kept.try_emplace(history[last].state.clock.steps, history.state(last));
            player.scene.view.history = 3.5e-6f * float(history.bytes()) / float(last + 1);
        }
        return kept.size() >= count || !player.halted.empty();
    };
    EXPECT_TRUE(play(player, look, 30));
    return kept;
}

// Goes on from a moment until it has come as far as before; returns how many moments had the same
// bits.
size_t sameAfter(Player& player, size_t moment, const std::map<int64_t, RunState>& before) {
    player.scene.view.history = 100;  // room for those that had gone
    player.look(moment);
    player.goOnFromHere();
    EXPECT_FALSE(player.looksBack());
    EXPECT_EQ(player.history().size(), moment + 1) << "the future is dropped";
    std::map<int64_t, RunState> again;
    const auto look = [&] {
        const size_t last = player.history().size() - 1;
        const int64_t steps = player.history()[last].state.clock.steps;
        again.try_emplace(steps, player.history().state(last));
        return steps >= before.rbegin()->first;
    };
    EXPECT_TRUE(play(player, look, 30));
    size_t same = 0;
    for (const auto& [steps, state] : again)
        if (const auto other = before.find(steps); other != before.end())
            expectSame(state, other->second), ++same;
    return same;
}

// Each kind of scene, with what it carries from step to step.
std::vector<Scene> sweep() {
    std::vector<Scene> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(Configs))
        if (entry.path().extension() == ".json") scenes.push_back(loadScene(entry.path().string()));
    EXPECT_GE(scenes.size(), 11u);
    Scene scene = loadScene(Configs + "dam_break_small.json");
    for (const Formulation f :
         {Formulation::DeltaSph, Formulation::DeltaPlus, Formulation::Incompressible}) {
        scene.simulation.formulation = f;
        scene.name = "dam break, another formulation";
        scenes.push_back(scene);
    }
    scene.simulation.formulation = Formulation::Wcsph;
    for (const Integrator i : {Integrator::VelocityVerlet, Integrator::PredictorCorrector}) {
        scene.name = "dam break, another integrator";
        scene.time.integrator = i;
        scenes.push_back(scene);
    }
    scene.name = "dam break, split", scene.time.integrator = Integrator::Split;
    scene.simulation.formulation = Formulation::DeltaSph;
    scenes.push_back(scene);
    scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/validation/taylor_green.json");
    scenes.push_back(scene);
    return scenes;
}

TEST(LookingBack, RunGoesOnFromAnyMomentWithTheBitsThatItHad) {
    for (Scene scene : sweep()) {
        SCOPED_TRACE(scene.name);
        scene.view.speed = 10;
        Player player(ready(scene));
        const std::map<int64_t, RunState> before = playAndKeep(player, 6);
        ASSERT_TRUE(player.lookBack());
        ASSERT_LT(player.history().size(), before.size()) << "some have gone";
        if (player.history()[1].state.clock.steps < before.rbegin()->first) {
            EXPECT_GE(sameAfter(player, 1, before), 2u);
        }
        ASSERT_TRUE(player.lookBack());
        EXPECT_EQ(sameAfter(player, 0, before), before.size()) << "also those that have gone";
    }
}

// What a history keeps nothing of for want of room is said as that, whenever it is asked for.
TEST(LookingBack, SaysWhyThereIsNothing) {
    for (const float budget : {0.0f, 0.001f}) {
        Scene scene = loadScene(Configs + "dam_break_small.json");
        scene.view.history = budget;
        Player player(ready(scene));
        ASSERT_TRUE(play(player, [&] { return player.measurement().steps > 40; }));
        for (int again = 0; again < 2; ++again) {
            player.notice.clear();
            EXPECT_FALSE(player.lookBack());
            EXPECT_NE(player.notice.find(budget == 0 ? "view.history is 0" : "two moments take"),
                      std::string::npos)
                << player.notice;
        }
    }
}

// With local steps, which a restart would wake: it would take them hundreds of steps to rest again.
TEST(LookingBack, FluidThatRestsIsNotWokenByWhatIsKept) {
    Scene scene;
    scene.simulation.dimensions = 2, scene.simulation.spacing = 0.02f;
    scene.domain.max = {0.4f, 0.3f, 1};
    scene.fluid.bodies[0].min = {0, 0, 0}, scene.fluid.bodies[0].max = {0.4f, 0.1f, 1};
    scene.fluid.artificialViscosity = 0.5f;
    scene.time.mode = TimeMode::Local, scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(
        player, [&] { return player.simulation().clock().awake == 0; }, 60));
    const double evaluations = player.measurement().evaluations;
    const size_t kept = player.history().size();
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= kept + 3; }));
    EXPECT_EQ(player.measurement().evaluations, evaluations);
    ASSERT_TRUE(player.lookBack());
    player.look(1);
    ASSERT_TRUE(
        play(player, [&] { return player.measurement().time == player.history()[1].time(); }));
    player.goOnFromHere();
    const double time = player.measurement().time;
    EXPECT_TRUE(play(player, [&] { return player.measurement().time > time + 0.1; }));
}

TEST(LookingBack, ShowsWhatWasAndReturnsToWhatIs) {
    Scene scene = loadScene(Configs + "dam_break_small.json");
    scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= 4; }));
    ASSERT_TRUE(player.lookBack());
    EXPECT_FALSE(player.running) << "it stands still meanwhile";
    const size_t last = player.history().size() - 1;
    const RunState present = player.history().state(last);
    for (const size_t i : {size_t(1), size_t(0), last, size_t(2)}) {
        player.look(i);
        ASSERT_TRUE(
            play(player, [&] { return player.measurement().time == player.history()[i].time(); }));
        // As the checkpoint of this moment.
        expectSame(player.simulation().state(), player.history().state(i));
        EXPECT_EQ(player.measurement().steps, player.history()[i].state.clock.steps);
    }
    EXPECT_TRUE(player.unsaved()) << "of the present";
    player.returnToPresent();
    ASSERT_TRUE(play(player, [&] { return !player.looksBack(); }));
    EXPECT_TRUE(player.running);
    expectSame(player.simulation().state(), present);
    EXPECT_EQ(player.history().size(), last + 1) << "nothing is lost";
    EXPECT_TRUE(play(player, [&] { return player.measurement().time > present.clock.time; }));
    player.reset();
    while (!player.takeLoaded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(player.history().empty()) << "of another run";
}

TEST(LookingBack, KnobsAreThoseOfTheMoment) {
    Scene scene = loadScene(Configs + "dam_break_small.json");
    scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= 2; }));
    const float before = player.scene.fluid.viscosity;
    const size_t kept = player.history().size();
    player.scene.fluid.viscosity = 2;
    player.scene.view.colorBy = ColorBy::Density;
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= kept + 3; }));
    ASSERT_TRUE(player.lookBack());
    player.look(0);
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps == 0; }));
    EXPECT_EQ(player.scene.fluid.viscosity, before);
    EXPECT_EQ(player.scene.view.colorBy, ColorBy::Density) << "looks are those of now";
    player.scene.fluid.viscosity = 0.5f;
    player.knobsChanged();
    player.look(1);
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps > 0; }));
    EXPECT_NE(player.notice.find("fluid.viscosity"), std::string::npos) << player.notice;
    EXPECT_EQ(player.scene.fluid.viscosity, before);
    player.scene.fluid.viscosity = 0.25f;
    player.knobsChanged();
    player.goOnFromHere();
    EXPECT_EQ(player.scene.fluid.viscosity, 0.25f) << "what is changed there counts";
    const int64_t steps = player.measurement().steps;
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps > steps; }));
    ASSERT_TRUE(player.lookBack());
    EXPECT_EQ(player.history().back().asked->fluid.viscosity, 0.25f);
    EXPECT_EQ(player.history().back().inForce->fluid.viscosity, 0.25f);
    player.returnToPresent();
    ASSERT_TRUE(play(player, [&] { return !player.looksBack(); }));
    player.running = false;
    player.scene.fluid.viscosity = 0.75f;  // no step is made with it before it looks back
    player.knobsChanged();
    ASSERT_TRUE(player.lookBack());
    player.look(0);
    ASSERT_TRUE(play(player, [&] { return player.measurement().steps == 0; }));
    player.returnToPresent();
    ASSERT_TRUE(play(player, [&] { return !player.looksBack(); }));
    EXPECT_EQ(player.scene.fluid.viscosity, 0.75f);
}

TEST(LookingBack, AnotherFormulationIsThatOfTheMomentToo) {
    Scene scene = loadScene(Configs + "dam_break_small.json");
    scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= 2; }));
    player.goOnWith(Formulation::Incompressible, Backend::Cpu);
    const size_t kept = player.history().size();
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= kept + 2; }));
    ASSERT_TRUE(player.lookBack());
    EXPECT_THROW(player.goOnWith(Formulation::Wcsph, Backend::Cpu), Error);
    const RunState present = player.simulation().state();
    player.look(1);
    ASSERT_TRUE(
        play(player, [&] { return player.measurement().time == player.history()[1].time(); }));
    EXPECT_FALSE(player.simulation().measure().solvesPressure);
    EXPECT_EQ(player.scene.simulation.formulation, Formulation::Wcsph);
    player.returnToPresent();
    ASSERT_TRUE(play(player, [&] { return !player.looksBack(); }));
    EXPECT_TRUE(player.simulation().measure().solvesPressure);
    expectSame(player.simulation().state(), present);
}

TEST(LookingBack, CurvesAndCheckpointsAreThoseOfTheMoment) {
    Scene scene = loadScene(Configs + "dam_break_small.json");
    scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= 4; }));
    const size_t samples = player.curves().time.size();
    ASSERT_TRUE(player.lookBack());
    player.look(1);
    ASSERT_TRUE(
        play(player, [&] { return player.measurement().time == player.history()[1].time(); }));
    EXPECT_GE(player.curves().time.size(), samples) << "the whole run's";
    const std::string file = (std::filesystem::temp_directory_path() /
                              ("spindrift-moment-" + std::to_string(getpid()) + ".h5"))
                                 .string();
    player.saveCheckpoint(file);
    expectSame(readCheckpoint(file).state, player.simulation().state());
    std::filesystem::remove(file);
    player.goOnFromHere();
    EXPECT_LE(player.curves().time.back(), float(player.measurement().time));
    EXPECT_EQ(player.history().size(), 2u);
    EXPECT_FALSE(player.unsaved());
    ASSERT_TRUE(play(player, [&] {
        return player.measurement().steps > player.history()[1].measurement.steps;
    }));
    EXPECT_TRUE(player.unsaved());
}

TEST(LookingBack, RunThatDivergedGoesOnFromBefore) {
    Scene scene = loadScene(Configs + "dam_break_small.json");
    scene.time.retries = 0, scene.view.speed = 10;
    Player player(ready(scene));
    ASSERT_TRUE(play(player, [&] { return player.history().size() >= 3; }));
    player.scene.time.mode = TimeMode::Fixed, player.scene.time.step = 0.5f;
    player.knobsChanged();
    ASSERT_TRUE(play(player, [&] { return !player.halted.empty(); }));
    ASSERT_TRUE(player.lookBack());
    player.look(1);
    ASSERT_TRUE(
        play(player, [&] { return player.measurement().time == player.history()[1].time(); }));
    player.goOnFromHere();
    EXPECT_TRUE(player.halted.empty() && player.culprits.empty());
    const double time = player.measurement().time;
    EXPECT_TRUE(play(player, [&] { return player.measurement().time > time + 0.01; }));
    EXPECT_TRUE(player.halted.empty()) << player.halted;
    EXPECT_EQ(player.scene.time.mode, TimeMode::Cfl);
}

TEST(LookingBack, WithoutABudgetItSaysSo) {
    for (const float budget : {0.0f, 1e-3f}) {
        Scene scene = loadScene(Configs + "dam_break_small.json");
        scene.view.history = budget;
        Player player(ready(scene));
        ASSERT_TRUE(play(player, [&] { return player.measurement().steps >= 5; }));
        EXPECT_EQ(budget > 0, !player.notice.empty()) << player.notice;
        player.notice.clear();
        EXPECT_FALSE(player.lookBack());
        EXPECT_NE(player.notice, "");
        EXPECT_TRUE(player.running);
    }
}

}  // namespace
}  // namespace spindrift
