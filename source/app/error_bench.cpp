#include "app/error_bench.h"

#include "app/validate.h"
#include "core/error.h"
#include "measure/output_file.h"
#include "measure/validation.h"
#include "scene/check.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spindrift {
namespace {

// What differs from the case's scene.
struct Variant { std::string name; std::vector<std::pair<std::string, std::string>> knobs; };

std::vector<Variant> variants() {
    std::vector<Variant> all{{"as shipped", {}}};
    for (const char* f : {"wcsph", "delta_sph", "delta_plus", "transport_velocity"}) all.push_back({f, {{"simulation.formulation", f}}});
    for (const char* r : {"2", "2.3", "3", "3.5"}) all.push_back({fmt::format("R = {} dx", r), {{"simulation.support", r}}});
    all.push_back({"cubic spline", {{"simulation.kernel", "cubic_spline"}}});
    for (const char* c : {"0.2", "0.4", "0.8", "1"}) all.push_back({fmt::format("cfl {}", c), {{"time.cfl", c}}});
    all.push_back({"double precision", {{"compute.precision", "double"}}});
    if (whyNoGpu(Scene{}).empty()) all.push_back({"GPU", {{"compute.backend", "cuda"}}});
    return all;
}

// Errors that others have reached, where no run time is known: CASES of the literature, as cited.
struct Known { const char* name; const char* what; double error; };
constexpr Known Peers[] = {
    {"taylor_green", "PySPH EDAC, N = 100 (stored results, 2020)", 1.38},
    {"taylor_green", "delta+-SPH in PySPH, N = 100 (2020)", 3.6},
    {"cavity_re100", "delta+-SPH in PySPH, N = 50", 0.52},
    {"cavity_re100", "PySPH EDAC, N = 50", 0.69},
};

struct Point {
    std::string variant;
    ValidationRun run;
    bool shipped = false, front = false;
    double error() const { return std::abs(run.metrics[0].value); }
    double stepsPerSecond() const { return double(run.cost.steps) * run.cost.particles / run.cost.seconds; }
};

// The scene of a variant, or none when it makes no sense there: transport_velocity has no free surfaces.
bool choose(const ValidationCase& c, const Variant& variant, int resolution, Scene& scene) {
    scene = loadScene(findScene("validation/" + c.scene));
    scene.compute.backend = Backend::Cpu;
    c.adjust(scene, resolution);
    const std::string before = writeScene(scene);
    for (const auto& [path, value] : variant.knobs) setKnob(scene, path + "=" + value);
    if (!variant.knobs.empty() && writeScene(scene) == before) return false;   // is as shipped
    try {
        checkScene(scene, c.name);
        return true;
    } catch (const Error&) { return false; }
}

void markFront(std::vector<Point>& points) {
    for (Point& p : points)
        p.front = std::isfinite(p.error()) && std::none_of(points.begin(), points.end(), [&](const Point& o) {
                      return o.run.cost.seconds < p.run.cost.seconds && o.error() <= p.error();
                  });
}

std::vector<Point> sweep(const ValidationCase& c) {
    std::vector<Point> points;
    for (const Variant& variant : variants())
        for (int resolution : c.resolutions) {
            Scene scene;
            if (!choose(c, variant, resolution, scene)) continue;
            points.push_back({variant.name, validate(c, scene, resolution), variant.knobs.empty()});
            const Point& p = points.back();
            fmt::print("{:20} {:>5} {:>12.4g} {:>9.2f} {:>9} {:>12.3g} {:>8.1f}\n", p.variant, resolution, p.error(),
                       p.run.cost.seconds, p.run.cost.steps, p.stepsPerSecond(), p.run.cost.megabytes);
            std::fflush(stdout);
        }
    markFront(points);
    return points;
}

Chart chartOf(const ValidationCase& c, const std::vector<Point>& points) {
    const Metric& metric = points.front().run.metrics[0];
    Chart chart{c.title + ": error against run time", "run time, s", metric.name + ", " + metric.unit, {}, true, true};
    Curve shipped{"as shipped, " + c.length, {}, {}, Curve::Line}, other{"one thing changed", {}, {}, Curve::Points};
    Curve front{"Pareto front", {}, {}, Curve::Dashed};
    std::vector<const Point*> sorted;
    for (const Point& p : points) {
        Curve& curve = p.shipped ? shipped : other;
        curve.x.push_back(p.run.cost.seconds), curve.y.push_back(p.error());
        if (p.front) sorted.push_back(&p);
    }
    std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->run.cost.seconds < b->run.cost.seconds; });
    for (const Point* p : sorted) front.x.push_back(p->run.cost.seconds), front.y.push_back(p->error());
    chart.curves = {shipped, other, front};
    const auto [least, most] = std::minmax_element(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return a.run.cost.seconds < b.run.cost.seconds;
    });
    for (const Known& k : Peers)
        if (c.name == k.name)
            chart.curves.push_back({k.what, {least->run.cost.seconds, most->run.cost.seconds}, {k.error, k.error}, Curve::Dashed});
    return chart;
}

std::string table(const ValidationCase& c, const std::vector<Point>& points) {
    const Metric& metric = points.front().run.metrics[0];
    std::string text = fmt::format("\n### {}\n\nError: {}, {}. Resolution: {}. Against {}. **Bold**: on the Pareto front.\n\n"
                                   "| method | resolution | error | seconds | steps | million particle-steps a second | MB |\n"
                                   "|---|---|---|---|---|---|---|\n",
                                   c.title, metric.name, metric.unit, c.length, c.reference);
    for (const Point& p : points) {
        const char* bold = p.front ? "**" : "";
        const std::string error = std::isfinite(p.error()) ? fmt::format("{:.3g}", p.error()) : "diverged";
        text += fmt::format("| {0}{1}{0} | {2} | {0}{3}{0} | {4:.2f} | {5} | {6:.1f} | {7:.1f} |\n", bold, p.variant, p.run.resolution,
                            error, p.run.cost.seconds, p.run.cost.steps, p.stepsPerSecond() / 1e6, p.run.cost.megabytes);
    }
    return text;
}

nlohmann::json describe(const ValidationCase& c, const Point& p) {
    return {{"case", c.name}, {"variant", p.variant}, {"method", p.run.method}, {"resolution", p.run.resolution},
            {"error", p.error()}, {"seconds", p.run.cost.seconds}, {"steps", p.run.cost.steps},
            {"particles", p.run.cost.particles}, {"particle_steps_per_second", p.stepsPerSecond()},
            {"megabytes", p.run.cost.megabytes}, {"front", p.front}};
}

}  // namespace

int benchError(const ErrorBenchOptions& options) {
    const std::vector<std::string> names =
        options.cases.empty() ? std::vector<std::string>{"taylor_green", "poiseuille_re100", "cavity_re100", "drop", "hydrostatic"}
                              : options.cases;
    if (!options.out.empty()) requireFolder(options.out);
    nlohmann::json rows = nlohmann::json::array();
    std::string csv = "case,variant,resolution,error,seconds,steps,particles,particle_steps_per_second,megabytes,front\n", markdown;
    for (const ValidationCase& all : chooseCases(validationCases(configsFolder() + "/validation/data"), names)) {
        ValidationCase c = all;
        if (c.resolutions.size() > 2) c.resolutions.resize(2);   // the finest ones take minutes each
        fmt::print("\n=== {}\n{:20} {:>5} {:>12} {:>9} {:>9} {:>12} {:>8}\n", c.title, "method", c.length.substr(0, 1) + "/dx", "error",
                   "seconds", "steps", "p-steps/s", "MB");
        const std::vector<Point> points = sweep(c);
        for (const Point& p : points) {
            rows.push_back(describe(c, p));
            csv += fmt::format("{},{},{},{:.6g},{:.4g},{},{},{:.4g},{:.4g},{}\n", c.name, p.variant, p.run.resolution, p.error(),
                               p.run.cost.seconds, p.run.cost.steps, p.run.cost.particles, p.stepsPerSecond(),
                               p.run.cost.megabytes, int(p.front));
        }
        markdown += table(c, points);
        if (options.out.empty()) continue;
        writeText(options.out + "/error_" + c.name + ".svg", svg(chartOf(c, points)));
        writeText(options.out + "/error.csv", csv);
        writeText(options.out + "/error.json", rows.dump(2) + "\n");
        writeText(options.out + "/error.md", markdown);
    }
    return int(Exit::Ok);
}

}  // namespace spindrift
