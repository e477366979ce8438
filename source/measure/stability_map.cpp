#include "measure/stability_map.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

constexpr int Steps = 400;

// A knob, or what stands for several: its values, wider than a scene file may ask for.
struct Turned {
    const char *name, *unit;
    double least, most;
    double (*usual)(const Scene&, double step);
    void (*set)(Scene&, double value, double step);  // `step`: mean of the automatic one, s
};
const Turned TurnedKnobs[] = {
    {"time.step", "of the automatic step", 0.25, 16, [](const Scene&, double) { return 1.0; },
     [](Scene& s, double v, double step) {
         s.time.mode = TimeMode::Fixed, s.time.step = float(v * step);
     }},
    {"time.cfl", "", 0.05, 4, [](const Scene& s, double) { return double(s.time.cfl); },
     [](Scene& s, double v, double) { s.time.cfl = float(v); }},
    {"fluid.viscosity", "Pa s", 1e-3, 1e3,
     [](const Scene& s, double) { return double(s.fluid.viscosity); },
     [](Scene& s, double v, double) { s.fluid.viscosity = float(v); }},
    {"fluid.artificial_viscosity", "", 0.005, 2,
     [](const Scene& s, double) { return double(s.fluid.artificialViscosity); },
     [](Scene& s, double v, double) { s.fluid.artificialViscosity = float(v); }},
    // The speed of sound, and with its square the stiffness.
    {"fluid.speed_ratio", "", 1, 100,
     [](const Scene& s, double) { return double(s.fluid.speedRatio); },
     [](Scene& s, double v, double) { s.fluid.speedRatio = float(v); }},
    {"fluid.bodies[0].velocity", "m/s", 0.1, 1000,
     [](const Scene& s, double) { return double(length(s.fluid.bodies[0].velocity)); },
     [](Scene& s, double v, double) {
         s.fluid.bodies[0].velocity =
             float(v / length(s.fluid.bodies[0].velocity)) * s.fluid.bodies[0].velocity;
     }},
    {"simulation.support", "dx", 1.5, 6,
     [](const Scene& s, double) { return double(s.simulation.support); },
     [](Scene& s, double v, double) { s.simulation.support = float(v); }},
};

struct Candidate {
    const char *scene, *formulation;
    std::vector<std::string> knobs;
};

std::vector<Candidate> candidates() {
    const std::string dam =
        R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.5,0.6,1],"velocity":[1,0,0]}])";
    const std::string drop =
        R"(fluid.bodies=[{"shape":"sphere","center":[0.5,0.5,0.5],"radius":0.25,"velocity":[0,)"
        R"(-5,0]},)"
        R"({"shape":"block","min":[0,0,0],"max":[1,0.2,1]}])";
    const std::string pool =
        R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,1],"velocity":[0,-0.1,0]}])";
    std::vector<Candidate> out;
    for (const auto& [scene, body] :
         {std::pair{"dam break", dam}, {"drop impact", drop}, {"still pool", pool}})
        for (const char* formulation : {"wcsph", "delta_sph", "delta_plus"})
            out.push_back({scene, formulation, {body}});
    out.push_back(
        {"vortices in a full box",
         "transport_velocity",
         {"simulation.dimensions=2", "simulation.gravity=0,0,0", "simulation.spacing=0.03",
          "fluid.rest_density=1", "domain.max=0.99,0.99,1", "fluid.equation_of_state=linear",
          R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.99,0.99,1],"velocity":[1,0,)"
          R"(0],"field":"taylor_green"}])"}});
    return out;
}

Verdict tryOut(const StressCase& c) {
    try {
        return stress(c).verdict;
    } catch (const Error&) { return Verdict::Stopped; }  // no such scene
}

// Tries values from the usual one outwards until the first that is not sound, then between the last
// two.
struct Search {
    const StressCase& usual;
    const Turned& axis;
    double step;
    StabilityRow& row;

    bool sound(double value) {
        StressCase c = usual;
        axis.set(c.scene, value, step);
        row.tried.push_back({value, tryOut(c)});
        return row.tried.back().second == Verdict::Sound;
    }
    double limit(double from, double end) {
        const double factor = end > from ? 2 : 0.5;
        double good = from, bad = 0;
        while (good != end && bad == 0) {
            // In long ranges by larger strides at first.
            const double stride =
                std::abs(std::log2(end / good)) > 6 ? factor * factor * factor : factor;
            const double next =
                factor > 1 ? std::min(good * stride, end) : std::max(good * stride, end);
            (sound(next) ? good : bad) = next;
        }
        while (bad != 0 && std::abs(std::log10(bad / good)) > 0.1) {
            const double middle = std::sqrt(good * bad);
            (sound(middle) ? good : bad) = middle;
        }
        return good;
    }
};

StabilityRow searched(const Candidate& c, const StressCase& usual, const Turned& axis,
                      double step) {
    StabilityRow row{c.formulation, axis.name, axis.unit, axis.usual(usual.scene, step),
                     axis.least,    axis.most, 0,         0,
                     false,         {}};
    Search search{usual, axis, step, row};
    row.usualIsSound = search.sound(row.usual);
    row.low = row.high = row.usual;
    if (row.usualIsSound)
        row.low = search.limit(row.usual, std::min(axis.least, row.usual)),
        row.high = search.limit(row.usual, std::max(axis.most, row.usual));
    std::sort(row.tried.begin(), row.tried.end());
    return row;
}

constexpr double Width = 760, Left = 300, Right = 70, Top = 66, RowHeight = 22;
constexpr const char* VerdictColors[] = {"#009e73", "#e69f00",
                                         "#d55e00"};  // that colour-blind eyes tell apart

std::string drawn(const StabilityRow& row, double y) {
    const auto x = [&](double v) {
        return Left +
               std::log(v / row.least) / std::log(row.most / row.least) * (Width - Right - Left);
    };
    std::string out = fmt::format(
        "<text x='{}' y='{}' text-anchor='end'>{} {}</text><text x='{}' y='{}' text-anchor='end' "
        "fill='#777'>{:.3g}</text>"
        "<text x='{}' y='{}' fill='#777'>{:.3g}</text>\n",
        Left - 60, y + 4, row.formulation, row.knob, Left - 8, y + 4, row.least, Width - Right + 8,
        y + 4, row.most);
    out += fmt::format("<path d='M{} {}H{}' stroke='#ddd'/>", Left, y, Width - Right);
    if (row.usualIsSound)
        out +=
            fmt::format("<path d='M{:.1f} {}H{:.1f}' stroke='{}' stroke-width='7' opacity='0.35'/>",
                        x(row.low), y, x(row.high), VerdictColors[0]);
    out += fmt::format("<path d='M{:.1f} {}v16' stroke='black' stroke-width='2'/>", x(row.usual),
                       y - 8);
    for (const auto& [value, verdict] : row.tried)
        out += fmt::format("<circle cx='{:.1f}' cy='{}' r='4' fill='{}'/>", x(value), y,
                           VerdictColors[int(verdict)]);
    return out + "\n";
}

}  // namespace

std::vector<std::string> mapScenes() {
    return {"dam break", "drop impact", "still pool", "vortices in a full box"};
}

StabilityMap stabilityMap(const std::string& scene, const std::string& formulation,
                          const std::string& knob) {
    StabilityMap map{scene, {}};
    for (const Candidate& c : candidates()) {
        if (c.scene != scene || std::string(c.formulation).find(formulation) == std::string::npos)
            continue;
        StressCase usual = boxCase(c.formulation, c.knobs, Steps);
        usual.scene.time.retries = 0;
        const auto simulation = makeSimulation(usual.scene);
        simulation->step(Steps);
        const double step = simulation->measure().time / Steps;
        for (const Turned& axis : TurnedKnobs)
            if (std::string(axis.name).find(knob) != std::string::npos)
                map.rows.push_back(searched(c, usual, axis, step));
    }
    return map;
}

std::string svg(const StabilityMap& map) {
    const double height = Top + RowHeight * double(map.rows.size()) + 16;
    std::string out = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
        "font-family='sans-serif' "
        "font-size='13'>\n<rect width='100%' height='100%' fill='white'/>\n<text x='16' y='24' "
        "font-size='16'>What stays sound: "
        "{2}</text>\n",
        Width, height, map.scene);
    const char* names[] = {"sound", "stopped by the health guard", "broken"};
    double x = 20;
    for (int v = 0; v < 3; ++v, x += v == 0 ? 70 : 230)
        out +=
            fmt::format("<circle cx='{}' cy='42' r='4' fill='{}'/><text x='{}' y='46'>{}</text>\n",
                        x, VerdictColors[v], x + 10, names[v]);
    out += fmt::format(
        "<path d='M{} 34v16' stroke='black' stroke-width='2'/><text x='{}' y='46'>usual "
        "value</text>\n",
        x - 90, x - 80);
    for (size_t k = 0; k < map.rows.size(); ++k)
        out += drawn(map.rows[k], Top + RowHeight * (double(k) + 0.5));
    return out + "</svg>\n";
}

}  // namespace spindrift
