#include "app/exit_code.h"
#include "app/bench.h"

#include "app/bench_baseline.h"
#include "app/frame_bench.h"
#include "app/scene_choice.h"
#include "core/error.h"
#include "core/output_file.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <tuple>
#include <vector>

namespace spindrift {
namespace {

struct Case {
    std::string name, scene;
    std::vector<std::string> knobs;  // path=value
    double original = 0;  // ms a step of the original program on two such cores, 0 = not known
    double warmUp = 0.2;  // s of flow before the clock starts
    int batches = 9, batch = 20;  // the figure is the median of the batches; a batch is long enough
                                  // that rebuilding neighbour lists now and then is shared fairly
};

// The dam break with the spacing that gives about this many particles, and no walls.
Case damBreak(int64_t particles, const std::string& support, double warmUp,
              const std::string& skin) {
    const double spacing = std::cbrt(0.6 * 0.48 * 0.6 / double(particles));
    return {
        fmt::format("dam break {}k, R = {} dx{}{}", particles / 1000, support,
                    warmUp > 0 ? "" : ", at the start", skin == "0" ? ", new lists each step" : ""),
        "dam_break",
        {"simulation.formulation=wcsph", fmt::format("simulation.spacing={}", spacing),
         "simulation.support=" + support, "walls.kind=reflect", "fluid.viscosity=0",
         "compute.skin=" + skin},
        0,
        warmUp};
}

// The default dam break with walls, with about this many particles of fluid.
Case withWalls(int64_t particles, double warmUp, int batches) {
    const double spacing = std::cbrt(0.5 * 0.54 * 0.6 / double(particles));
    return {fmt::format("dam break {}k with walls, R = 2.6 dx", particles / 1000),
            "dam_break",
            {"simulation.formulation=wcsph", fmt::format("simulation.spacing={}", spacing),
             "compute.backend=cuda"},
            0,
            warmUp,
            batches,
            1};
}

// Single steps by events on the GPU. Large scenes are still near their lattice: reaching the splash
// would take minutes.
std::vector<Case> gpuCases(int64_t most) {
    std::vector<Case> cases = {{"historical 3", "3", {"compute.backend=cuda"}, 120, 0.2, 1000, 1}};
    for (auto [particles, warmUp, steps] : {std::tuple{50'000, 0.2, 1000},
                                            {1'000'000, 0.2, 1000},
                                            {10'000'000, 0.01, 1000},
                                            {100'000'000, 0.0, 20}})
        if (particles <= most) cases.push_back(withWalls(particles, warmUp, steps));
    return cases;
}

std::vector<Case> cpuCases() {
    std::vector<Case> cases = {
        {"historical 1", "1", {}, 12.6},
        {"historical 2", "2", {}, 45},
        {"historical 3", "3", {}, 120},
        damBreak(50000, "2", 0.2, "0.1"),
        damBreak(50000, "2.6", 0, "0.1"),
        damBreak(50000, "2.6", 0.2, "0.1"),
        damBreak(50000, "2.6", 0.2, "0"),
        {"dam break 50k with walls", "dam_break", {"simulation.formulation=wcsph"}},
        {"dam break 50k, incompressible", "dam_break", {}}};
    // The lattice at the start is the same work for every size; lists are made anew, so that no
    // size profits from calm.
    for (int64_t n : {10000, 50000, 200000, 500000, 1000000, 2000000}) {
        cases.push_back(damBreak(n, "2.6", 0, "0"));
        cases.back().name = "size " + cases.back().name;
        if (n > 300000) cases.back().batch = 3;
    }
    return cases;
}

struct Timing {
    std::string device;
    int fluid = 0, walls = 0;
    double ms = 0;      // a step: median over batches of the batch's mean
    double wallMs = 0;  // by the clock, of a step: what the device waits for the host is in it
    double bytes = 0;   // a particle
    std::vector<PassTime> passes;
};

Scene sceneOf(const Case& c, const BenchOptions& options) {
    std::vector<KnobChoice> choices;
    for (const std::string& knob : c.knobs) {
        const size_t equals = knob.find('=');
        choices.push_back({"bench", knob.substr(0, equals), knob.substr(equals + 1)});
    }
    if (!options.gpu) choices.push_back({"bench", "compute.backend", "cpu"});
    if (options.threads > 0)
        choices.push_back({"--threads", "compute.threads", std::to_string(options.threads)});
    if (!options.simd.empty()) choices.push_back({"--simd", "compute.simd", options.simd});
    return chooseScene(c.scene, choices);
}

Timing time(const Case& c, const BenchOptions& options) {
    auto simulation = makeSimulation(sceneOf(c, options));
    simulation->step(3);
    while (simulation->measure().time < c.warmUp) simulation->step(10);
    simulation->resetTimes();
    if (options.gpu) simulation->step();  // the one that is measured pass by pass
    const auto start = std::chrono::steady_clock::now();
    const std::vector<double> steps = simulation->timeSteps(c.batches * c.batch);
    const double wallMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count() /
        double(steps.size());
    std::vector<double> ms;
    for (auto first = steps.begin(); first != steps.end(); first += c.batch)
        ms.push_back(std::accumulate(first, first + c.batch, 0.0) / c.batch);
    std::nth_element(ms.begin(), ms.begin() + c.batches / 2, ms.end());
    const double particles = double(simulation->fluidCount()) + simulation->wallCount();
    return {simulation->deviceName(),
            simulation->fluidCount(),
            simulation->wallCount(),
            ms[size_t(c.batches) / 2],
            wallMs,
            double(simulation->bytes()) / particles,
            simulation->times()};
}

nlohmann::json describe(const Case& c, const Timing& t) {
    nlohmann::json passes;
    for (const PassTime& p : t.passes) passes[p.name] = p.ms / double(p.runs);
    nlohmann::json row = {{"case", c.name},
                          {"machine", machineName()},
                          {"device", t.device},
                          {"particles", t.fluid},
                          {"boundary", t.walls},
                          {"ms_per_step", t.ms},
                          {"wall_ms_per_step", t.wallMs},
                          {"ns_per_particle_step", 1e6 * t.ms / t.fluid},
                          {"bytes_per_particle", t.bytes},
                          {"ms_per_pass", passes}};
    if (c.original > 0) row["times_faster_than_original"] = c.original / t.ms;
    return row;
}

// Other work on the machine makes things slower, never faster: what looks slower than the baseline
// gets two more chances.
Timing timeAgainst(const BenchBaseline& baseline, const Case& c, const BenchOptions& options) {
    Timing best = time(c, options);
    for (int chance = 0; chance < 2 && !baseline.complaint(describe(c, best)).empty(); ++chance)
        if (Timing again = time(c, options); again.ms < best.ms) best = std::move(again);
    return best;
}

void print(const Case& c, const Timing& t, double ratio) {
    fmt::print("{:70} {:9} {:8} {:9.3f} {:7.1f}", c.name, t.fluid, t.walls, t.ms,
               1e6 * t.ms / t.fluid);
    fmt::print(" {:>9}", c.original > 0 ? fmt::format("{:.1f}x", c.original / t.ms) : "");
    fmt::print(" {:>8}", ratio > 0 ? fmt::format("{:.2f}", ratio) : "");
    for (const PassTime& p : t.passes) fmt::print("  {} {:.3f}", p.name, p.ms / double(p.runs));
    fmt::print("\n");
    std::fflush(stdout);
}

// What got slower than the baseline; cases that it doesn't have yet join it.
void compare(BenchBaseline& baseline, const nlohmann::json& rows, const std::string& path) {
    int known = 0, slower = 0, added = 0;
    for (const nlohmann::json& row : rows) {
        if (!row.contains("machine")) continue;  // no time of a step
        if (baseline.add(row)) {
            ++added;
            continue;
        }
        ++known;
        if (const std::string words = baseline.complaint(row); !words.empty())
            ++slower, fmt::print("slower: {}\n", words);
    }
    if (known > 0)
        fmt::print("{} of {} cases more than {:.0f} % slower than in {}\n", slower, known,
                   100 * (BenchBaseline::tolerance - 1), path);
    if (added == 0) return;
    writeText(path, baseline.text());
    fmt::print("{} cases noted in {}, for later runs\n", added, path);
}

}  // namespace

int bench(const BenchOptions& options) {
    for (const std::string& path : {options.json, options.baseline})
        if (!path.empty()) requireWritable(path);
    BenchBaseline baseline =
        options.baseline.empty() ? BenchBaseline() : BenchBaseline(options.baseline);
    nlohmann::json rows = nlohmann::json::array();
    if (options.gpu)
        if (const std::string problem = whyNoGpu(Scene{}); !problem.empty())
            throw Error(Failure::NoDevice, "--gpu: " + problem);
    for (const Case& c : options.gpu ? gpuCases(options.most) : cpuCases()) {
        if (c.name.find(options.only) == std::string::npos) continue;
        const Timing t = timeAgainst(baseline, c, options);
        if (rows.empty())
            fmt::print("{}\n{:70} {:>9} {:>8} {:>9} {:>7} {:>9} {:>8}  mean ms of each pass\n",
                       t.device, "case", "particles", "walls", "ms/step", "ns/p", "original",
                       "baseline");
        rows.push_back(describe(c, t));
        print(c, t, baseline.ratio(rows.back()));
    }
    if (options.gpu && options.only.empty() && options.most >= 1'000'000)
        rows.push_back(benchFrameAndSwitch(sceneOf(withWalls(1'000'000, 0, 1), options)));
    if (rows.empty())
        throw Error(Failure::Usage,
                    fmt::format("--only: no case is called \"{}\"; run bench without it to see all",
                                options.only));
    if (!options.json.empty()) writeText(options.json, rows.dump(2) + "\n");
    if (!options.baseline.empty()) compare(baseline, rows, options.baseline);
    return int(Exit::Ok);
}

}  // namespace spindrift
