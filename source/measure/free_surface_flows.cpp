#include "measure/free_surface_flows.h"

#include "core/table.h"
#include "measure/exact.h"
#include "measure/interpolate.h"
#include "measure/probes.h"
#include "measure/stepping.h"
#include "scene/convex.h"
#include "scene/particles.h"
#include "scene/start_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace spindrift {

using std::numbers::pi;

// --- C10 oscillating drop ---

void runDrop(const Scene& scene, ValidationRun& run) {
    constexpr int Periods = 10, PerPeriod = 60;
    const double T = OscillatingDrop::period;
    Stepping sim(scene, run);
    OscillatingDrop exact;
    Curve ours{"semi-axis", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    const Measurement first = sim->measure();
    double last = 0, axisSum = 0, momentum = 0;
    int axisCount = 0;
    std::vector<double> crossings;  // s, when the drop is round again and widens
    double before = 0, timeBefore = 0;
    for (int k = 0; k <= Periods * PerPeriod + PerPeriod / 4; ++k) {
        sim.until(k * T / PerPeriod);
        const std::vector<Particle> particles = sim->particles();
        const Measurement m = sim->measure();
        exact.advance(m.time - last), last = m.time;
        double xx = 0, yy = 0;
        for (const Particle& p : particles)
            xx += p.position.x * p.position.x, yy += p.position.y * p.position.y;
        const double n = double(particles.size()), a = 2 * std::sqrt(xx / n),
                     excess = a - 2 * std::sqrt(yy / n);
        if (k > PerPeriod / 2 && before < 0 &&
            excess >= 0)  // at the start the drop is round but for its last digits
            crossings.push_back(timeBefore + (m.time - timeBefore) * before / (before - excess));
        before = excess, timeBefore = m.time;
        if (k <= 3 * PerPeriod) axisSum += std::pow(a - exact.a, 2), ++axisCount;
        ours.x.push_back(m.time), ours.y.push_back(a);
        known.x.push_back(m.time), known.y.push_back(exact.a);
        momentum = std::max(momentum, length(m.momentum));
    }
    const Measurement end = sim->measure();
    const double M = particleMass(scene) * run.cost.particles;
    const double energy = end.kineticEnergy + end.potentialEnergy,
                 start = first.kineticEnergy + first.potentialEnergy;
    // Energy of a drop at rest would be left in potential energy: loss is measured against all, as
    // Sun 2017 does.
    const double period =
        crossings.size() >= Periods ? crossings[Periods - 1] / Periods : std::nan("");
    run.chart = {"", "t Omega", "a / R", {known, ours}};
    run.metrics = {
        {"semi-axis, rms of 3 periods / R", "%", 100 * std::sqrt(axisSum / axisCount), {}},
        {"period", "%", 100 * (period / T - 1), targetAt(run.resolution, 50, 0.5)},
        {"energy after 10 periods", "%", 100 * (energy / start - 1),
         targetAt(run.resolution, 50, 3.0)},
        {"largest momentum / (M s0 R)", "", momentum / M, targetAt(run.resolution, 50, 3e-4)}};
}

// --- viscosity at free surfaces ---

namespace {

// Of a function sampled at equal steps: where its peaks are, and how high.
struct Peaks {
    std::vector<double> at, height;
};
Peaks peaksOf(const Curve& curve) {
    Peaks peaks;
    for (size_t i = 1; i + 1 < curve.y.size(); ++i) {
        const double a = curve.y[i - 1], b = curve.y[i], c = curve.y[i + 1];
        if (!(b > a && b >= c && b > 1e-4 * curve.y[0])) continue;
        const double shift = 0.5 * (a - c) / (a - 2 * b + c);  // of the parabola through the three
        peaks.at.push_back(curve.x[i] + shift * (curve.x[i] - curve.x[i - 1]));
        peaks.height.push_back(b - 0.25 * (a - c) * shift);
    }
    return peaks;
}

// Slope of a line through points.
double slopeOf(const std::vector<double>& x, const std::vector<double>& y) {
    double meanX = 0, meanY = 0, xy = 0, xx = 0;
    for (size_t i = 0; i < x.size(); ++i)
        meanX += x[i] / double(x.size()), meanY += y[i] / double(x.size());
    for (size_t i = 0; i < x.size(); ++i)
        xy += (x[i] - meanX) * (y[i] - meanY), xx += (x[i] - meanX) * (x[i] - meanX);
    return xy / xx;
}

}  // namespace

void runOscillation(const Scene& scene, ValidationRun& run, std::complex<double> exact,
                    int periods) {
    constexpr int PerPeriod = 60;
    const double T = 2 * pi / exact.imag();
    Stepping sim(scene, run);
    // How much of the motion that there was at the start; sound and noise are not of it.
    auto amplitude = [&] {
        double sum = 0;
        for (const Particle& p : sim->particles()) {
            const Vec3d at = p.position - toDouble(scene.domain.min);
            sum += dot(p.velocity, startOf(scene, scene.fluid.bodies[0], at).velocity);
        }
        return sum;
    };
    Curve ours{"square of the velocity", {}, {}, Curve::Points},
        known{"decay", {}, {}, Curve::Line};
    for (int k = 0; k <= periods * PerPeriod; ++k) {
        sim.until(k * T / PerPeriod);
        ours.x.push_back(sim.time()), ours.y.push_back(std::pow(amplitude(), 2));
    }
    Peaks peaks = peaksOf(ours);
    std::vector<double> logarithms, numbers;
    for (size_t k = 0; k < peaks.at.size(); ++k)
        logarithms.push_back(std::log(peaks.height[k])), numbers.push_back(double(k));
    const double rate = -slopeOf(peaks.at, logarithms) / 2, period = 2 * slopeOf(numbers, peaks.at);
    for (double& y : ours.y) y /= peaks.height[0];
    for (size_t k = 0; k < ours.x.size(); ++k) {
        ours.x[k] /= T;
        known.x.push_back(ours.x[k]);
        known.y.push_back(std::exp(2 * exact.real() * (ours.x[k] * T - peaks.at[0])));
    }
    run.chart = {"", "t / T", "u^2 / of its first peak", {known, ours}, false, true};
    run.metrics = {
        {"decay rate", "%", 100 * (rate / -exact.real() - 1), targetAt(run.resolution, 50, 5.0)},
        {"period", "%", 100 * (period / T - 1), {}},
        {"energy left at the last peak", "%", 100 * peaks.height.back() / peaks.height[0], {}}};
}

void runViscousWave(const Scene& scene, ValidationRun& run) {
    const double k = 2 * pi / scene.domain.size().x, H = scene.fluid.bodies[0].max.y,
                 nu = scene.fluid.viscosity / scene.fluid.restDensity;
    runOscillation(scene, run, viscousWave(k, H, -scene.simulation.gravity.y, nu), 4);
}

void runViscousDrop(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity;
    runOscillation(scene, run,
                   viscousDrop(2, scene.fluid.bodies[0].radius, scene.simulation.centralRate, nu),
                   4);
}

void runRotation(const Scene& scene, ValidationRun& run) {
    Stepping sim(scene, run);
    const double mass = particleMass(scene);
    auto turning = [&] {  // kg m^2/s a metre
        double sum = 0;
        for (const Particle& p : sim->particles())
            sum += mass * (p.position.x * p.velocity.y - p.position.y * p.velocity.x);
        return sum;
    };
    const Measurement start = sim->measure();
    const double before = turning();
    Curve kinetic{"kinetic energy", {}, {}, Curve::Line};
    for (int k = 0; k <= 50; ++k) {
        sim.until(10.0 * k / 50);
        kinetic.x.push_back(sim.time());
        kinetic.y.push_back(sim->measure().kineticEnergy / start.kineticEnergy);
    }
    const Measurement end = sim->measure();
    run.chart = {"", "t Omega", "E_k / at the start", {kinetic}};
    run.metrics = {
        {"kinetic energy after t = 10", "%", 100 * (end.kineticEnergy / start.kineticEnergy - 1),
         targetAt(run.resolution, 25, 1.0)},
        {"kinetic and potential", "%",
         100 * ((end.kineticEnergy + end.potentialEnergy) /
                    (start.kineticEnergy + start.potentialEnergy) -
                1),
         targetAt(run.resolution, 25, 1.0)},
        {"angular momentum", "%", 100 * (turning() / before - 1), {}}};
}

void runFilm(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity,
                 F = scene.simulation.gravity.x, H = scene.fluid.bodies[0].max.y,
                 U = F * H * H / (2 * nu);
    Stepping sim(scene, run);
    sim.until(4 * H * H / nu);
    double sum = 0, flow = 0, top = 0;
    const std::vector<Particle> particles = sim->particles();
    Curve ours{"u", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    for (const Particle& p : particles) {
        const double y = p.position.y, u = F / (2 * nu) * y * (2 * H - y);
        sum += std::pow(p.velocity.x - u, 2) / double(particles.size());
        flow += p.velocity.x / double(particles.size());
        top = std::max(top, p.velocity.x);
        ours.x.push_back(y / H), ours.y.push_back(p.velocity.x / U);
    }
    for (int k = 0; k <= 50; ++k)
        known.x.push_back(k / 50.0), known.y.push_back(k / 50.0 * (2 - k / 50.0));
    run.chart = {"", "y / H", "u / U", {known, ours}};
    run.metrics = {
        {"L2 of u / U", "%", 100 * std::sqrt(sum) / U, targetAt(run.resolution, 20, 1.0)},
        {"mean velocity", "%", 100 * (flow / (2 * U / 3) - 1), targetAt(run.resolution, 20, 1.0)},
        {"largest velocity", "%", 100 * (top / U - 1), targetAt(run.resolution, 20, 1.0)}};
}

// --- C2 hydrostatic tank ---

namespace {

// What fluid does to a solid under water is the weight of the water in its place.
void addBuoyancy(const Scene& scene, const Measurement& m, double volume, ValidationRun& run) {
    if (volume == 0) return;
    const double weight = scene.fluid.restDensity * -scene.simulation.gravity.y * volume;
    run.metrics.push_back(
        {"lift of the solid", "%", 100 * (m.solids[0].pressureForce.y / weight - 1), 2.0});
}

}  // namespace

void runHydrostatic(const Scene& scene, ValidationRun& run, int judgedFrom, double volume) {
    const double g = -scene.simulation.gravity.y, H = scene.fluid.bodies[0].max.y,
                 rho0 = scene.fluid.restDensity;
    const double end = 20 * std::sqrt(H / g), width = scene.domain.max.x;
    Stepping sim(scene, run);
    Curve energy{"kinetic energy", {}, {}, Curve::Line};
    double early = 0, late = 0;
    const double M = particleMass(scene) * run.cost.particles;
    for (int k = 1; k <= 100; ++k) {
        sim.until(end * k / 100);
        const Measurement m = sim->measure();
        const double relative = m.kineticEnergy / (M * g * H);
        energy.x.push_back(m.time / std::sqrt(H / g)), energy.y.push_back(relative);
        if (k > 50 && k <= 60) early = std::max(early, relative);
        if (k > 90) late = std::max(late, relative);
    }
    double sum = 0, top = 0;
    const std::vector<Particle> particles = sim->particles();
    for (const Particle& p : particles) {
        sum += std::pow(p.pressure - rho0 * g * (H - p.position.y), 2);
        top = std::max(top, p.position.y);
    }
    std::vector<Vec3d> floor;
    for (int k = 1; k <= 5; ++k) {  // not where a solid stands
        const Vec3d point{width * k / 6, 0, 0.5 * scene.domain.max.z};
        if (std::none_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& s) {
                const Convex shape = convexOf(s, scene.simulation.dimensions);
                return shape.nearest(point - shape.middle).distance < scene.simulation.spacing;
            }))
            floor.push_back(point);
    }
    double bottom = 0;
    for (const Fields& f : interpolate(particles, floor, supportRadius(scene)))
        bottom += f.pressure / double(floor.size());
    run.chart = {"", "t sqrt(g / H)", "E_k / (M g H)", {energy}, false, true};
    run.metrics = {{"pressure, rms / (rho g H)", "%",
                    100 * std::sqrt(sum / double(particles.size())) / (rho0 * g * H),
                    targetAt(run.resolution, judgedFrom, 1.0)},
                   {"pressure at the floor", "%", 100 * (bottom / (rho0 * g * H) - 1),
                    targetAt(run.resolution, judgedFrom, 1.0)},
                   {"kinetic energy / (M g H)", "", energy.y.back(),
                    targetAt(run.resolution, judgedFrom, 1e-5)},
                   {"its growth from t = 10 to 20", "", std::max(0.0, late / early - 1),
                    targetAt(run.resolution, judgedFrom, 0.1)},
                   {"highest particle - H", "dx", (top - H) / scene.simulation.spacing + 0.5, {}}};
    addBuoyancy(scene, sim->measure(), volume, run);
}

// --- C13 dam break: front ---

void runFront(const Scene& scene, ValidationRun& run, const std::string& data) {
    const Table experiment = readTable(data + "/martin_moyce1952_front_n2eq2_a2.25in.csv");
    const double a = 1, g = -scene.simulation.gravity.y, scale = std::sqrt(2 * g / a);
    Stepping sim(scene, run);
    Curve ours{"front", {}, {}, Curve::Line};
    for (int k = 0; k <= 100; ++k) {
        sim.until(k * 6.0 / 100 / scale);
        ours.x.push_back(sim.time() * scale),
            ours.y.push_back(frontOf(sim->particles(), Axis::X) / a);
    }
    double sum = 0, most = 0;
    // Later the experiment's front thins out and friction holds it back.
    constexpr double Latest = 6;
    std::vector<double> T, Z;
    for (size_t i = 0; i < experiment.at("T").size() && experiment.at("T")[i] <= Latest; ++i)
        T.push_back(experiment.at("T")[i]), Z.push_back(experiment.at("Z")[i]);
    for (size_t i = 0; i < T.size(); ++i) {
        const double error = valueAt(ours.x, ours.y, T[i]) / Z[i] - 1;
        sum += std::abs(error) / double(T.size()), most = std::max(most, std::abs(error));
    }
    run.chart = {
        "", "t sqrt(2 g / a)", "front / a", {ours, {"Martin and Moyce 1952", T, Z, Curve::Points}}};
    run.metrics = {{"front, mean difference", "%", 100 * sum, targetAt(run.resolution, 20, 8.0)},
                   {"front, largest difference", "%", 100 * most, {}}};
}

// --- C13 dam break: pressures on the far wall ---

namespace {

double integral(const std::vector<double>& t, const std::vector<double>& p, double from,
                double to) {
    double sum = 0;
    for (size_t k = 1; k < t.size(); ++k)
        if (t[k - 1] >= from && t[k] <= to) sum += (t[k] - t[k - 1]) * (p[k] + p[k - 1]) / 2;
    return sum;
}

double meanOf(const std::vector<double>& t, const std::vector<double>& p, double from, double to) {
    return integral(t, p, from, to) / (to - from);
}
// When p first exceeds `threshold`.
double arrivalOf(const std::vector<double>& t, const std::vector<double>& p, double threshold) {
    const auto hit = std::find_if(p.begin(), p.end(), [&](double v) { return v > threshold; });
    return hit == p.end() ? std::nan("") : t[size_t(hit - p.begin())];
}

}  // namespace

void runImpact(const Scene& scene, ValidationRun& run, const std::string& data) {
    const Table experiment = readTable(data + "/lobovsky2014_H300_pressure.csv"),
                peaks = readTable(data + "/lobovsky2014_H300_peak_pressures.csv");
    const double H = 0.3, g = -scene.simulation.gravity.y, rho0 = scene.fluid.restDensity,
                 Latest = 4;
    constexpr const char* Columns[] = {"S1_3mm", "S2_15mm", "S3_30mm"};
    const Probes sensors(scene);
    const size_t sensor[] = {sensors.column("S1.pressure"), sensors.column("S2.pressure"),
                             sensors.column("S3.pressure")};
    Stepping sim(scene, run);
    std::vector<double> t, p[3];
    for (int k = 0; k <= 800; ++k) {
        sim.until(k * Latest / 800 * std::sqrt(H / g));
        t.push_back(sim.time() * std::sqrt(g / H));
        const std::vector<double> readings = sensors.read(sim->particles());
        for (size_t s = 0; s < 3; ++s) p[s].push_back(readings[sensor[s]] / (rho0 * g * H));
    }
    const std::vector<double>& te = experiment.at("t_star");
    const double impulse = integral(t, p[0], 2.4, Latest),
                 measured = integral(te, experiment.at(Columns[0]), 2.4, Latest);
    const double arrival = arrivalOf(t, p[0], 0.5);
    run.metrics = {
        {"impulse at S1, 2.4 < t* < 4", "%", 100 * (impulse / measured - 1),
         targetAt(run.resolution, 80, 10.0)},
        {"arrival at S1, t* - 2.44", "", arrival - 2.44, targetAt(run.resolution, 80, 0.1)}};
    run.chart = {"", "t sqrt(g / H)", "p / (rho g H)", {}};
    for (size_t s = 0; s < 3; ++s) {
        const std::vector<double> smooth = runningMean(t, p[s], 0.05);
        const double peak = *std::max_element(smooth.begin(), smooth.end());
        const double low = peaks.at("p2.5_P")[s], high = peaks.at("p97.5_P")[s];
        const double outside = std::max({0.0, low - peak, peak - high}) / peaks.at("median_P")[s];
        run.metrics.push_back({fmt::format("smoothed peak at S{}", s + 1), "", peak, {}});
        run.metrics.push_back({fmt::format("beyond its 95 % band {:.2f} to {:.2f}", low, high), "%",
                               100 * outside, targetAt(run.resolution, 80, 0.0)});
        Curve theirs{fmt::format("S{} measured", s + 1), te, experiment.at(Columns[s]),
                     Curve::Dashed};
        const size_t end = size_t(std::lower_bound(te.begin(), te.end(), Latest) - te.begin());
        theirs.x.resize(end), theirs.y.resize(end);
        run.chart.curves.push_back({fmt::format("S{}", s + 1), t, smooth, Curve::Line});
        run.chart.curves.push_back(theirs);
    }
}

// --- Settling sphere ---

void runSettling(const Scene& scene, ValidationRun& run, double terminal) {
    const Solid& sphere = scene.solids[0];
    const double end = 0.65, interval = 0.01;
    SettlingSphere known{2 * double(sphere.radius),   sphere.density,
                         scene.fluid.restDensity,     scene.fluid.viscosity,
                         -scene.simulation.gravity.y, terminal};
    Stepping sim(scene, run);
    Curve ours{"computed", {}, {}, Curve::Points},
        theirs{"equation of motion", {}, {}, Curve::Line};
    double last = 0, aside = 0, sunk = 0;
    for (int k = 0; k * interval <= end && !run.diverged; ++k) {
        sim.until(k * interval);
        const Measurement m = sim->measure();
        known.advance(m.time - last), last = m.time;
        const SolidMeasurement& s = m.solids[0];
        sunk = double(sphere.center.y) - s.position.y;
        aside = std::hypot(s.position.x - double(sphere.center.x),
                           s.position.z - double(sphere.center.z));
        ours.x.push_back(m.time), ours.y.push_back(-s.velocity.y);
        theirs.x.push_back(m.time), theirs.y.push_back(known.speed);
    }
    // Single impacts of particles are no speed of the flow.
    const std::vector<double> smooth = runningMean(ours.x, ours.y, 0.05);
    const double fastest = *std::max_element(smooth.begin(), smooth.end());
    run.chart = {"", "t, s", "speed, m/s", {theirs, ours}};
    run.metrics = {
        {"terminal speed", "%", 100 * (fastest / terminal - 1), targetAt(run.resolution, 40, 10)},
        {"sunk after 0.65 s", "%", 100 * (sunk / known.depth - 1), {}},
        {"gone aside / d", "", aside / known.diameter, targetAt(run.resolution, 40, 0.1)}};
}

// --- C14 dam break with a box ---

struct Record {
    const std::vector<double>&t, &values;  // s, Pa
    std::vector<double> smooth() const { return runningMean(t, values, 0.005); }
    double peak() const {
        const std::vector<double> means = smooth();
        double most = 0;
        for (size_t i = 0; i < t.size(); ++i)
            if (t[i] > 0.39 && t[i] < 0.6) most = std::max(most, means[i]);
        return most;
    }
};

// When and how hard the wave strikes a gauge; the first one that it meets is charted.
void addBlow(ValidationRun& run, const std::string& gauge, const Record& ours,
             const Record& measured, bool judged) {
    const bool first = gauge == "P1";
    auto target = [&](double value) {
        return first && judged ? std::optional(value) : std::nullopt;
    };
    const double late =
        arrivalOf(ours.t, ours.values, 500) - arrivalOf(measured.t, measured.values, 500);
    run.metrics.push_back({"arrival at " + gauge, "ms", 1000 * late, target(30)});
    run.metrics.push_back({"impulse at " + gauge + ", 0.39 < t < 1.2 s", "%",
                           100 * (integral(ours.t, ours.values, 0.39, 1.2) /
                                      integral(measured.t, measured.values, 0.39, 1.2) -
                                  1),
                           target(15)});
    run.metrics.push_back(
        {"smoothed peak at " + gauge, "%", 100 * (ours.peak() / measured.peak() - 1), {}});
    if (!first) return;
    auto scaled = [](std::vector<double> values) {
        for (double& v : values) v /= 20000;
        return values;
    };
    run.chart.curves.push_back({gauge, ours.t, scaled(ours.smooth()), Curve::Line});
    run.chart.curves.push_back(
        {gauge + " measured", measured.t, scaled(measured.smooth()), Curve::Dashed});
}

void runKleefsman(const Scene& scene, ValidationRun& run, const std::string& data) {
    const Table experiment = readTable(data + "/kleefsman2005_dam_break.csv");
    const double end = 6, depth = 0.55, interval = scene.output.sampleEvery;
    const Probes probes(scene);
    std::vector<double> t;
    std::map<std::string, std::vector<double>> ours;
    Stepping sim(scene, run);
    for (int k = 0; k * interval <= end && !run.diverged; ++k) {
        sim.until(k * interval);
        t.push_back(sim.time());
        const std::vector<double> readings = probes.read(sim->particles());
        for (const char* p : {"P1", "P3", "P5", "P7"})
            ours[p].push_back(readings[probes.column(std::string(p) + ".pressure")]);
        for (const char* h : {"H2", "H4"})
            ours[h].push_back(readings[probes.column(std::string(h) + ".height")]);
    }
    const std::vector<double>& te = experiment.at("t_s");
    const bool judged = run.resolution >= 30;
    auto target = [&](double value) { return judged ? std::optional(value) : std::nullopt; };
    run.chart = {"", "t, s", "water height, m; pressure, 20 kPa", {}};
    for (const char* h : {"H2", "H4"}) {
        const std::vector<double>& measured = experiment.at(std::string(h) + "_m");
        double sum = 0;
        for (size_t i = 0; i < t.size(); ++i)
            sum += std::abs(ours[h][i] - valueAt(te, measured, t[i])) / depth / double(t.size());
        run.metrics.push_back(
            {std::string("water height ") + h + ", mean error / H", "%", 100 * sum, target(8)});
        run.chart.curves.push_back({h, t, ours[h], Curve::Line});
        run.chart.curves.push_back({std::string(h) + " measured", te, measured, Curve::Dashed});
    }
    for (const char* p : {"P1", "P3"})
        addBlow(run, p, {t, ours[p]}, {te, experiment.at(std::string(p) + "_Pa")}, judged);
    for (const char* p : {"P5", "P7"})
        run.metrics.push_back({std::string("mean of ") + p + ", 1.2 < t < 2.5 s",
                               "Pa off",
                               meanOf(t, ours[p], 1.2, 2.5) -
                                   meanOf(te, experiment.at(std::string(p) + "_Pa"), 1.2, 2.5),
                               {}});
}

}  // namespace spindrift
