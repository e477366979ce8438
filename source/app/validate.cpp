#include "app/exit_code.h"
#include "app/validate.h"

#include "core/error.h"
#include "core/output_file.h"
#include "measure/validation.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/suggest.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spindrift {

std::vector<ValidationCase> chooseCases(const std::vector<ValidationCase>& all,
                                        const std::vector<std::string>& names) {
    if (names.empty()) return all;
    std::vector<std::string> known;
    for (const ValidationCase& c : all) known.push_back(c.name);
    std::vector<ValidationCase> chosen;
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            const std::string nearest = nearestName(name, known);
            throw Error(
                Failure::Usage,
                fmt::format("{}: no such case; {}cases: {}", name,
                            nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest),
                            listed(known)));
        }
        chosen.push_back(all[size_t(found - known.begin())]);
    }
    return chosen;
}

namespace {

Scene sceneFor(const ValidationCase& c, int resolution, const ValidateOptions& options) {
    Scene scene = loadScene(findScene("validation/" + c.scene));
    c.adjust(scene, resolution);
    applyChoices(scene, options.choices);
    checkScene(scene, c.name);
    return scene;
}

// Between two runs of one case, of its first metric; NaN without a run before.
double order(const ValidationRun* before, const ValidationRun& run) {
    if (!before || before->metrics.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::log(std::abs(before->metrics[0].value / run.metrics[0].value)) /
           std::log(double(run.resolution) / before->resolution);
}

void print(const ValidationCase& c, const ValidationRun& run, double order) {
    fmt::print("\n{} = {}: {}, {} + {} particles, {} steps, {:.1f} s", c.length, run.resolution,
               run.method, run.cost.particles, run.cost.walls, run.cost.steps, run.cost.seconds);
    fmt::print("{}\n", std::isfinite(order) ? fmt::format(", order {:.2f}", order) : "");
    for (const Metric& m : run.metrics) {
        const bool missed = m.target && !(std::abs(m.value) <= *m.target);
        fmt::print(
            "  {:36} {:>11.4g} {:3}{}\n", m.name, m.value, m.unit,
            m.target ? fmt::format("  target {:g}{}", *m.target, missed ? "  MISSED" : "") : "");
    }
    std::fflush(stdout);
}

// One line a run: its metrics, targets beside them.
std::string tableRow(const ValidationCase& c, const ValidationRun& run, double order) {
    std::string metrics;
    for (const Metric& m : run.metrics) {
        const bool missed = m.target && !(std::abs(m.value) <= *m.target);
        metrics += fmt::format(
            "{}{}{} {:.3g}{}{}{}", metrics.empty() ? "" : "; ", missed ? "**" : "", m.name, m.value,
            m.unit.empty() ? "" : " " + m.unit,
            m.target ? fmt::format(" (target {:g})", *m.target) : "", missed ? " missed**" : "");
    }
    return fmt::format("| {} | {} = {} | {} | {} | {:.1f} |\n", c.title, c.length, run.resolution,
                       metrics, std::isfinite(order) ? fmt::format("{:.1f}", order) : "",
                       run.cost.seconds);
}

nlohmann::json describe(const ValidationCase& c, const ValidationRun& run, double order) {
    nlohmann::json metrics = nlohmann::json::array();
    for (const Metric& m : run.metrics) {
        nlohmann::json row = {{"name", m.name}, {"unit", m.unit}, {"value", m.value}};
        if (m.target) row["target"] = *m.target, row["passed"] = std::abs(m.value) <= *m.target;
        metrics.push_back(row);
    }
    return {{"case", c.name},
            {"title", c.title},
            {"reference", c.reference},
            {"method", run.method},
            {"resolution", run.resolution},
            {"particles", run.cost.particles},
            {"boundary", run.cost.walls},
            {"steps", run.cost.steps},
            {"seconds", run.cost.seconds},
            {"megabytes", run.cost.megabytes},
            {"order", order},
            {"metrics", metrics}};
}

}  // namespace

int validate(const ValidateOptions& options) {
    const std::vector<ValidationCase> cases =
        chooseCases(validationCases(configsFolder() + "/validation/data"), options.cases);
    if (options.list) {
        for (const ValidationCase& c : cases) fmt::print("{:22} {}\n", c.name, c.title);
        return int(Exit::Ok);
    }
    if (!options.out.empty()) requireFolder(options.out);
    auto resolutionsOf = [&](const ValidationCase& c) {
        return !options.resolutions.empty() ? options.resolutions
               : options.quick              ? c.quick
                                            : c.resolutions;
    };
    // An hour of computing must not end at a mistake.
    for (const ValidationCase& c : cases)
        for (int resolution : resolutionsOf(c)) sceneFor(c, resolution, options);
    nlohmann::json rows = nlohmann::json::array();
    std::string markdown = "| case | resolution | errors | order | s |\n|---|---|---|---|---|\n";
    int judged = 0, passed = 0;
    for (const ValidationCase& c : cases) {
        const std::vector<int> resolutions = resolutionsOf(c);
        if (resolutions.empty()) continue;
        fmt::print("\n=== {} ({}), against {}\n", c.title, c.name, c.reference);
        std::optional<ValidationRun> before;
        for (int resolution : resolutions) {
            ValidationRun run = validate(c, sceneFor(c, resolution, options), resolution);
            const double p = order(before ? &*before : nullptr, run);
            print(c, run, p);
            rows.push_back(describe(c, run, p));
            markdown += tableRow(c, run, p);
            for (const Metric& m : run.metrics)
                if (m.target) ++judged, passed += std::abs(m.value) <= *m.target;
            if (!options.out.empty()) {
                writeText(fmt::format("{}/{}_{}.svg", options.out, c.name, resolution),
                          svg(run.chart));
                writeText(options.out + "/validation.json", rows.dump(2) + "\n");
                writeText(options.out + "/validation.md", markdown);
            }
            before = std::move(run);
        }
    }
    fmt::print("\n{} of {} targets met\n", passed, judged);
    return int(passed == judged ? Exit::Ok : Exit::Different);
}

}  // namespace spindrift
