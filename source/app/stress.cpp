#include "app/exit_code.h"
#include "app/stress.h"

#include "core/error.h"
#include "core/output_file.h"
#include "measure/stability_map.h"
#include "measure/stress.h"
#include "scene/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
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
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ++counts[int(r.verdict)];
        if (!quiet || r.verdict == Verdict::Broken)
            fmt::print("{:60} {:8} {:>8} {:>8} {:>9.2f} % {:>9.2f} % {:>7.1f} s  {}\n", c.name,
                       VerdictNames[int(r.verdict)], r.particles, r.steps, 100 * r.energyGain,
                       100 * r.density, seconds, r.what);
        std::fflush(stdout);
        rows.push_back({{"case", c.name},
                        {"verdict", VerdictNames[int(r.verdict)]},
                        {"what", r.what},
                        {"particles", r.particles},
                        {"steps", r.steps},
                        {"retries", r.retries},
                        {"energy_gain", r.energyGain},
                        {"density_error", r.density},
                        {"seconds", seconds}});
        if (!quiet)
            markdown += fmt::format("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} |\n", c.name,
                                    VerdictNames[int(r.verdict)], r.particles, r.steps,
                                    100 * r.energyGain, 100 * r.density, r.what);
        return r;
    }
};

void torture(const StressOptions& options, Report& report) {
    fmt::print("{:60} {:8} {:>8} {:>8} {:>11} {:>11}\n", "torture", "verdict", "fluid", "steps",
               "energy", "density");
    report.markdown +=
        "\n## Torture\n\n| case | verdict | particles | steps | energy gain, % | largest "
        "compression, % | |\n|---|---|---|---|---|---|---|\n";
    for (const StressCase& c : tortures(options.full))
        if (c.name.find(options.only) != std::string::npos) report.run(c, false);
}

void randomScenes(const StressOptions& options, Report& report) {
    int before[3];
    std::copy(std::begin(report.counts), std::end(report.counts), before);
    std::string broken;
    for (int k = 0; k < options.random; ++k) {
        const StressCase c = randomCase(options.seed + uint64_t(k));
        if (report.run(c, true).verdict == Verdict::Broken)
            broken += fmt::format(" {}", options.seed + uint64_t(k));
    }
    const std::string line = fmt::format(
        "{} random scenes from seed {}, 300 steps each: {} sound, {} stopped by the health guard, "
        "{} broken{}{}",
        options.random, options.seed, report.counts[0] - before[0], report.counts[1] - before[1],
        report.counts[2] - before[2], broken.empty() ? "" : ", seeds", broken);
    fmt::print("\n{}\n", line);
    report.markdown += "\n## Random scenes\n\n" + line + ".\n";
}

std::string limit(double value, double tried, const char* sign) {
    return fmt::format("{}{:.3g}", value == tried ? sign : "", value);
}

// How far each knob can go. Counts a usual value that is not sound as broken: the automatic time
// step must hold everywhere.
void maps(const StressOptions& options, Report& report) {
    fmt::print("\n{:24} {:20} {:28} {:>9} {:>9} {:>9}\n", "what stays sound", "formulation", "knob",
               "usual", "from", "to");
    report.markdown +=
        "\n## Maps: what stays sound\n\n400 steps each, without retries; ≤ and ≥: no limit found. "
        "Pictures: `stability_*.svg`.\n\n"
        "| scene | formulation | knob | usual | from | to |\n|---|---|---|---|---|---|\n";
    std::string margins;
    for (const std::string& scene : mapScenes()) {
        const StabilityMap map = stabilityMap(scene);
        for (const StabilityRow& r : map.rows) {
            const std::string name = r.knob + (r.unit.empty() ? "" : ", " + r.unit),
                              from = limit(r.low, r.least, "≤ "), to = limit(r.high, r.most, "≥ ");
            fmt::print("{:24} {:20} {:28} {:>9.3g} {:>9} {:>9}{}\n", scene, r.formulation, name,
                       r.usual, from, to, r.usualIsSound ? "" : "  NOT SOUND");
            report.markdown += fmt::format(
                "| {} | {} | {} | {:.3g} | {} | {} |\n", scene, r.formulation, name, r.usual,
                r.usualIsSound ? from : "**not sound**", r.usualIsSound ? to : "");
            if (r.knob == "time.cfl")
                margins +=
                    fmt::format("{}{}, {}: {}{:.1f}", margins.empty() ? "" : "; ", scene,
                                r.formulation, r.high == r.most ? "≥ " : "", r.high / r.usual);
            report.counts[2] += !r.usualIsSound;
            nlohmann::json tried = nlohmann::json::array();
            for (const auto& [value, verdict] : r.tried)
                tried.push_back({value, VerdictNames[int(verdict)]});
            report.rows.push_back({{"scene", scene},
                                   {"formulation", r.formulation},
                                   {"knob", r.knob},
                                   {"usual", r.usual},
                                   {"low", r.low},
                                   {"high", r.high},
                                   {"tried", tried}});
        }
        std::fflush(stdout);
        if (options.out.empty()) continue;
        std::string file = scene;
        std::replace(file.begin(), file.end(), ' ', '_');
        writeText(options.out + "/stability_" + file + ".svg", svg(map));
    }
    fmt::print("largest sound Courant number / the usual one: {}\n\n", margins);
    report.markdown +=
        "\nMargin of the automatic step, largest sound Courant number / the usual one: " + margins +
        ".\n";
}

int handleScenes(const StressOptions& options) {
    bool sound = true;
    fmt::print("{:28} {:8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>7}\n", "handled at random", "verdict",
               "fluid", "steps", "time", "fastest", "density", "retries");
    for (const std::string& name : options.handled) {
        const Scene scene = chooseScene(name, options.choices);
        const StressResult r = handle(scene, options.seed, options.seconds);
        fmt::print("{:28} {:8} {:>8} {:>8} {:>7.3g} s {:>5.3g} m/s {:>6.2f} % {:>7}  {}\n",
                   scene.name, VerdictNames[int(r.verdict)], r.particles, r.steps, r.time, r.speed,
                   100 * r.density, r.retries, r.what);
        std::fflush(stdout);
        sound = sound && r.verdict == Verdict::Sound;
    }
    return int(sound ? Exit::Ok : Exit::Different);
}

}  // namespace

int stress(const StressOptions& options) {
    if (!options.handled.empty()) return handleScenes(options);
    if (!options.out.empty()) requireFolder(options.out);
    Report report;
    torture(options, report);
    if (options.only.empty() || options.only == "random") randomScenes(options, report);
    if ((options.full && options.only.empty()) || options.only == "maps") maps(options, report);
    fmt::print("{} sound, {} stopped by the health guard, {} broken\n", report.counts[0],
               report.counts[1], report.counts[2]);
    if (!options.out.empty()) {
        writeText(options.out + "/stability.json", report.rows.dump(2) + "\n");
        writeText(options.out + "/stability.md", report.markdown);
    }
    return int(report.counts[2] == 0 ? Exit::Ok : Exit::Different);
}

}  // namespace spindrift
