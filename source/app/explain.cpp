#include "app/exit_code.h"
#include "app/explain.h"

#include "core/error.h"
#include "scene/schema.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <map>

namespace spindrift {
namespace {

// Of a pass in a step: how long, ms, and how often. A GPU measures the first step after a reset
// only, so each step is one.
struct Share {
    double ms = 0, runs = 0;
};
std::map<std::string, Share> timePasses(Simulation& simulation, int steps) {
    std::map<std::string, Share> each;
    for (int k = 0; k < steps; ++k) {
        simulation.resetTimes();
        simulation.step();
        for (const PassTime& t : simulation.times()) {
            each[t.name].ms += t.ms / steps;
            each[t.name].runs += double(t.runs) / steps;
        }
    }
    return each;
}

template <class Enum> const char* nameOf(Enum value) { return enumNames(value)[size_t(value)]; }

}  // namespace

std::string particlesOf(Simulation& s) {
    const std::string counts = fmt::format("{} fluid, {} boundary", s.fluidCount(), s.wallCount());
    return s.objectParticleCount() > 0
               ? fmt::format("{}, {} of objects", counts, s.objectParticleCount())
               : counts;
}

int explain(const Scene& scene) {
    const auto simulation = makeSimulation(scene);
    const int64_t particles = int64_t(simulation->fluidCount()) + simulation->wallCount() +
                              simulation->objectParticleCount();
    const double support = scene.simulation.support, mebibyte = 1 << 20;
    fmt::print("scene        {}\n", scene.name);
    fmt::print("device       {}\n", simulation->deviceName());
    fmt::print("particles    {}\n", particlesOf(*simulation));
    fmt::print("formulation  {}, {}, R = {:g} dx = {:.3g} m, about {:.0f} neighbours\n",
               nameOf(scene.simulation.formulation), nameOf(scene.simulation.kernel), support,
               supportRadius(scene),
               scene.simulation.dimensions == 2 ? 3.14159 * support * support
                                                : 4.18879 * support * support * support);
    fmt::print("memory       {:.1f} MiB, {:.0f} bytes a particle\n\n",
               double(simulation->bytes()) / mebibyte,
               double(simulation->bytes()) / double(particles));

    const auto times = timePasses(*simulation, scene.compute.steps);
    fmt::print("a step{:44}{}\n", "", times.empty() ? "" : "ms");
    double sum = 0;
    for (const PlanRow& row : simulation->plan()) {
        if (!row.skipped.empty()) continue;
        const auto time = times.find(row.name);
        if (time == times.end()) {
            fmt::print("  {}\n", row.name);
            continue;
        }
        const auto [ms, runs] = time->second;
        fmt::print("  {:46}{:.3f}{}\n", row.name, ms,
                   runs > 1.01 ? fmt::format("  {:.1f} times", runs) : "");
        sum += ms;
    }
    if (!times.empty()) fmt::print("  {:46}{:.3f}\n", "together", sum);
    fmt::print("\nskipped\n");
    for (const PlanRow& row : simulation->plan())
        if (!row.skipped.empty()) fmt::print("  {:46}{}\n", row.name, row.skipped);
    return int(Exit::Ok);
}

}  // namespace spindrift
