#include "app/stress.h"

#include "core/error.h"
#include "measure/output_file.h"
#include "measure/stress.h"
#include "scene/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <vector>

namespace spindrift {
namespace {

constexpr const char* VerdictNames[] = {"sound", "stopped", "BROKEN"};

struct Report {
    nlohmann::json rows = nlohmann::json::array();
    std::string markdown;
    int counts[3] = {};

    StressResult run(const StressCase& c, bool quiet) {
        const auto start = std::chrono::steady_clock::now();
        const StressResult r = stress(c);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ++counts[int(r.verdict)];
        if (!quiet || r.verdict == Verdict::Broken)
            fmt::print("{:60} {:8} {:>8} {:>8} {:>9.2f} % {:>9.2f} % {:>7.1f} s  {}\n", c.name, VerdictNames[int(r.verdict)], r.particles,
                       r.steps, 100 * r.energyGain, 100 * r.density, seconds, r.what);
        std::fflush(stdout);
        rows.push_back({{"case", c.name}, {"verdict", VerdictNames[int(r.verdict)]}, {"what", r.what}, {"particles", r.particles},
                        {"steps", r.steps}, {"energy_gain", r.energyGain}, {"density_error", r.density}, {"seconds", seconds}});
        if (!quiet)
            markdown += fmt::format("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} |\n", c.name, VerdictNames[int(r.verdict)], r.particles, r.steps,
                                    100 * r.energyGain, 100 * r.density, r.what);
        return r;
    }
};

void torture(const StressOptions& options, Report& report) {
    fmt::print("{:60} {:8} {:>8} {:>8} {:>11} {:>11}\n", "torture", "verdict", "fluid", "steps", "energy", "density");
    report.markdown += "\n## Torture\n\n| case | verdict | particles | steps | energy gain, % | largest compression, % | |\n|---|---|---|---|---|---|---|\n";
    for (const StressCase& c : tortures(options.full))
        if (c.name.find(options.only) != std::string::npos) report.run(c, false);
}

void randomScenes(const StressOptions& options, Report& report) {
    int before[3];
    std::copy(std::begin(report.counts), std::end(report.counts), before);
    std::string broken;
    for (int k = 0; k < options.random; ++k) {
        const StressCase c = randomCase(options.seed + uint64_t(k));
        if (report.run(c, true).verdict == Verdict::Broken) broken += fmt::format(" {}", options.seed + uint64_t(k));
    }
    const std::string line = fmt::format("{} random scenes from seed {}, 300 steps each: {} sound, {} stopped by the health guard, {} broken{}{}",
                                         options.random, options.seed, report.counts[0] - before[0], report.counts[1] - before[1],
                                         report.counts[2] - before[2], broken.empty() ? "" : ", seeds", broken);
    fmt::print("\n{}\n", line);
    report.markdown += "\n## Random scenes\n\n" + line + ".\n";
}

// What is still sound, by bisection.
void maps(Report& report) {
    struct Axis { const char* knob; double least, most; };
    constexpr Axis Axes[] = {{"time.cfl", 0.1, 1}, {"fluid.viscosity", 0, 1000}, {"fluid.artificial_viscosity", 0, 2}, {"simulation.support", 1.6, 5}};
    fmt::print("\nlargest value that is sound");
    report.markdown += "\n## Maps: the largest value that is sound\n\n| scene |";
    for (const Axis& axis : Axes) report.markdown += fmt::format(" {} (tried {:g} to {:g}) |", axis.knob, axis.least, axis.most);
    report.markdown += "\n|---|---|---|---|---|\n";
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (const char* scene : {"two dimensions", "impact at 10 m/s", "overlapping bodies"}) {
            const std::string name = fmt::format("{}: {}", formulation, scene);
            fmt::print("\n{:60}", name);
            report.markdown += fmt::format("| {} |", name);
            for (const StressCase& c : tortures(false)) {
                if (c.name != name) continue;
                for (const Axis& axis : Axes) {
                    const double value = largestSound(c, axis.knob, axis.least, axis.most);
                    fmt::print("  {} {:.3g}", axis.knob, value);
                    std::fflush(stdout);
                    report.markdown += fmt::format(" {:.3g} |", value);
                }
            }
            report.markdown += "\n";
        }
    fmt::print("\n");
}

}  // namespace

int stress(const StressOptions& options) {
    if (!options.out.empty()) requireFolder(options.out);
    Report report;
    torture(options, report);
    if (options.only.empty()) randomScenes(options, report);
    if (options.full && options.only.empty()) maps(report);
    fmt::print("{} sound, {} stopped by the health guard, {} broken\n", report.counts[0], report.counts[1], report.counts[2]);
    if (!options.out.empty()) {
        writeText(options.out + "/stability.json", report.rows.dump(2) + "\n");
        writeText(options.out + "/stability.md", report.markdown);
    }
    return int(report.counts[2] == 0 ? Exit::Ok : Exit::Different);
}

}  // namespace spindrift
