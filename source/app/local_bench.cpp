#include "app/exit_code.h"
#include "app/local_bench.h"

#include "app/scene_choice.h"
#include "core/error.h"
#include "core/system.h"
#include "core/output_file.h"
#include "measure/chart.h"
#include "measure/save_particles.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <vector>

namespace spindrift {
namespace {

constexpr double FramesPerSecond = 60;  // simulated

// A run, frame by frame.
struct Run {
    std::string name;
    double seconds = 0;  // of wall time
    int64_t steps = 0;
    double evaluations = 0;               // a particle
    std::vector<double> time, frameTime;  // s, ms a frame
    Measurement end;
    double front = 0;  // m, as far as any particle along x
};

enum class Against {
    Nobody,
    All,
    Spread
};  // what local steps are compared with: the step of all, and half and twice of it
struct Case {
    std::string name;
    std::function<Scene()> scene;
    std::function<RunState(const Scene&)> start;  // where both begin
    double warmUp, time;  // s simulated: before the clock starts, and by the clock
    Against against = Against::All;
};

Run runFor(const std::string& name, const Scene& scene, const RunState& state, double warmUp,
           double time) {
    const auto simulation = makeSimulation(scene, state);
    while (simulation->clock().time < state.clock.time + warmUp) simulation->step();
    Run run;
    run.name = name;
    const Measurement first = run.end = simulation->measure();
    for (int frame = 1; run.end.time < first.time + time * (1 - 1e-9); ++frame) {
        const double stop = first.time + std::min(time, frame / FramesPerSecond);
        simulation->stopAt(stop);
        const auto start = std::chrono::steady_clock::now();
        while (simulation->clock().time < stop) simulation->step();
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        run.seconds += seconds;
        run.end = simulation->measure();
        run.time.push_back(run.end.time), run.frameTime.push_back(1000 * seconds);
    }
    run.steps = run.end.steps - first.steps;
    run.evaluations = (run.end.evaluations - first.evaluations) / simulation->fluidCount();
    for (const Particle& p : simulation->particles()) run.front = std::max(run.front, p.position.x);
    return run;
}

Scene sceneOf(const std::string& name,
              const std::vector<std::pair<std::string, std::string>>& knobs) {
    std::vector<KnobChoice> choices = {{"bench", "compute.backend", "cpu"},
                                       {"bench", "simulation.formulation", "wcsph"}};
    for (const auto& [path, value] : knobs) choices.push_back({"bench", path, value});
    return chooseScene(name, choices);
}

RunState beginning(const Scene& scene) { return RunState(placeParticles(scene)); }

// As it is when all of it rests.
RunState atRest(Scene scene) {
    scene.time.mode = TimeMode::Local;
    const auto simulation = makeSimulation(scene);
    for (double before = -1; simulation->measure().evaluations > before;)
        before = simulation->measure().evaluations, simulation->step(50);
    return simulation->state();
}

// A still pool without side walls, 2 m x 2 m and a quarter deep, and a ball of 1 % of its particles
// just above, falling. The pool is copies of a small one that has come to rest: a large one would
// take an hour to.
constexpr double Depth = 0.25, Spacing = 0.01, Tile = 0.32;
constexpr int Tiles = 6;
Scene poolOf(double width) {
    Scene s;
    s.simulation.spacing = float(Spacing);
    s.compute.backend = Backend::Cpu;
    s.domain.max = {float(width), 0.9f, float(width)};
    s.domain.periodicX = s.domain.periodicZ = true;
    s.fluid.soundSpeed = 34;
    s.time.restSpeed =
        5e-4f;  // 1.7 cm/s: the pool rings for long, and the ball is a hundred times as fast
    s.fluid.bodies[0].min = {0, 0, 0},
    s.fluid.bodies[0].max = {float(width), float(Depth), float(width)};
    return s;
}
Scene dropIntoPool() {
    Scene small = poolOf(Tile);
    small.fluid.artificialViscosity = 0.3f;  // to come to rest sooner
    small.time.restSpeed = 1e-4f;            // so still that it doesn't ring when it is woken
    const auto tile = makeSimulation(small, atRest(small))->particles();
    std::vector<Particle> pool;
    for (int z = 0; z < Tiles; ++z)
        for (int x = 0; x < Tiles; ++x)
            for (Particle p : tile) {
                p.position = p.position + Vec3d{x * Tile, 0, z * Tile}, p.velocity = {};
                p.id = int(pool.size());
                pool.push_back(p);
            }
    const std::string file = (std::filesystem::temp_directory_path() /
                              fmt::format("spindrift_pool_{}.h5", os::processId()))
                                 .string();
    saveParticles(file, pool);
    Scene s = poolOf(Tile * Tiles);
    s.fluid.bodies.resize(2);
    s.fluid.bodies[0].shape = Shape::File, s.fluid.bodies[0].path = file;
    s.fluid.bodies[1].shape = Shape::Sphere, s.fluid.bodies[1].radius = 0.13f;
    s.fluid.bodies[1].center = {float(Tile * Tiles / 2), 0.66f, float(Tile * Tiles / 2)};
    s.fluid.bodies[1].velocity = {0, -1.5f, 0};
    return s;
}
// (A state knows particles, not that they rested: the pool has to fall asleep again, which it has
// after 0.08 s.)
RunState readPool(const Scene& scene) {
    RunState state = beginning(scene);
    std::filesystem::remove(scene.fluid.bodies[0].path);
    return state;
}

std::vector<Case> cases() {
    return {
        {"dam break", [] { return sceneOf("dam_break", {}); }, beginning, 0, 1, Against::Spread},
        {"dam break to rest, 6k",
         [] {
             return sceneOf("dam_break", {{"simulation.spacing", "0.03"}});
         },
         beginning, 0, 16, Against::Spread},
        {"pool at rest",
         [] {
             return sceneOf("still_pool", {{"time.rest_speed", "0.0002"}});
         },
         atRest, 2, 1},
        {"drop into a still pool", dropIntoPool, readPool, 0.1, 0.1},  // half of it in flight
        {"ball drop to rest, 1k",
         [] {
             return sceneOf("ball_drop", {{"simulation.spacing", "0.04"}});
         },
         beginning, 0, 16},
        {"ball drop to rest, 19k", [] { return sceneOf("ball_drop", {}); }, beginning, 0, 12},
        {"ball drop to rest, 100k",
         [] {
             return sceneOf("ball_drop", {{"simulation.spacing", "0.0087"}});
         },
         beginning, 0, 8, Against::Nobody},
        {"ball drop, 1M",
         [] {
             return sceneOf("ball_drop", {{"simulation.spacing", "0.00403"}});
         },
         beginning, 0, 0.4, Against::Nobody}};
}

std::string describe(const Run& r, const Run& all) {
    return fmt::format("| {} | {:.2f} | {:.2f} | {} | {:.0f} | {:.2f} | {:.4g} | {:.6g} | {:.4f} |",
                       r.name, r.seconds, all.seconds / r.seconds, r.steps, r.evaluations,
                       1000 * length(r.end.centerOfMass - all.end.centerOfMass),
                       r.end.kineticEnergy, r.end.potentialEnergy, r.front);
}
constexpr const char* Header =
    "| steps | seconds | times faster | steps | evaluations | centre of mass apart, mm | kinetic "
    "energy, J | potential, J | front, m |\n|---|---|---|---|---|---|---|---|---|";

Chart chartOf(const Case& c, const std::vector<Run>& runs) {
    Chart chart{
        c.name + ": what a frame takes", "time, s", "ms a frame of 1/60 s", {}, false, true};
    for (const Run& r : runs) chart.curves.push_back({r.name, r.time, r.frameTime});
    return chart;
}

std::vector<Run> runAll(const Case& c) {
    Scene scene = c.scene();
    const RunState start = c.start(scene);
    std::vector<Run> runs;
    auto add = [&](const char* name, TimeMode mode, float factor) {
        Scene s = scene;
        s.time.mode = mode, s.time.cfl *= factor;
        runs.push_back(runFor(name, s, start, c.warmUp, c.time));
        fmt::print("{}\n", describe(runs.back(), runs.front()));
        std::fflush(stdout);
    };
    if (c.against != Against::Nobody) add("of all", TimeMode::Cfl, 1);
    add("local", TimeMode::Local, 1);
    if (c.against == Against::Spread)
        add("of all, half", TimeMode::Cfl, 0.5f), add("of all, twice", TimeMode::Cfl, 2);
    return runs;
}

}  // namespace

int benchLocalSteps(const LocalBenchOptions& options) {
    if (!options.out.empty()) requireFolder(options.out);
    nlohmann::json rows = nlohmann::json::array();
    std::string markdown;
    for (const Case& c : cases()) {
        if (c.name.find(options.only) == std::string::npos) continue;
        fmt::print("\n{}, {:g} s\n{}\n", c.name, c.time, Header);
        std::fflush(stdout);
        const std::vector<Run> runs = runAll(c);
        markdown += fmt::format("\n### {}, {:g} s\n\n{}\n", c.name, c.time, Header);
        for (const Run& r : runs) {
            markdown += describe(r, runs.front()) + "\n";
            rows.push_back({{"case", c.name},
                            {"steps_of", r.name},
                            {"seconds", r.seconds},
                            {"times_faster", runs.front().seconds / r.seconds},
                            {"steps", r.steps},
                            {"evaluations", r.evaluations},
                            {"kinetic_energy", r.end.kineticEnergy},
                            {"potential_energy", r.end.potentialEnergy},
                            {"front", r.front}});
        }
        if (options.out.empty()) continue;
        std::string file = "frames_" + c.name + ".svg";
        std::replace_if(
            file.begin(), file.end(), [](char a) { return a == ' ' || a == ','; }, '_');
        writeText(options.out + "/" + file, svg(chartOf(c, runs)));
        writeText(options.out + "/local.json", rows.dump(2) + "\n");
        writeText(options.out + "/local.md", markdown);
    }
    if (rows.empty())
        throw Error(
            Failure::Usage,
            fmt::format("--only: no case is called \"{}\"; run bench --local without it to see all",
                        options.only));
    return int(Exit::Ok);
}

}  // namespace spindrift
