#include "app/go_on.h"

#include "core/error.h"
#include "measure/checkpoint.h"
#include "measure/read_series.h"
#include "scene/check.h"
#include "scene/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace spindrift {
namespace {

// The knobs that a run is built from.
std::map<std::string, std::string> builtFrom(const Scene& scene) {
    std::map<std::string, std::string> values;
    for (const char* part : {"simulation", "domain", "walls", "fluid"})
        for (const auto& [path, value] : restartKnobs(scene))
            if (path.starts_with(std::string(part) + ".")) values[path] = value;
    return values;
}

struct NamedOutput {
    const char* option;
    std::string Output::*path;
};
constexpr NamedOutput Outputs[] = {{"--csv ", &Output::csv},
                                   {"--json ", &Output::json},
                                   {"--hdf5 ", &Output::hdf5},
                                   {"--checkpoint ", &Output::checkpoint},
                                   {"--frames ", &Output::frames},
                                   {"--video ", &Output::video},
                                   {"--series ", &Output::series},
                                   {"--surface ", &Output::surface},
                                   {"--screenshot ", &Output::screenshot},
                                   {"--set output.particles=", &Output::particles}};

// Takes all outputs away; "--csv run.csv --frames frames" were there.
std::string leaveOutputs(Output& output) {
    std::string left;
    for (const NamedOutput& named : Outputs) {
        std::string& path = output.*named.path;
        if (!path.empty())
            left += fmt::format("{}{}{}", left.empty() ? "" : " ", named.option, path);
        path.clear();
    }
    output.headless = false;
    return left;
}

bool names(const std::vector<KnobChoice>& choices, const char* path) {
    return std::any_of(choices.begin(), choices.end(),
                       [&](const KnobChoice& c) { return c.path == path; });
}

// A run in time ends with the step that reaches its end.
bool isBehind(double end, const StepState& clock) {
    return end > 0 && end < (clock.time - clock.dt) * (1 - 1e-9);
}

// One end is enough: the one that was named.
void chooseEnd(Scene& scene, const std::vector<KnobChoice>& choices, const StepState& clock,
               const std::string& file) {
    const bool bySteps = names(choices, "compute.steps"), byTime = names(choices, "output.time");
    if (bySteps && !byTime) scene.output.time = 0;
    if (byTime && !bySteps) scene.compute.steps = 0;
    if (scene.compute.steps > 0 && scene.compute.steps < clock.steps)
        throw Error(Failure::Usage, fmt::format("--steps {}: {} goes on from step {}; name a later "
                                                "one, they count from the beginning of the run",
                                                scene.compute.steps, file, clock.steps));
    if (isBehind(scene.output.time, clock))
        throw Error(Failure::Usage, fmt::format("--time {}: {} goes on from {:.6g} s; name a later "
                                                "one, it counts from the beginning of the run",
                                                scene.output.time, file, clock.time));
}

std::vector<CurvePoint> curvesOf(const SeriesTable& series, int dimensions) {
    std::optional<size_t> places[4];
    constexpr const char* Names[] = {"time", "kinetic_energy", "potential_energy", "density_error"};
    for (size_t k = 0; k < 4; ++k)
        if (!(places[k] = find(series.columns, Names[k]))) return {};
    // An older program's has another one.
    if (series.columns[*places[1]].unit != perDepth("J", dimensions)) return {};
    std::vector<CurvePoint> curves;
    for (const std::vector<double>& row : series.rows)
        curves.push_back({float(row[*places[0]]), float(row[*places[1]]), float(row[*places[2]]),
                          float(row[*places[3]])});
    return curves;
}

// Of the first series that the run wrote and that is still there, by its name or beside the
// checkpoint.
std::vector<CurvePoint> curvesOf(const Scene& scene, const StepState& clock,
                                 const std::filesystem::path& folder) {
    Measurement now;
    now.time = clock.time, now.steps = clock.steps;
    const Output& output = scene.output;
    for (const std::string& name : {output.hdf5, output.csv, output.json})
        for (const std::filesystem::path& path : {std::filesystem::path(name), folder / name}) {
            std::error_code none;
            if (!std::filesystem::is_regular_file(path, none)) continue;
            try {
                return curvesOf(rowsBefore(now, readSeries(path.string())),
                                scene.simulation.dimensions);
            } catch (const Error&) {}  // it is another run's
        }
    return {};
}

}  // namespace

Start goOn(const std::string& file, const std::vector<KnobChoice>& choices) {
    auto [scene, state, curves] = readCheckpoint(file);
    const auto before = builtFrom(scene);
    if (auto whole = curvesOf(scene, state.clock, std::filesystem::path(file).parent_path());
        !whole.empty())
        curves = std::move(whole);
    const std::string left = leaveOutputs(scene.output);
    const View view = scene.view;
    const Window window = scene.window;
    applyChoices(scene, choices);
    for (const auto& [path, value] : builtFrom(scene))
        if (const auto old = before.find(path); old == before.end() || old->second != value)
            throw Error(Failure::Usage,
                        path + ": can't be changed in a run that has begun; start the scene again");
    checkScene(scene, file, countOf(state.particles));
    chooseEnd(scene, choices, state.clock, file);
    std::string said = fmt::format("{}: goes on from step {} ({:.6g} s)", file, state.clock.steps,
                                   state.clock.time);
    if (!left.empty()) said += "; only what is named again is written, before it was " + left;
    return {std::move(scene), std::move(state), file, view, window, std::move(curves), said};
}

}  // namespace spindrift
