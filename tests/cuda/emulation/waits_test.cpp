// What the host waits for, and what it starts: nothing in a step, whatever the run is asked for
// beside it; one wait for a picture (interop_test.cpp), a state or a look at where things are; none
// for the mouse, which neither outdates what was recorded.
#include "app/headless.h"
#include "app/scene_choice.h"
#include "cuda/gpu.h"
#include "emulation.h"
#include "sim/make_simulation.h"

#include <filesystem>

namespace spindrift {
namespace {

using emulation::Counts, emulation::countsOf;

class Waits : public testing::Test {
protected:
    void TearDown() override { emulation::machine = {}; }
    // A run whose steps are recorded.
    static std::unique_ptr<Simulation> start(const Scene& s) {
        auto gpu = makeCudaSimulation(s, placeParticles(s), 0);
        recorded(*gpu);
        return gpu;
    }
    static void recorded(Simulation& gpu) {
        gpu.step(3);  // one pass by pass, one for each side of the buffers
        gpu.wait();
    }
    static void expectOnlySteps(const Counts& c, int steps) {
        EXPECT_EQ(c.waits, 0);
        EXPECT_EQ(c.launches, steps);
        EXPECT_EQ(c.recordings, 0);
        EXPECT_EQ(c.allocations, 0);
    }
};

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (const char* file : {"dam_break_small.json", "solids_small.json", "floating_small.json",
                             "artery_small.json", "tap_small.json", "mixture_small.json"})
        all.push_back(testScene(file));
    all.push_back(all[0]);
    all.back().simulation.formulation = Formulation::Incompressible;
    return all;
}

TEST_F(Waits, NoneInAStep) {
    for (const Scene& scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const auto gpu = start(scene);
        const Counts c = countsOf([&] { gpu->step(20); });
        // Solved pressures: before, in and after the loop.
        expectOnlySteps(c, scene.simulation.formulation == Formulation::Incompressible ? 60 : 20);
        EXPECT_EQ(c.copies, 0);
    }
}

// As a run does that has rows, frames and an end due. The step that ends there is waited for, and
// those from which it can't be told without.
TEST_F(Waits, WhereARowMayBeDueOnly) {
    for (const bool keepsUp : {true, false}) {
        SCOPED_TRACE(keepsUp ? "the device keeps up" : "the host is ahead");
        emulation::machine.keepsUp = keepsUp;
        const auto gpu = start(scenes()[0]);
        const double row = 40 * gpu->clock().dt;
        int64_t steps = 0;
        constexpr int Rows = 5;
        const Counts c = countsOf([&] {
            for (int k = 1; k <= Rows; ++k)
                for (bool due = false; !due; ++steps) {
                    gpu->stopAt(k * row);
                    gpu->step();
                    due = gpu->hasReached(k * row);
                    if (due) { EXPECT_EQ(gpu->clock().time, k * row); }
                }
        });
        EXPECT_GT(steps, 30 * Rows);
        EXPECT_LE(c.waits, (keepsUp ? 3 : 6) * Rows);
        EXPECT_GE(c.waits, Rows);
        EXPECT_EQ(c.recordings, 0);
    }
}

TEST_F(Waits, AHeadlessRunIsWaitedForWhereItIsLookedAt) {
    emulation::machine.keepsUp = true;
    Start begin;
    begin.scene = scenes()[0];
    begin.scene.compute.backend = Backend::Cuda;
    begin.scene.output.csv = testing::TempDir() + "waits.csv";
    begin.file = "dam_break_small.json";
    begin.scene.output.time = 0.1f, begin.scene.output.fps = 50;
    const Counts c = countsOf([&] { EXPECT_EQ(runHeadless(begin, true), 0); });
    EXPECT_GT(c.replays, 100);
    EXPECT_LT(double(c.waits), 0.6 * double(c.replays));
    std::filesystem::remove(begin.scene.output.csv);
}

struct Pusher : ObjectDriver {
    double every;
    int asked = 0;
    explicit Pusher(double s) : every(s) {}
    double interval() const override { return every; }
    void exchange(double, const std::vector<Vec3d>&, std::vector<Vec3d>& positions,
                  std::vector<Vec3d>&) override {
        ++asked;
        for (Vec3d& x : positions) x.x += 1e-5;
    }
};

// The clock, and what the engine is to know.
TEST_F(Waits, WhereAnEngineOfOnesOwnIsAskedOnly) {
    emulation::machine.keepsUp = true;
    const auto gpu = start(testScene("artery_small.json"));
    Pusher pusher(20 * gpu->clock().dt);
    gpu->drive(&pusher);
    recorded(*gpu);
    const int before = pusher.asked;
    const Counts c = countsOf([&] { gpu->step(100); });
    const int asked = pusher.asked - before;
    EXPECT_GE(asked, 3);
    EXPECT_LE(c.waits, 4 * asked);
    EXPECT_EQ(c.recordings, 0) << "what it says is in memory of the device";
    EXPECT_EQ(c.allocations, 0);
}

TEST_F(Waits, NoneForTheMouse) {
    for (const Scene& scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const auto gpu = start(scene);
        const bool solves = scene.simulation.formulation == Formulation::Incompressible;
        const Vec3 middle = scene.domain.min + 0.5f * (scene.domain.max - scene.domain.min);
        const auto stir = [&](float at) { gpu->stir({at * middle, 0.1f, {at, 0, 0}}); };
        stir(1);  // a pass more
        recorded(*gpu);
        Counts c = countsOf([&] {
            for (int k = 0; k < 10; ++k) stir(1 + 0.01f * float(k)), gpu->step();
        });
        expectOnlySteps(c, solves ? 30 : 10);
        EXPECT_EQ(c.copies, 10);
        gpu->stir({});
        if (scene.solids.empty()) continue;
        gpu->hold({0, middle});  // a plan in which it moves
        recorded(*gpu);
        c = countsOf([&] {
            for (int k = 0; k < 10; ++k)
                gpu->hold({0, (1 + 0.01f * float(k)) * middle}), gpu->step();
        });
        expectOnlySteps(c, solves ? 30 : 10);
        EXPECT_EQ(c.copies, 10);
    }
}

// Where the mouse is seen by what was recorded before it was there.
TEST_F(Waits, WhatTheMouseSaysIsHeard) {
    const auto gpu = start(scenes()[0]);
    const Vec3 at = toFloat(gpu->particle(0).position);
    gpu->stir({at + Vec3{10, 0, 0}, 0.1f, {5, 0, 0}});  // where there is no fluid
    recorded(*gpu);
    const double before = gpu->particle(0).velocity.x;
    gpu->stir({at, 0.1f, {5, 0, 0}});
    gpu->step(5);
    EXPECT_GT(gpu->particle(0).velocity.x, before + 0.1);
}

TEST_F(Waits, OneForAStateAndForALook) {
    for (const Scene& scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const auto gpu = start(scene);
        gpu->step(5);
        Counts c = countsOf([&] {
            gpu->clock(), gpu->fluidCount(), gpu->solidPoses(), gpu->solidAt({0, 0, 0});
            gpu->hasReached(0), gpu->wait();
        });
        EXPECT_EQ(c.waits, 1);
        gpu->step(5);
        RunState state;
        c = countsOf([&] { state = gpu->state(); });
        EXPECT_EQ(c.waits, scene.objects.empty() && state.solids.empty() ? 1 : 2);
        const double each = double(c.copiedBytes) / double(gpu->fluidCount());
        if (state.solids.empty() && scene.objects.empty() && scene.solids.empty() &&
            scene.sources.empty()) {
            EXPECT_LT(each, 4 + 2 * 16 + 4 + 4) << "each field crosses once";
        }
        gpu->step(5);
        c = countsOf([&] { gpu->find(3); });
        EXPECT_EQ(c.waits, 2) << "where it is, and what it is like";
        c = countsOf([&] { gpu->step(5); });
        EXPECT_EQ(c.waits, 0);
    }
}

// Kernels, of a step and of each iteration for pressures: a GPU needs some microseconds for each,
// which is what a step of few particles takes.
struct Kernels {
    double step = 0, iteration = 0;
};
Kernels kernelsOf(Scene scene) {
    const auto done = [&](int iterations) {
        scene.solver.iterations = iterations, scene.solver.densityError = 1e-6f;
        const auto gpu = makeCudaSimulation(scene, placeParticles(scene), 0);
        gpu->step(3), gpu->wait();
        return countsOf([&] { gpu->timeSteps(10); });
    };
    const Counts few = done(2), more = done(4), between = more - few;
    const double each = between.repeats > 0 ? double(between.kernels) / double(between.repeats) : 0;
    return {(double(few.kernels) - each * double(few.repeats)) / 10, each};
}

TEST_F(Waits, KernelsOfAStepAreFew) {
    std::printf("%-24s %8s %10s\n", "kernels", "a step", "iteration");
    for (const char* file :
         {"1.json", "2.json", "3.json", "dam_break.json", "double_dam_break.json", "ball_drop.json",
          "pool_drop.json", "still_pool.json"}) {
        const Scene scene = shippedScene(file);
        const Kernels k = kernelsOf(scene);
        std::printf("%-24s %8.0f %10.0f\n", file, k.step, k.iteration);
        if (scene.simulation.formulation == Formulation::Incompressible) {
            EXPECT_LE(k.step, 21) << file;
            EXPECT_LE(k.iteration, 6) << file;
        } else {
            EXPECT_LE(k.step, 15) << file;
        }
    }
}

}  // namespace
}  // namespace spindrift
