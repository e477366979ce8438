#include "app/exit_code.h"
#include "app/error_bench.h"

#include "app/validate.h"
#include "core/error.h"
#include "core/output_file.h"
#include "measure/validation.h"
#include "scene/check.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace spindrift {
namespace {

// What differs from the case's scene.
struct Variant {
    std::string name;
    std::vector<std::pair<std::string, std::string>> knobs;
};

// A case, and where its sweep begins: coarse enough that a hundred methods are tried in a minute or
// two.
struct Sweep {
    const char* name;
    std::vector<int> resolutions;
};
const Sweep Sweeps[] = {{"taylor_green", {50, 100, 200}},
                        {"poiseuille_re100", {20, 40}},
                        {"drop", {15, 25, 50}},
                        {"hydrostatic", {20, 30, 60}},
                        {"dam_break_pressure", {30, 40, 80}},
                        {"cavity_re100", {25, 50}}};

const Variant Shipped{"as shipped", {}};

Variant operator+(const Variant& a, const Variant& b) {
    Variant both{a.name + " " + b.name, a.knobs};
    both.knobs.insert(both.knobs.end(), b.knobs.begin(), b.knobs.end());
    return both;
}

// Formulation x kernel and support, with the case's own steps.
std::vector<Variant> methods() {
    std::vector<Variant> formulations, kernels, all;
    for (const auto& [name, knob] : {std::pair{"wcsph", "wcsph"},
                                     {"delta", "delta_sph"},
                                     {"delta+", "delta_plus"},
                                     {"transport", "transport_velocity"},
                                     {"solved", "incompressible"}})
        formulations.push_back({name, {{"simulation.formulation", knob}}});
    constexpr struct {
        const char *letters, *knob, *support;
    } Kernels[] = {{"W2", "wendland_c2", "2"},   {"W2", "wendland_c2", "2.3"},
                   {"W2", "wendland_c2", "2.6"}, {"W2", "wendland_c2", "3.2"},
                   {"W4", "wendland_c4", "3.2"}, {"W6", "wendland_c6", "3.2"},
                   {"C", "cubic_spline", "2.6"}, {"Q", "quintic_spline", "3.2"}};
    for (const auto& k : Kernels)
        kernels.push_back({fmt::format("{} {}", k.letters, k.support),
                           {{"simulation.kernel", k.knob}, {"simulation.support", k.support}}});
    for (const Variant& formulation : formulations)
        for (const Variant& kernel : kernels) all.push_back(formulation + kernel);
    return all;
}

// Each of them with other steps.
std::vector<Variant> steps(const std::vector<Variant>& chosen) {
    std::vector<Variant> all;
    for (const auto& [letters, integrator, cfl] : {std::tuple{"E 0.2", "symplectic_euler", "0.2"},
                                                   {"E 0.4", "symplectic_euler", "0.4"},
                                                   {"E 0.8", "symplectic_euler", "0.8"},
                                                   {"V 0.4", "velocity_verlet", "0.4"},
                                                   {"P 0.5", "predictor_corrector", "0.5"},
                                                   {"P 1", "predictor_corrector", "1"}})
        for (const Variant& v : chosen)
            all.push_back(v +
                          Variant{letters, {{"time.integrator", integrator}, {"time.cfl", cfl}}});
    return all;
}

// What changes nothing but time and round-off, tried with the shipped method only; not at the
// finest resolution in double precision, which takes ten times as long.
std::vector<Variant> machines(const Scene& scene, bool finest) {
    const auto simulation = makeSimulation(scene);
    simulation->step(20);
    const double step = simulation->measure().dt;
    std::vector<Variant> all;
    for (double factor : {1.0, 2.0})
        all.push_back(
            {fmt::format("fixed step x {:g}", factor),
             {{"time.mode", "fixed"}, {"time.step", fmt::format("{:.6g}", factor * step)}}});
    if (!finest) all.push_back({"double", {{"compute.precision", "double"}}});
    if (whyNoGpu(Scene{}).empty()) all.push_back({"GPU", {{"compute.backend", "cuda"}}});
    return all;
}

// Errors that others have reached, where no run time is known: CASES of the literature, as cited.
struct Known {
    const char* name;
    const char* what;
    double error;
};
constexpr Known Peers[] = {
    {"taylor_green", "PySPH EDAC, N = 100 (stored results, 2020)", 1.38},
    {"taylor_green", "PySPH TVF, N = 100 (stored results, 2020)", 5.1},
    {"taylor_green", "delta+-SPH in PySPH, N = 100 (2020)", 3.6},
    {"cavity_re100", "delta+-SPH in PySPH, N = 50", 0.52},
    {"cavity_re100", "PySPH EDAC, N = 50", 0.69},
};

struct Point {
    Variant variant;
    ValidationRun run;
    bool shipped = false, competes = false, front = false;  // competes: for being tried finer
    double error() const { return run.diverged ? std::nan("") : std::abs(run.metrics[0].value); }
    double stepsPerSecond() const {
        return double(run.cost.steps) * run.cost.particles / run.cost.seconds;
    }
};

// The scene of a variant, or none when it makes no sense there: transport_velocity has no free
// surfaces.
bool choose(const ValidationCase& c, const Variant& variant, int resolution, Scene& scene) {
    scene = loadScene(findScene("validation/" + c.scene));
    scene.compute.backend = Backend::Cpu;
    c.adjust(scene, resolution);
    const std::string before = writeScene(scene);
    for (const auto& [path, value] : variant.knobs) setKnob(scene, path + "=" + value);
    if (!variant.knobs.empty() && writeScene(scene) == before) return false;  // is as shipped
    try {
        checkScene(scene, c.name);
        return true;
    } catch (const Error&) { return false; }
}

void markFront(std::vector<Point>& points) {
    for (Point& p : points)
        p.front = std::isfinite(p.error()) &&
                  std::none_of(points.begin(), points.end(), [&](const Point& o) {
                      return o.run.cost.seconds < p.run.cost.seconds && o.error() <= p.error();
                  });
}

// Worth to be tried finer: the front of a resolution, and what is nearly on it.
std::vector<Variant> survivors(std::vector<Point> points, int resolution) {
    std::erase_if(points, [&](const Point& p) {
        return p.run.resolution != resolution || !p.competes || !std::isfinite(p.error());
    });
    std::vector<Variant> kept;
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return a.run.cost.seconds < b.run.cost.seconds;
    });
    double best = 1e300;
    for (const Point& p : points) {
        if (p.error() > 1.1 * best) continue;
        best = std::min(best, p.error());
        kept.push_back(p.variant);
    }
    // The best ones when there are many.
    if (kept.size() > 8) kept.erase(kept.begin(), kept.end() - 8);
    return kept;
}

std::vector<Point> sweep(const ValidationCase& c) {
    std::vector<Point> points;
    auto tryAll = [&](const std::vector<Variant>& variants, int resolution, bool compete) {
        for (const Variant& variant : variants) {
            Scene scene;
            if (!choose(c, variant, resolution, scene)) continue;
            points.push_back(
                {variant, validate(c, scene, resolution), variant.knobs.empty(), compete});
            const Point& p = points.back();
            fmt::print("{:24} {:>5} {:>12.4g} {:>9.2f} {:>9} {:>12.3g} {:>8.1f}\n", variant.name,
                       resolution, p.error(), p.run.cost.seconds, p.run.cost.steps,
                       p.stepsPerSecond(), p.run.cost.megabytes);
            std::fflush(stdout);
        }
    };
    std::vector<Variant> best;
    for (int resolution : c.resolutions) {
        Scene shipped;
        choose(c, Shipped, resolution, shipped);
        tryAll({Shipped}, resolution, false);
        tryAll(machines(shipped, resolution == c.resolutions.back()), resolution, false);
        const bool coarsest = resolution == c.resolutions.front();
        tryAll(coarsest ? methods() : best, resolution, true);
        if (coarsest) tryAll(steps(survivors(points, resolution)), resolution, true);
        best = survivors(points, resolution);
    }
    markFront(points);
    return points;
}

Chart chartOf(const ValidationCase& c, const std::vector<Point>& points) {
    const Metric& metric = points.front().run.metrics[0];
    Chart chart{c.title + ": error against run time",
                "run time, s",
                metric.name + ", " + metric.unit,
                {},
                true,
                true};
    Curve shipped{"as shipped, " + c.length, {}, {}, Curve::Line},
        other{"other kernels, steps, formulations", {}, {}, Curve::Points};
    Curve front{"Pareto front", {}, {}, Curve::Dashed};
    std::vector<const Point*> sorted;
    for (const Point& p : points) {
        Curve& curve = p.shipped ? shipped : other;
        curve.x.push_back(p.run.cost.seconds), curve.y.push_back(p.error());
        if (p.front) sorted.push_back(&p);
    }
    std::sort(sorted.begin(), sorted.end(),
              [](auto* a, auto* b) { return a->run.cost.seconds < b->run.cost.seconds; });
    for (const Point* p : sorted) {
        front.x.push_back(p->run.cost.seconds), front.y.push_back(p->error());
        front.labels.push_back(fmt::format("{}, {}", p->variant.name, p->run.resolution));
    }
    chart.curves = {shipped, other, front};
    const auto [least, most] = std::minmax_element(
        points.begin(), points.end(),
        [](const Point& a, const Point& b) { return a.run.cost.seconds < b.run.cost.seconds; });
    for (const Known& k : Peers)
        if (c.name == k.name)
            chart.curves.push_back({k.what,
                                    {least->run.cost.seconds, most->run.cost.seconds},
                                    {k.error, k.error},
                                    Curve::Dashed});
    return chart;
}

// Of hundreds the ones that say something: the front, what is shipped, other precisions and
// devices, the best of each formulation.
bool tellsSomething(const Point& p, const std::vector<Point>& points) {
    if (p.front || !p.competes) return true;
    auto formulation = [](const Point& point) {
        return point.variant.name.substr(0, point.variant.name.find(' '));
    };
    return std::isfinite(p.error()) &&
           std::none_of(points.begin(), points.end(), [&](const Point& o) {
               return o.run.resolution == p.run.resolution && formulation(o) == formulation(p) &&
                      o.error() < p.error();
           });
}

std::string table(const ValidationCase& c, const std::vector<Point>& points) {
    const Metric& metric = points.front().run.metrics[0];
    std::string text = fmt::format(
        "\n### {}\n\nError: {}, {}. Resolution: {}. Against {}. **Bold**: on the Pareto front.\n\n"
        "W2, W4, W6, C, Q: Wendland C2, C4, C6, cubic or quintic spline kernel, and R / dx. E, V, "
        "P: symplectic Euler, velocity "
        "Verlet, predictor-corrector, and cfl; without them the case's own. Other steps: only with "
        "the best kernels; finer: "
        "only what was good at the coarser resolution. Shown are the front, the best of each "
        "formulation, the case as shipped; "
        "all that was tried is in error.csv.\n\n"
        "| method | resolution | error | seconds | steps | million particle-steps a second | MB |\n"
        "|---|---|---|---|---|---|---|\n",
        c.title, metric.name, metric.unit, c.length, c.reference);
    for (const Point& p : points) {
        if (!tellsSomething(p, points)) continue;
        const char* bold = p.front ? "**" : "";
        const std::string error =
            std::isfinite(p.error()) ? fmt::format("{:.3g}", p.error()) : "diverged";
        text += fmt::format("| {0}{1}{0} | {2} | {0}{3}{0} | {4:.2f} | {5} | {6:.1f} | {7:.1f} |\n",
                            bold, p.variant.name, p.run.resolution, error, p.run.cost.seconds,
                            p.run.cost.steps, p.stepsPerSecond() / 1e6, p.run.cost.megabytes);
    }
    return text;
}

nlohmann::json describe(const ValidationCase& c, const Point& p) {
    return {{"case", c.name},
            {"variant", p.variant.name},
            {"method", p.run.method},
            {"resolution", p.run.resolution},
            {"error", p.error()},
            {"seconds", p.run.cost.seconds},
            {"steps", p.run.cost.steps},
            {"particles", p.run.cost.particles},
            {"particle_steps_per_second", p.stepsPerSecond()},
            {"megabytes", p.run.cost.megabytes},
            {"front", p.front}};
}

}  // namespace

int benchError(const ErrorBenchOptions& options) {
    const std::vector<std::string> names =
        options.cases.empty()
            ? std::vector<std::string>{"taylor_green", "poiseuille_re100",   "drop",
                                       "hydrostatic",  "dam_break_pressure", "cavity_re100"}
            : options.cases;
    if (!options.out.empty()) requireFolder(options.out);
    nlohmann::json rows = nlohmann::json::array();
    std::string csv =
                    "case,variant,resolution,error,seconds,steps,particles,particle_steps_per_"
                    "second,megabytes,front\n",
                markdown;
    for (const ValidationCase& all :
         chooseCases(validationCases(configsFolder() + "/validation/data"), names)) {
        ValidationCase c = all;
        for (const Sweep& s : Sweeps)
            if (c.name == s.name) c.resolutions = s.resolutions;
        if (options.coarsest) c.resolutions.resize(1);
        fmt::print("\n=== {}\n{:20} {:>5} {:>12} {:>9} {:>9} {:>12} {:>8}\n", c.title, "method",
                   c.length.substr(0, 1) + "/dx", "error", "seconds", "steps", "p-steps/s", "MB");
        const std::vector<Point> points = sweep(c);
        for (const Point& p : points) {
            rows.push_back(describe(c, p));
            csv += fmt::format("{},{},{},{:.6g},{:.4g},{},{},{:.4g},{:.4g},{}\n", c.name,
                               p.variant.name, p.run.resolution, p.error(), p.run.cost.seconds,
                               p.run.cost.steps, p.run.cost.particles, p.stepsPerSecond(),
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
