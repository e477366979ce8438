#include "app/bench.h"

#include "app/scene_choice.h"
#include "core/error.h"
#include "measure/output_file.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

namespace spindrift {
namespace {

struct Case {
    std::string name, scene;
    std::vector<std::string> knobs;   // path=value
    double original = 0;              // ms a step of the original program on two such cores, 0 = not known
    double warmUp = 0.2;              // s of flow before the clock starts
};

// The dam break with the spacing that gives about this many particles, and no walls.
Case damBreak(int64_t particles, const std::string& support, double warmUp, const std::string& skin) {
    const double spacing = std::cbrt(0.6 * 0.48 * 0.6 / double(particles));
    return {fmt::format("dam break {}k, R = {} dx{}{}", particles / 1000, support, warmUp > 0 ? "" : ", at the start",
                        skin == "0" ? ", new lists each step" : ""),
            "dam_break",
            {fmt::format("simulation.spacing={}", spacing), "simulation.support=" + support, "walls.kind=reflect",
             "fluid.viscosity=0", "compute.skin=" + skin},
            0, warmUp};
}

std::vector<Case> allCases() {
    std::vector<Case> cases = {{"historical 1", "1", {}, 12.6},
                               {"historical 2", "2", {}, 45},
                               {"historical 3", "3", {}, 120},
                               damBreak(50000, "2", 0.2, "0.1"),
                               damBreak(50000, "2.6", 0, "0.1"),
                               damBreak(50000, "2.6", 0.2, "0.1"),
                               damBreak(50000, "2.6", 0.2, "0"),
                               {"dam break 50k with walls", "dam_break", {}}};
    // The lattice at the start is the same work for every size; lists are made anew, so that no size profits from calm.
    for (int64_t n : {10000, 50000, 200000, 500000, 1000000, 2000000}) {
        cases.push_back(damBreak(n, "2.6", 0, "0"));
        cases.back().name = "size " + cases.back().name;
    }
    return cases;
}

struct Timing {
    std::string device;
    int fluid = 0, walls = 0;
    double ms = 0;                    // a step: median over batches of the batch's mean
    std::vector<PassTime> passes;
};

Timing time(const Case& c, const BenchOptions& options) {
    std::vector<KnobChoice> choices;
    for (const std::string& knob : c.knobs) {
        const size_t equals = knob.find('=');
        choices.push_back({"bench", knob.substr(0, equals), knob.substr(equals + 1)});
    }
    if (options.threads > 0) choices.push_back({"--threads", "compute.threads", std::to_string(options.threads)});
    if (!options.simd.empty()) choices.push_back({"--simd", "compute.simd", options.simd});
    auto simulation = makeSimulation(chooseScene(c.scene, choices));
    simulation->step(3);
    while (simulation->measure().time < c.warmUp) simulation->step(10);
    simulation->resetTimes();

    // A batch is long enough that rebuilding the lists now and then is shared fairly.
    const int batch = simulation->fluidCount() > 300000 ? 3 : 20, batches = 9;
    std::vector<double> ms;
    for (int b = 0; b < batches; ++b) {
        const auto start = std::chrono::steady_clock::now();
        simulation->step(batch);
        ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / batch);
    }
    std::nth_element(ms.begin(), ms.begin() + batches / 2, ms.end());
    return {simulation->deviceName(), simulation->fluidCount(), simulation->wallCount(), ms[batches / 2],
            simulation->times()};
}

nlohmann::json describe(const Case& c, const Timing& t) {
    nlohmann::json passes;
    for (const PassTime& p : t.passes) passes[p.name] = p.ms / double(p.runs);
    nlohmann::json row = {{"case", c.name}, {"device", t.device}, {"particles", t.fluid}, {"boundary", t.walls},
                          {"ms_per_step", t.ms}, {"ns_per_particle_step", 1e6 * t.ms / t.fluid},
                          {"ms_per_pass", passes}};
    if (c.original > 0) row["times_faster_than_original"] = c.original / t.ms;
    return row;
}

void print(const Case& c, const Timing& t) {
    fmt::print("{:70} {:9} {:8} {:9.3f} {:7.1f}", c.name, t.fluid, t.walls, t.ms, 1e6 * t.ms / t.fluid);
    fmt::print(" {:>9}", c.original > 0 ? fmt::format("{:.1f}x", c.original / t.ms) : "");
    for (const PassTime& p : t.passes) fmt::print("  {} {:.3f}", p.name, p.ms / double(p.runs));
    fmt::print("\n");
    std::fflush(stdout);
}

}  // namespace

int bench(const BenchOptions& options) {
    if (!options.json.empty()) requireWritable(options.json);
    nlohmann::json rows = nlohmann::json::array();
    for (const Case& c : allCases()) {
        if (c.name.find(options.only) == std::string::npos) continue;
        const Timing t = time(c, options);
        if (rows.empty())
            fmt::print("{}\n{:70} {:>9} {:>8} {:>9} {:>7} {:>9}  mean ms of each pass\n", t.device, "case", "particles",
                       "walls", "ms/step", "ns/p", "original");
        print(c, t);
        rows.push_back(describe(c, t));
    }
    if (rows.empty())
        throw Error(Exit::Usage, fmt::format("--only: no case is called \"{}\"; run bench without it to see all", options.only));
    if (!options.json.empty()) writeText(options.json, rows.dump(2) + "\n");
    return int(Exit::Ok);
}

}  // namespace spindrift
