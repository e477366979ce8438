#include "measure/validation.h"

#include "measure/exact.h"
#include "measure/health.h"
#include "measure/interpolate.h"
#include "measure/operators.h"
#include "measure/probes.h"
#include "core/table.h"
#include "scene/convex.h"
#include "scene/particles.h"
#include "scene/schema.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

using std::numbers::pi;
const double NaN = std::nan("");

// Steps a simulation and keeps the time it takes, measurements left out.
class Stepping {
public:
    Stepping(const Scene& scene, ValidationRun& run) : scene_(scene), simulation_(makeSimulation(scene)), run_(run) {
        run.cost.particles = simulation_->fluidCount(), run.cost.walls = simulation_->wallCount();
    }
    Simulation& operator*() { return *simulation_; }
    Simulation* operator->() { return simulation_.get(); }
    double time() { return simulation_->measure().time; }
    void steps(int count) {
        const auto start = std::chrono::steady_clock::now();
        simulation_->step(count);
        simulation_->wait();
        run_.cost.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const Measurement m = simulation_->measure();
        run_.diverged = run_.diverged || !divergence(scene_, m).empty();
        run_.cost.steps = m.steps;
        run_.cost.megabytes = double(simulation_->bytes()) / 1e6;
    }
    // Until `time` (s) is reached, at most a step beyond; stops early when the run has diverged.
    void until(double time) {
        Measurement m = simulation_->measure();
        while (m.time < time && !run_.diverged) {
            const int most = m.dt > 0 ? std::clamp(int((time - m.time) / m.dt / 1.5), 1, 200) : 1;
            steps(most);
            m = simulation_->measure();
        }
    }

private:
    const Scene& scene_;
    std::unique_ptr<Simulation> simulation_;
    ValidationRun& run_;
};

// Sums that become norms of a velocity field, relative to the exact one.
struct VelocityNorms {
    double l1 = 0, l2 = 0, exact1 = 0, exact2 = 0, most = 0, mostExact = 0;
    void add(Vec3d u, Vec3d exact) {
        l1 += std::abs(length(u) - length(exact)), exact1 += length(exact);
        l2 += dot(u - exact, u - exact), exact2 += dot(exact, exact);
        most = std::max(most, length(u)), mostExact = std::max(mostExact, length(exact));
    }
    double L1() const { return l1 / exact1; }
    double L2() const { return std::sqrt(l2 / exact2); }
    double Linf() const { return most / mostExact - 1; }
};

std::optional<double> targetAt(int resolution, int from, double target) {
    return resolution >= from ? std::optional(target) : std::nullopt;
}

// Of all pairs, by halves of a sorted list: enough for a number in a report.
double smallestDistance(std::vector<Particle> particles) {
    std::sort(particles.begin(), particles.end(), [](auto& a, auto& b) { return a.position.x < b.position.x; });
    double least = 1e300;
    for (size_t i = 0; i < particles.size(); ++i)
        for (size_t j = i + 1; j < particles.size() && particles[j].position.x - particles[i].position.x < least; ++j)
            least = std::min(least, length(particles[j].position - particles[i].position));
    return least;
}

double volumeOf(const std::vector<Particle>& particles, const Scene& scene) {
    double volume = 0;
    for (const Particle& p : particles) volume += particleMass(scene) / (p.density * scene.simulation.spacing);
    return volume;   // per metre of depth, m^2
}

// --- C6 Taylor-Green ---

void runTaylorGreen(const Scene& scene, ValidationRun& run, double until, const std::vector<std::pair<int, double>>& targets) {
    const double U = 1, rho0 = scene.fluid.restDensity;
    const TaylorGreenFlow exact{1, U, scene.fluid.viscosity / rho0, rho0};
    Stepping sim(scene, run);
    Curve ours{"kinetic energy", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    const double start = sim->measure().kineticEnergy;
    for (int k = 0; k <= 40; ++k) {
        sim.until(until * k / 40);
        const Measurement m = sim->measure();
        ours.x.push_back(m.time), ours.y.push_back(m.kineticEnergy / start);
        known.x.push_back(m.time), known.y.push_back(std::pow(exact.decay(m.time), 2));
    }
    run.chart = {"", "t U / L", "E / E0", {known, ours}, false, true};
    const Measurement m = sim->measure();
    const std::vector<Particle> particles = sim->particles();
    VelocityNorms norms;
    double mean = 0, pressure = 0, mostPressure = 0;
    for (const Particle& p : particles) mean += p.pressure / double(particles.size());
    for (const Particle& p : particles) {
        norms.add(p.velocity, exact.velocity(p.position, m.time));
        pressure += std::abs(p.pressure - mean - exact.pressure(p.position, m.time)) / double(particles.size());
        mostPressure = std::max(mostPressure, std::abs(exact.pressure(p.position, m.time)));
    }
    std::optional<double> target;
    for (const auto& [from, limit] : targets)
        if (run.resolution >= from) target = limit;
    const double depth = scene.simulation.spacing, energy = rho0 / 4 * std::pow(exact.decay(m.time), 2) * depth;
    const bool judged = target.has_value();
    run.metrics = {{"L1 of u", "%", 100 * norms.L1(), judged ? std::optional(100 * *target) : std::nullopt},
                   {"L2 of u", "%", 100 * norms.L2(), {}},
                   {"Linf of u", "%", 100 * norms.Linf(), {}},
                   {"energy", "%", 100 * (m.kineticEnergy / energy - 1), judged && until < 3 ? std::optional(1.0) : std::nullopt},
                   {"L1 of p", "%", 100 * pressure / mostPressure, {}},
                   {"volume", "%", 100 * (volumeOf(particles, scene) - 1), judged ? std::optional(0.01) : std::nullopt},
                   {"momentum / M U", "", length(m.momentum) / (rho0 * depth * U), {}},
                   {"smallest distance / dx", "", smallestDistance(particles) / scene.simulation.spacing, {}}};
}

// --- C3, C4 flow between plates ---

void runPlates(const Scene& scene, ValidationRun& run, double V0, const std::function<double(double, double)>& exact) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity;
    Stepping sim(scene, run);
    double worst = 0, across = 0, atEnd = 0;
    const double times[] = {0.0225, 0.045, 0.1125, 0.225, 1.0};   // nu t / L^2
    for (double each : times) {
        sim.until(each / nu);
        const double t = sim.time();
        double sum = 0;
        Curve ours{fmt::format("nu t / L^2 = {}", each), {}, {}, Curve::Points}, known{"", {}, {}, Curve::Line};
        std::vector<Particle> particles = sim->particles();
        for (const Particle& p : particles) {
            const double u = exact(p.position.y, t);
            sum += (std::pow(p.velocity.x - u, 2) + std::pow(p.velocity.y, 2)) / double(particles.size());
            across = std::max(across, std::abs(p.velocity.y));
        }
        atEnd = std::sqrt(sum) / V0;
        worst = std::max(worst, atEnd);
        std::sort(particles.begin(), particles.end(), [](auto& a, auto& b) { return a.position.y < b.position.y; });
        for (size_t i = 0; i < particles.size(); i += std::max<size_t>(1, particles.size() / 60))
            ours.x.push_back(particles[i].position.y), ours.y.push_back(particles[i].velocity.x / V0);
        for (int k = 0; k <= 50; ++k) known.x.push_back(k / 50.0), known.y.push_back(exact(k / 50.0, t) / V0);
        run.chart.curves.push_back(known), run.chart.curves.push_back(ours);
    }
    run.chart.xLabel = "y / L", run.chart.yLabel = "u / V0";
    const Vec3d middle{0.25, 0.5, 0.5 * double(scene.domain.max.z)};
    const double u = interpolate(sim->particles(), {middle}, supportRadius(scene))[0].velocity.x;
    run.metrics = {{"L2 of u / V0, worst of five times", "%", 100 * worst, targetAt(run.resolution, 40, 1.0)},
                   {"L2 of u / V0, at the end", "%", 100 * atEnd, {}},
                   {"steady middle", "%", 100 * (u / exact(0.5, sim.time()) - 1), targetAt(run.resolution, 40, 0.5)},
                   {"largest v / V0", "%", 100 * across / V0, {}}};
}

void runPoiseuille(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity, F = scene.simulation.gravity.x;
    runPlates(scene, run, F / (8 * nu), [=](double y, double t) { return poiseuilleFlow(y, t, 1, nu, F); });
}
void runCouette(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity, V = scene.walls.velocity.x;
    runPlates(scene, run, V, [=](double y, double t) { return couetteFlow(y, t, 1, nu, V); });
}

// --- C5 cavity ---

void runCavity(const Scene& scene, ValidationRun& run, const std::string& data, const std::string& column, double end,
               double target, int from) {
    const Table u = readTable(data + "/cavity_u_centreline_computed.csv"), v = readTable(data + "/cavity_v_centreline_computed.csv");
    const std::vector<double>& at = u.at("y");
    const double z = 0.5 * scene.domain.max.z;
    std::vector<Vec3d> points;
    for (double s : at) points.push_back({0.5, s, z});
    for (double s : at) points.push_back({s, 0.5, z});
    Stepping sim(scene, run);
    std::vector<Vec3d> mean(points.size());
    constexpr int Samples = 20;
    for (int k = 0; k < Samples; ++k) {
        sim.until(end * (0.9 + 0.1 * (k + 1) / Samples));
        const auto fields = interpolate(sim->particles(), points, supportRadius(scene));
        for (size_t i = 0; i < points.size(); ++i) mean[i] = mean[i] + (1.0 / Samples) * fields[i].velocity;
    }
    double sumU = 0, sumV = 0, most = 0;
    int count = 0;
    Curve ourU{"u(y)", at, {}, Curve::Points}, ourV{"v(x)", at, {}, Curve::Points};
    for (size_t i = 0; i < at.size(); ++i) {
        const double du = mean[i].x - u.at(column)[i], dv = mean[at.size() + i].y - v.at(column)[i];
        ourU.y.push_back(mean[i].x), ourV.y.push_back(mean[at.size() + i].y);
        if (at[i] < 0.02 || at[i] > 0.98) continue;
        sumU += du * du, sumV += dv * dv, ++count;
        most = std::max({most, std::abs(du), std::abs(dv)});
    }
    run.chart = {"", "y or x", "u or v", {{"u, reference", at, u.at(column), Curve::Line}, ourU,
                                          {"v, reference", at, v.at(column), Curve::Line}, ourV}};
    run.metrics = {{"rms of u", "%", 100 * std::sqrt(sumU / count), targetAt(run.resolution, from, target)},
                   {"rms of v", "%", 100 * std::sqrt(sumV / count), targetAt(run.resolution, from, target)},
                   {"largest", "%", 100 * most, {}}};
}

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
    std::vector<double> crossings;   // s, when the drop is round again and widens
    double before = 0, timeBefore = 0;
    for (int k = 0; k <= Periods * PerPeriod + PerPeriod / 4; ++k) {
        sim.until(k * T / PerPeriod);
        const std::vector<Particle> particles = sim->particles();
        const Measurement m = sim->measure();
        exact.advance(m.time - last), last = m.time;
        double xx = 0, yy = 0;
        for (const Particle& p : particles) xx += p.position.x * p.position.x, yy += p.position.y * p.position.y;
        const double n = double(particles.size()), a = 2 * std::sqrt(xx / n), excess = a - 2 * std::sqrt(yy / n);
        if (k > PerPeriod / 2 && before < 0 && excess >= 0)   // at the start the drop is round but for its last digits
            crossings.push_back(timeBefore + (m.time - timeBefore) * before / (before - excess));
        before = excess, timeBefore = m.time;
        if (k <= 3 * PerPeriod) axisSum += std::pow(a - exact.a, 2), ++axisCount;
        ours.x.push_back(m.time), ours.y.push_back(a);
        known.x.push_back(m.time), known.y.push_back(exact.a);
        momentum = std::max(momentum, length(m.momentum));
    }
    const Measurement end = sim->measure();
    const double M = particleMass(scene) * run.cost.particles;
    const double energy = end.kineticEnergy + end.potentialEnergy, start = first.kineticEnergy + first.potentialEnergy;
    // Energy of a drop at rest would be left in potential energy: loss is measured against all, as Sun 2017 does.
    const double period = crossings.size() >= Periods ? crossings[Periods - 1] / Periods : NaN;
    run.chart = {"", "t Omega", "a / R", {known, ours}};
    run.metrics = {{"semi-axis, rms of 3 periods / R", "%", 100 * std::sqrt(axisSum / axisCount), {}},
                   {"period", "%", 100 * (period / T - 1), targetAt(run.resolution, 50, 0.5)},
                   {"energy after 10 periods", "%", 100 * (energy / start - 1), targetAt(run.resolution, 50, 3.0)},
                   {"largest momentum / (M s0 R)", "", momentum / M, targetAt(run.resolution, 50, 3e-4)}};
}

// --- C2 hydrostatic tank ---

// What fluid does to a solid under water is the weight of the water in its place.
void addBuoyancy(const Scene& scene, const Measurement& m, double volume, ValidationRun& run) {
    if (volume == 0) return;
    const double weight = scene.fluid.restDensity * -scene.simulation.gravity.y * volume;
    run.metrics.push_back({"lift of the solid", "%", 100 * (m.solids[0].pressureForce.y / weight - 1), 2.0});
}

void runHydrostatic(const Scene& scene, ValidationRun& run, int judgedFrom, double volume = 0) {
    const double g = -scene.simulation.gravity.y, H = scene.fluid.bodies[0].max.y, rho0 = scene.fluid.restDensity;
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
    for (int k = 1; k <= 5; ++k) {   // not where a solid stands
        const Vec3d point{width * k / 6, 0, 0.5 * scene.domain.max.z};
        if (std::none_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& s) {
                const Convex shape = convexOf(s, scene.simulation.dimensions);
                return shape.nearest(point - shape.middle).distance < scene.simulation.spacing;
            }))
            floor.push_back(point);
    }
    double bottom = 0;
    for (const Fields& f : interpolate(particles, floor, supportRadius(scene))) bottom += f.pressure / double(floor.size());
    run.chart = {"", "t sqrt(g / H)", "E_k / (M g H)", {energy}, false, true};
    run.metrics = {{"pressure, rms / (rho g H)", "%", 100 * std::sqrt(sum / double(particles.size())) / (rho0 * g * H),
                    targetAt(run.resolution, judgedFrom, 1.0)},
                   {"pressure at the floor", "%", 100 * (bottom / (rho0 * g * H) - 1), targetAt(run.resolution, judgedFrom, 1.0)},
                   {"kinetic energy / (M g H)", "", energy.y.back(), targetAt(run.resolution, judgedFrom, 1e-5)},
                   {"its growth from t = 10 to 20", "", std::max(0.0, late / early - 1), targetAt(run.resolution, judgedFrom, 0.1)},
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
        ours.x.push_back(sim.time() * scale), ours.y.push_back(frontOf(sim->particles(), Axis::X) / a);
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
    run.chart = {"", "t sqrt(2 g / a)", "front / a", {ours, {"Martin and Moyce 1952", T, Z, Curve::Points}}};
    run.metrics = {{"front, mean difference", "%", 100 * sum, targetAt(run.resolution, 20, 8.0)},
                   {"front, largest difference", "%", 100 * most, {}}};
}

// --- C13 dam break: pressures on the far wall ---

// Mean over `window` about each time, by trapezoids between samples.
std::vector<double> runningMean(const std::vector<double>& t, const std::vector<double>& p, double window) {
    std::vector<double> out;
    for (double at : t) {
        double sum = 0;
        int count = 0;
        for (size_t k = size_t(std::lower_bound(t.begin(), t.end(), at - window / 2) - t.begin());
             k < t.size() && t[k] <= at + window / 2; ++k)
            sum += p[k], ++count;
        out.push_back(sum / count);
    }
    return out;
}

double integral(const std::vector<double>& t, const std::vector<double>& p, double from, double to) {
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
    return hit == p.end() ? NaN : t[size_t(hit - p.begin())];
}

void runImpact(const Scene& scene, ValidationRun& run, const std::string& data) {
    const Table experiment = readTable(data + "/lobovsky2014_H300_pressure.csv"), peaks = readTable(data + "/lobovsky2014_H300_peak_pressures.csv");
    const double H = 0.3, g = -scene.simulation.gravity.y, rho0 = scene.fluid.restDensity, Latest = 4;
    constexpr const char* Columns[] = {"S1_3mm", "S2_15mm", "S3_30mm"};
    const Probes sensors(scene);
    const size_t sensor[] = {sensors.column("S1.pressure"), sensors.column("S2.pressure"), sensors.column("S3.pressure")};
    Stepping sim(scene, run);
    std::vector<double> t, p[3];
    for (int k = 0; k <= 800; ++k) {
        sim.until(k * Latest / 800 * std::sqrt(H / g));
        t.push_back(sim.time() * std::sqrt(g / H));
        const std::vector<double> readings = sensors.read(sim->particles());
        for (size_t s = 0; s < 3; ++s) p[s].push_back(readings[sensor[s]] / (rho0 * g * H));
    }
    const std::vector<double>& te = experiment.at("t_star");
    const double impulse = integral(t, p[0], 2.4, Latest), measured = integral(te, experiment.at(Columns[0]), 2.4, Latest);
    const double arrival = arrivalOf(t, p[0], 0.5);
    run.metrics = {{"impulse at S1, 2.4 < t* < 4", "%", 100 * (impulse / measured - 1), targetAt(run.resolution, 80, 10.0)},
                   {"arrival at S1, t* - 2.44", "", arrival - 2.44, targetAt(run.resolution, 80, 0.1)}};
    run.chart = {"", "t sqrt(g / H)", "p / (rho g H)", {}};
    for (size_t s = 0; s < 3; ++s) {
        const std::vector<double> smooth = runningMean(t, p[s], 0.05);
        const double peak = *std::max_element(smooth.begin(), smooth.end());
        const double low = peaks.at("p2.5_P")[s], high = peaks.at("p97.5_P")[s];
        const double outside = std::max({0.0, low - peak, peak - high}) / peaks.at("median_P")[s];
        run.metrics.push_back({fmt::format("smoothed peak at S{}", s + 1), "", peak, {}});
        run.metrics.push_back({fmt::format("beyond its 95 % band {:.2f} to {:.2f}", low, high), "%", 100 * outside,
                               targetAt(run.resolution, 80, 0.0)});
        Curve theirs{fmt::format("S{} measured", s + 1), te, experiment.at(Columns[s]), Curve::Dashed};
        const size_t end = size_t(std::lower_bound(te.begin(), te.end(), Latest) - te.begin());
        theirs.x.resize(end), theirs.y.resize(end);
        run.chart.curves.push_back({fmt::format("S{}", s + 1), t, smooth, Curve::Line});
        run.chart.curves.push_back(theirs);
    }
}

// --- C14 dam break with a box ---

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
        for (const char* p : {"P1", "P3", "P5", "P7"}) ours[p].push_back(readings[probes.column(std::string(p) + ".pressure")]);
        for (const char* h : {"H2", "H4"}) ours[h].push_back(readings[probes.column(std::string(h) + ".height")]);
    }
    const std::vector<double>& te = experiment.at("t_s");
    const bool judged = run.resolution >= 30;
    auto target = [&](double value) { return judged ? std::optional(value) : std::nullopt; };
    run.chart = {"", "t, s", "water height, m; pressure, 20 kPa", {}};
    for (const char* h : {"H2", "H4"}) {
        const std::vector<double>& measured = experiment.at(std::string(h) + "_m");
        double sum = 0;
        for (size_t i = 0; i < t.size(); ++i) sum += std::abs(ours[h][i] - valueAt(te, measured, t[i])) / depth / double(t.size());
        run.metrics.push_back({std::string("water height ") + h + ", mean error / H", "%", 100 * sum, target(8)});
        run.chart.curves.push_back({h, t, ours[h], Curve::Line});
        run.chart.curves.push_back({std::string(h) + " measured", te, measured, Curve::Dashed});
    }
    for (const char* p : {"P1", "P3"}) {
        const bool first = p == std::string("P1");
        const std::vector<double>& measured = experiment.at(std::string(p) + "_Pa");
        const double late = arrivalOf(t, ours[p], 500) - arrivalOf(te, measured, 500);
        const std::vector<double> smooth = runningMean(t, ours[p], 0.005), theirs = runningMean(te, measured, 0.005);
        auto peak = [](const std::vector<double>& at, const std::vector<double>& values) {
            double most = 0;
            for (size_t i = 0; i < at.size(); ++i)
                if (at[i] > 0.39 && at[i] < 0.6) most = std::max(most, values[i]);
            return most;
        };
        run.metrics.push_back({std::string("arrival at ") + p, "ms", 1000 * late, first ? target(30) : std::nullopt});
        run.metrics.push_back({std::string("impulse at ") + p + ", 0.39 < t < 1.2 s", "%",
                               100 * (integral(t, ours[p], 0.39, 1.2) / integral(te, measured, 0.39, 1.2) - 1), first ? target(15) : std::nullopt});
        run.metrics.push_back({std::string("smoothed peak at ") + p, "%", 100 * (peak(t, smooth) / peak(te, theirs) - 1), {}});
        std::vector<double> scaled = smooth, scaledTheirs = theirs;
        for (auto* values : {&scaled, &scaledTheirs})
            for (double& v : *values) v /= 20000;
        if (first) run.chart.curves.push_back({p, t, scaled, Curve::Line}), run.chart.curves.push_back({"P1 measured", te, scaledTheirs, Curve::Dashed});
    }
    for (const char* p : {"P5", "P7"})
        run.metrics.push_back({std::string("mean of ") + p + ", 1.2 < t < 2.5 s", "Pa off",
                               meanOf(t, ours[p], 1.2, 2.5) - meanOf(te, experiment.at(std::string(p) + "_Pa"), 1.2, 2.5), {}});
}

// --- C18 conservation ---

void runConservation(const Scene& scene, ValidationRun& run) {
    constexpr int Steps = 10000, Looks = 50;
    const double c = scene.fluid.soundSpeed, mass = particleMass(scene);
    Stepping sim(scene, run);
    // Of a linear equation of state: e = c^2 (ln(rho / rho0) + rho0 / rho - 1).
    auto energy = [&] {
        double sum = 0;
        for (const Particle& p : sim->particles()) {
            const double ratio = p.density / scene.fluid.restDensity;
            sum += mass * (dot(p.velocity, p.velocity) / 2 + c * c * (std::log(ratio) + 1 / ratio - 1));
        }
        return sum;
    };
    const double start = energy(), M = mass * run.cost.particles;
    const Vec3d momentum = sim->measure().momentum;
    Curve curve{"kinetic + internal", {}, {}, Curve::Line};
    double growth = 0, drift = 0, last = start;
    for (int k = 0; k < Looks; ++k) {
        sim.steps(Steps / Looks);
        const double now = energy();
        growth = std::max(growth, now - last), last = now;
        drift = std::max(drift, length(sim->measure().momentum - momentum) / M);
        curve.x.push_back(double(run.cost.steps)), curve.y.push_back(now / start);
    }
    run.chart = {"", "steps", "energy / at the start", {curve}};
    run.metrics = {{"momentum / M U", "", drift, 1e-6},
                   {"largest growth of energy in 200 steps", "%", 100 * growth / start, 0.01},
                   {"energy left", "%", 100 * last / start, {}}};
}

// --- C19 sound wave ---

// The part of a wave A sin(kx - wt) that travels along x: its phase wt, and A.
struct Travelling { double phase, amplitude; };
Travelling travelling(const std::vector<Particle>& particles, double k, double rho0, double c) {
    double sine = 0, cosine = 0;
    for (const Particle& p : particles) {
        const double value = ((p.density / rho0 - 1) + p.velocity.x / c) / double(particles.size());
        sine += value * std::sin(k * p.position.x), cosine += value * std::cos(k * p.position.x);
    }
    return {std::atan2(-cosine, sine), std::hypot(sine, cosine)};
}

// What steps of dt make of an oscillation that is damped by the diffusion of density: the roots of the leapfrog's equation
// z^2 - (2 - theta^2 - 2 g) z + 1 - 2 g = 0, where the diffusion is as old as the step; midpoints have both in the middle.
struct Oscillation { double omega, decay; };   // 1/s
Oscillation stepOscillation(double undamped, double damping, double dt, Integrator integrator) {
    const double theta = undamped * dt, g = damping * dt;
    if (integrator == Integrator::PredictorCorrector)
        return {2 / dt * std::asin(std::sqrt(theta * theta - g * g) / 2), damping};
    return {std::acos((1 - theta * theta / 2 - g) / std::sqrt(1 - 2 * g)) / dt, -std::log(1 - 2 * g) / (2 * dt)};
}

void runSoundWave(const Scene& scene, ValidationRun& run) {
    constexpr int Periods = 5, PerPeriod = 20;
    const double c = scene.fluid.soundSpeed, rho0 = scene.fluid.restDensity, dx = scene.simulation.spacing, k = 2 * pi;
    const double D = scene.fluid.densityDiffusion * supportRadius(scene) / 2 * c;   // m^2/s, of density
    const LatticeWave seen = latticeWave(scene.simulation.kernel, scene.simulation.dimensions, scene.simulation.support, k * dx);
    const double damping = D * seen.k2 / (dx * dx) / 2, undamped = c * seen.k / dx;   // 1/s
    Stepping sim(scene, run);
    const Travelling first = travelling(sim->particles(), k, rho0, c);
    Curve ours{"amplitude", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    double turns = 0, phase = first.phase, sumT = 0, sumP = 0, sumTT = 0, sumTP = 0;
    Travelling now = first;
    for (int i = 1; i <= Periods * PerPeriod; ++i) {
        sim.until(i / (PerPeriod * c));
        now = travelling(sim->particles(), k, rho0, c);
        turns += std::remainder(now.phase - phase, 2 * pi), phase = now.phase;
        const double t = sim.time();
        sumT += t, sumP += turns, sumTT += t * t, sumTP += t * turns;
        ours.x.push_back(t * c), ours.y.push_back(now.amplitude / first.amplitude);
    }
    // A line through the phases: the start, not yet staggered in time, also sends a little the other way.
    const double n = Periods * PerPeriod, omega = (sumTP - sumT * sumP / n) / (sumTT - sumT * sumT / n);
    const Oscillation stepped = stepOscillation(undamped, damping, sim->measure().dt, scene.time.integrator);
    for (double t : ours.x) known.x.push_back(t), known.y.push_back(std::exp(-stepped.decay * t / c));
    run.chart = {"", "t c / L", "amplitude / at the start", {known, ours}};
    run.metrics = {{"phase after 5 periods, of c", "% of a period", 100 * Periods * (omega / (c * k) - 1), targetAt(run.resolution, 64, 2.0)},
                   {"phase, of the lattice's relation", "% of a period", 100 * Periods * (omega - stepped.omega) / (c * k), targetAt(run.resolution, 32, 0.1)},
                   {"amplitude, of its decay by diffusion", "%", 100 * (ours.y.back() / known.y.back() - 1), targetAt(run.resolution, 64, 1.0)},
                   {"amplitude left", "%", 100 * ours.y.back(), {}}};
}

void spacing(Scene& s, int n) { s.simulation.spacing = 1.0f / float(n); }

}  // namespace

std::vector<ValidationCase> validationCases(const std::string& data) {
    auto taylorGreen = [](double until, std::vector<std::pair<int, double>> targets) {
        return [=](const Scene& s, ValidationRun& r) { runTaylorGreen(s, r, until, targets); };
    };
    auto cavity = [data](const char* column, double end, double target, int from) {
        return [=](const Scene& s, ValidationRun& r) { runCavity(s, r, data, column, end, target, from); };
    };
    auto viscous = [](float viscosity) {
        return [=](Scene& s, int n) { spacing(s, n), s.fluid.viscosity = viscosity; };
    };
    const std::string morris = "Morris, Fox and Zhu 1997, series", stream = "finite differences, 256^2, Richardson";
    return {
        {"hydrostatic", "Hydrostatic tank", "hydrostatic", "p = rho g (H - y)", "H / dx", {30, 60, 120}, {30},
         [](Scene& s, int n) { s.simulation.spacing = 0.9f / float(n), s.fluid.bodies[0].max.x = s.domain.max.x = 0.9f / float(n) * std::round(2 * n / 0.9f); },
         [](const Scene& s, ValidationRun& r) { runHydrostatic(s, r, 60); }},
        {"hydrostatic_wedge", "Hydrostatic tank with a wedge on its floor", "hydrostatic_wedge", "p = rho g (H - y)", "H / dx", {30, 60, 120}, {30},
         [](Scene& s, int n) { s.simulation.spacing = 0.9f / float(n), s.fluid.bodies[0].max.x = s.domain.max.x = 0.9f / float(n) * std::round(2 * n / 0.9f); },
         [](const Scene& s, ValidationRun& r) { runHydrostatic(s, r, 60); }},
        {"hydrostatic_sphere", "Hydrostatic tank with a sphere, three dimensions", "hydrostatic_sphere", "p = rho g (H - y)", "H / dx", {15, 30}, {},
         [](Scene& s, int n) { s.simulation.spacing = 0.6f / float(n); },
         [](const Scene& s, ValidationRun& r) { runHydrostatic(s, r, 30, 4 * pi / 3 * std::pow(s.solids[0].radius, 3)); }},
        {"poiseuille", "Start-up of Poiseuille flow, Re 0.0125", "poiseuille", morris, "L / dx", {20, 40, 80}, {20, 40}, spacing,
         runPoiseuille},
        {"poiseuille_re100", "Start-up of Poiseuille flow, Re 100", "poiseuille_re100", morris, "L / dx", {20, 40}, {}, spacing,
         runPoiseuille},
        {"couette", "Start-up of Couette flow, Re 0.0125", "couette", morris, "L / dx", {20, 40, 80}, {20, 40}, spacing, runCouette},
        {"cavity_re100", "Lid-driven cavity, Re 100", "cavity", stream, "L / dx", {25, 50, 100}, {25}, viscous(0.01f),
         cavity("Re100", 20, 0.5, 50)},
        {"cavity_re1000", "Lid-driven cavity, Re 1000", "cavity", stream, "L / dx", {50, 100}, {}, viscous(0.001f),
         cavity("Re1000", 60, 1.5, 100)},
        {"taylor_green", "Taylor-Green vortices, Re 100, jittered start", "taylor_green", "Taylor and Green 1937", "L / dx",
         {50, 100, 200}, {50, 100}, spacing, taylorGreen(2, {{100, 0.01}, {200, 0.004}})},
        {"taylor_green_lattice", "Taylor-Green vortices, Re 100, lattice start", "taylor_green", "Taylor and Green 1937", "L / dx",
         {50, 100}, {}, [](Scene& s, int n) { spacing(s, n), s.simulation.jitter = 0; }, taylorGreen(2, {{100, 0.01}})},
        {"taylor_green_re1000", "Taylor-Green vortices, Re 1000, jittered start", "taylor_green", "Taylor and Green 1937", "L / dx",
         {50, 100}, {}, viscous(0.001f), taylorGreen(5, {{100, 0.015}})},
        {"drop", "Oscillating drop, s0 = 1", "drop", "Monaghan and Rafiee 2013, ODE", "R / dx", {25, 50}, {}, spacing, runDrop},
        {"dam_break_front", "Dam-break front, n^2 = 2", "dam_break_front", "Martin and Moyce 1952, a = 2.25 in", "a / dx", {20, 40, 80},
         {20}, spacing, [data](const Scene& s, ValidationRun& r) { runFront(s, r, data); }},
        {"dam_break_pressure", "Dam-break pressures, H = 0.3 m", "dam_break_pressure", "Lobovsky et al. 2014", "H / dx", {40, 80, 160}, {},
         [](Scene& s, int n) { s.simulation.spacing = 0.3f / float(n); }, [data](const Scene& s, ValidationRun& r) { runImpact(s, r, data); }},
        {"kleefsman", "Dam break with a box, three dimensions", "kleefsman", "Kleefsman et al. 2005", "0.55 m / dx", {15, 30}, {},
         [](Scene& s, int n) { s.simulation.spacing = 0.55f / float(n); }, [data](const Scene& s, ValidationRun& r) { runKleefsman(s, r, data); }},
        {"conservation", "Conservation in a periodic box, 10,000 steps, delta_sph", "taylor_green", "momentum and energy", "L / dx", {64}, {32},
         [](Scene& s, int n) { spacing(s, n), s.simulation.formulation = Formulation::DeltaSph, s.fluid.viscosity = 0, s.time = {.cfl = 0.6f}; },
         runConservation},
        {"sound_wave", "Sound wave, delta_sph", "sound_wave", "c k, and the lattice's dispersion relation", "L / dx", {32, 64, 128}, {32, 64},
         spacing, runSoundWave},
        {"operators", "Gradients and Laplacians of sin 2 pi x cos 2 pi y", "taylor_green", "its derivatives", "L / dx", {25, 50, 100, 200},
         {50, 100}, spacing, runOperators},
    };
}

ValidationRun validate(const ValidationCase& c, const Scene& scene, int resolution) {
    ValidationRun run;
    run.resolution = resolution;
    const SimulationKnobs& s = scene.simulation;
    run.method = fmt::format("{}, {}, R = {:g} dx", enumNames(s.formulation)[size_t(s.formulation)], enumNames(s.kernel)[size_t(s.kernel)],
                             s.support);
    c.run(scene, run);
    if (run.diverged)
        for (Metric& m : run.metrics) m.value = NaN;
    run.chart.title = fmt::format("{}, {} = {}", c.title, c.length, resolution);
    return run;
}

}  // namespace spindrift
