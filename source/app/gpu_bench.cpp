#include "app/gpu_bench.h"

#include "app/frame.h"
#include "render/egl_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace spindrift {
namespace {

double medianMs(int repeats, const std::function<void()>& f) {
    std::vector<double> ms;
    for (int k = 0; k < repeats; ++k) {
        const auto start = std::chrono::steady_clock::now();
        f();
        ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
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
    frame.update(*simulation, scene);   // registers the buffer
    simulation->step(10);
    simulation->wait();
    const double write = medianMs(100, [&] { frame.update(*simulation, scene); });
    const char* way = frame.copiesVertices() ? "copied through the host" : "written in place";
    fmt::print("{:70} {:9} {:18.3f} ms, {}\n", "a frame's vertices: map, write, unmap", simulation->fluidCount(), write, way);

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
    fmt::print("{:70} {:9} {:18.1f} ms to the CPU, {:.1f} ms back\n", "change of backend", simulation->fluidCount(), there, back);
    return {{"particles", simulation->fluidCount()}, {"frame_ms", write}, {"vertices", way},
            {"switch_to_cpu_ms", there}, {"switch_back_ms", back}};
}

}  // namespace spindrift
