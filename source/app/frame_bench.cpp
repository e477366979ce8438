#include "app/exit_code.h"
#include "app/frame_bench.h"

#include "app/frame.h"
#include "app/scene_choice.h"
#include "core/error.h"
#include "render/egl_context.h"
#include "render/gl.h"
#include "scene/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

double medianMs(int repeats, const std::function<void()>& f) {
    std::vector<double> ms;
    for (int k = 0; k < repeats; ++k) {
        const auto start = std::chrono::steady_clock::now();
        f();
        ms.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
    }
    std::nth_element(ms.begin(), ms.begin() + repeats / 2, ms.end());
    return ms[size_t(repeats) / 2];
}

}  // namespace

nlohmann::json benchFrameAndSwitch(const Scene& wanted) {
    EglContext context(wanted.compute.device);
    const Scene scene = onDrawingDevice(wanted);
    auto simulation = makeSimulation(scene);
    Frame frame(1280, 800, 1);
    frame.update(*simulation, scene);  // registers the buffer
    simulation->step(10);
    simulation->wait();
    const double write = medianMs(100, [&] { frame.update(*simulation, scene); });
    const char* way = frame.copiesVertices() ? "copied through the host" : "written in place";
    fmt::print("{:70} {:9} {:18.3f} ms, {}\n", "a frame's vertices: map, write, unmap",
               simulation->fluidCount(), write, way);

    Scene other = scene;
    const double there = medianMs(1, [&] {
        other.compute.backend = Backend::Cpu;
        simulation = makeSimulation(other, simulation->state());
    });
    const double back = medianMs(1, [&] {
        other.compute.backend = scene.compute.backend;
        simulation = makeSimulation(other, simulation->state());
        simulation->wait();
    });
    fmt::print("{:70} {:9} {:18.1f} ms to the CPU, {:.1f} ms back\n", "change of backend",
               simulation->fluidCount(), there, back);
    return {{"particles", simulation->fluidCount()},
            {"frame_ms", write},
            {"vertices", way},
            {"switch_to_cpu_ms", there},
            {"switch_back_ms", back}};
}

int benchFrames() {
    fmt::print(
        "| particles | style | samples | vertices, ms | draw, ms | read back, ms |\n"
        "|---|---|---|---|---|---|\n");
    EglContext context(-1);
    for (const char* spacing : {"0.02", "0.0143", "0.009"}) {
        Scene scene = chooseScene("dam_break", {{"bench", "simulation.spacing", spacing},
                                                {"bench", "compute.backend", "cpu"}});
        const auto simulation = makeSimulation(scene);
        while (simulation->clock().time < 0.1) simulation->step();
        for (const auto& [style, samples] : {std::pair{DrawStyle::Spheres, 1},
                                             {DrawStyle::Spheres, 4},
                                             {DrawStyle::Surface, 1},
                                             {DrawStyle::Surface, 4}}) {
            scene.view.style = style;
            Frame frame(1280, 800, samples);
            const double vertices = medianMs(20, [&] { frame.update(*simulation, scene); });
            const double drawn = medianMs(20, [&] { frame.draw(scene), glFinish(); });
            const double read = medianMs(20, [&] { frame.image(); });
            fmt::print("| {} | {} | {} | {:.2f} | {:.1f} | {:.1f} |\n", simulation->fluidCount(),
                       enumNames(style)[size_t(style)], samples, vertices, drawn, read);
            std::fflush(stdout);
        }
    }
    return int(Exit::Ok);
}

}  // namespace spindrift
