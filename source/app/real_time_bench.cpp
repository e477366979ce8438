#include "app/exit_code.h"
#include "app/real_time_bench.h"

#include "app/frame.h"
#include "app/scene_choice.h"
#include "core/error.h"
#include "render/egl_context.h"
#include "scene/check.h"
#include "scene/formulation.h"
#include "scene/schema.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <optional>

namespace spindrift {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct Pace {
    double realTime = 0;    // simulated / wall time
    double step = 0;        // s, mean
    double iterations = 0;  // of the pressure solve, in the mean of what was looked at
};

// From the beginning, for a second of the scene's time or five of the wall's.
Pace paceOf(const Scene& scene, Frame* frame) {
    const double simulated = 1, wall = 5, picture = 1.0 / 30;  // s
    const auto simulation = makeSimulation(scene);
    if (frame) frame->restart();
    const auto begin = Clock::now();
    auto drawn = begin;
    int64_t iterations = 0, looks = 0;
    while (simulation->clock().time < simulated && secondsSince(begin) < wall) {
        simulation->step();
        if (!frame || secondsSince(drawn) < picture) continue;
        drawn = Clock::now();
        frame->update(*simulation, scene);
        frame->draw(scene);
        frame->image();
        iterations += simulation->measure().solve.iterations, ++looks;
    }
    simulation->wait();
    const StepState clock = simulation->clock();
    return {clock.time / secondsSince(begin), clock.time / double(clock.steps),
            looks > 0 ? double(iterations) / double(looks) : 0};
}

// The same with pressures that are solved for, or without; nothing where the scene can't have it.
std::optional<Scene> otherWayOf(Scene scene) {
    scene.simulation.formulation =
        factsOf(scene).solvesPressure ? Formulation::Wcsph : Formulation::Incompressible;
    scene.time.mode = TimeMode::Cfl, scene.time.integrator = Integrator::SymplecticEuler;
    try {
        checkScene(scene, scene.name);
    } catch (const Error&) { return {}; }
    return scene;
}

void printPace(const std::string& name, const Scene& scene, Frame& frame) {
    const Pace alone = paceOf(scene, nullptr), shown = paceOf(scene, &frame);
    fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.3g} | {} |\n", name,
               countParticles(scene).fluid,
               enumNames(Formulation())[size_t(scene.simulation.formulation)], alone.realTime,
               shown.realTime, 1e3 * alone.step,
               shown.iterations > 0 ? fmt::format("{:.1f}", shown.iterations) : "");
    std::fflush(stdout);
}

}  // namespace

int benchRealTime(const std::string& only) {
    EglContext context(-1);
    Frame frame(1280, 800, 1);
    fmt::print("Simulated seconds per second, alone and with 30 pictures a second.\n\n");
    fmt::print(
        "| scene | particles | formulation | alone | with pictures | step, ms | iterations |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const std::string& name : shippedScenes()) {
        if (name.find(only) == std::string::npos) continue;
        const Scene scene = chooseScene(name, {{"bench", "compute.backend", "cpu"}});
        printPace(name, scene, frame);
        if (const std::optional<Scene> other = otherWayOf(scene)) printPace("", *other, frame);
    }
    return int(Exit::Ok);
}

}  // namespace spindrift
