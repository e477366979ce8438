#include "measure/enclosed_flows.h"

#include "core/table.h"
#include "measure/exact.h"
#include "measure/interpolate.h"
#include "measure/stepping.h"
#include "scene/particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {

using std::numbers::pi;

namespace {

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

// Of all pairs, by halves of a sorted list: enough for a number in a report.
double smallestDistance(std::vector<Particle> particles) {
    std::sort(particles.begin(), particles.end(),
              [](auto& a, auto& b) { return a.position.x < b.position.x; });
    double least = 1e300;
    for (size_t i = 0; i < particles.size(); ++i)
        for (size_t j = i + 1;
             j < particles.size() && particles[j].position.x - particles[i].position.x < least; ++j)
            least = std::min(least, length(particles[j].position - particles[i].position));
    return least;
}

double volumeOf(const std::vector<Particle>& particles, const Scene& scene) {
    double volume = 0;
    for (const Particle& p : particles) volume += particleMass(scene) / p.density;
    return volume;  // m^2
}

}  // namespace

// --- C6 Taylor-Green ---

void runTaylorGreen(const Scene& scene, ValidationRun& run, double until,
                    const std::vector<std::pair<int, double>>& targets) {
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
        pressure += std::abs(p.pressure - mean - exact.pressure(p.position, m.time)) /
                    double(particles.size());
        mostPressure = std::max(mostPressure, std::abs(exact.pressure(p.position, m.time)));
    }
    std::optional<double> target;
    for (const auto& [from, limit] : targets)
        if (run.resolution >= from) target = limit;
    const double energy = rho0 / 4 * std::pow(exact.decay(m.time), 2);  // J/m
    const bool judged = target.has_value();
    run.metrics = {
        {"L1 of u", "%", 100 * norms.L1(), judged ? std::optional(100 * *target) : std::nullopt},
        {"L2 of u", "%", 100 * norms.L2(), {}},
        {"Linf of u", "%", 100 * norms.Linf(), {}},
        {"energy", "%", 100 * (m.kineticEnergy / energy - 1),
         judged && until < 3 ? std::optional(1.0) : std::nullopt},
        {"L1 of p", "%", 100 * pressure / mostPressure, {}},
        {"volume", "%", 100 * (volumeOf(particles, scene) - 1),
         judged ? std::optional(0.01) : std::nullopt},
        {"momentum / M U", "", length(m.momentum) / (rho0 * U), {}},
        {"smallest distance / dx", "", smallestDistance(particles) / scene.simulation.spacing, {}}};
}

// --- C3, C4 flow between plates ---

namespace {

void runPlates(const Scene& scene, ValidationRun& run, double V0,
               const std::function<double(double, double)>& exact) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity;
    Stepping sim(scene, run);
    double worst = 0, across = 0, atEnd = 0;
    const double times[] = {0.0225, 0.045, 0.1125, 0.225, 1.0};  // nu t / L^2
    for (double each : times) {
        sim.until(each / nu);
        const double t = sim.time();
        double sum = 0;
        Curve ours{fmt::format("nu t / L^2 = {}", each), {}, {}, Curve::Points},
            known{"", {}, {}, Curve::Line};
        std::vector<Particle> particles = sim->particles();
        for (const Particle& p : particles) {
            const double u = exact(p.position.y, t);
            sum += (std::pow(p.velocity.x - u, 2) + std::pow(p.velocity.y, 2)) /
                   double(particles.size());
            across = std::max(across, std::abs(p.velocity.y));
        }
        atEnd = std::sqrt(sum) / V0;
        worst = std::max(worst, atEnd);
        std::sort(particles.begin(), particles.end(),
                  [](auto& a, auto& b) { return a.position.y < b.position.y; });
        for (size_t i = 0; i < particles.size(); i += std::max<size_t>(1, particles.size() / 60))
            ours.x.push_back(particles[i].position.y),
                ours.y.push_back(particles[i].velocity.x / V0);
        for (int k = 0; k <= 50; ++k)
            known.x.push_back(k / 50.0), known.y.push_back(exact(k / 50.0, t) / V0);
        run.chart.curves.push_back(known), run.chart.curves.push_back(ours);
    }
    run.chart.xLabel = "y / L", run.chart.yLabel = "u / V0";
    const Vec3d middle{0.25, 0.5, 0.5 * double(scene.domain.max.z)};
    const double u = interpolate(sim->particles(), {middle}, supportRadius(scene))[0].velocity.x;
    run.metrics = {
        {"L2 of u / V0, worst of five times", "%", 100 * worst, targetAt(run.resolution, 40, 1.0)},
        {"L2 of u / V0, at the end", "%", 100 * atEnd, {}},
        {"steady middle", "%", 100 * (u / exact(0.5, sim.time()) - 1),
         targetAt(run.resolution, 40, 0.5)},
        {"largest v / V0", "%", 100 * across / V0, {}}};
}

}  // namespace

void runPoiseuille(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity,
                 F = scene.simulation.gravity.x;
    runPlates(scene, run, F / (8 * nu),
              [=](double y, double t) { return poiseuilleFlow(y, t, 1, nu, F); });
}

void runHalfChannel(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity,
                 F = scene.simulation.gravity.x;
    runPlates(scene, run, F / (2 * nu),
              [=](double y, double t) { return poiseuilleFlow(y, t, 2, nu, F); });
}

void runSlipChannel(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity,
                 F = scene.simulation.gravity.x, b = scene.walls.slip,
                 U = F / (2 * nu) * (0.25 + b);
    Stepping sim(scene, run);
    sim.until(3 / nu);
    double sum = 0;
    const std::vector<Particle> particles = sim->particles();
    Curve ours{"u", {}, {}, Curve::Points}, known{"exact", {}, {}, Curve::Line};
    auto exact = [&](double y) { return F / (2 * nu) * (y * (1 - y) + b); };
    for (const Particle& p : particles) {
        sum += std::pow(p.velocity.x - exact(p.position.y), 2) / double(particles.size());
        ours.x.push_back(p.position.y), ours.y.push_back(p.velocity.x / U);
    }
    for (int k = 0; k <= 50; ++k)
        known.x.push_back(k / 50.0), known.y.push_back(exact(k / 50.0) / U);
    run.chart = {"", "y / L", "u / U", {known, ours}};
    run.metrics = {
        {"L2 of u / U", "%", 100 * std::sqrt(sum) / U, targetAt(run.resolution, 20, 0.5)}};
}

void runCouette(const Scene& scene, ValidationRun& run) {
    const double nu = scene.fluid.viscosity / scene.fluid.restDensity, V = scene.walls.velocity.x;
    runPlates(scene, run, V, [=](double y, double t) { return couetteFlow(y, t, 1, nu, V); });
}

// --- C5 cavity ---

void runCavity(const Scene& scene, ValidationRun& run, const std::string& data,
               const std::string& column, double end, double target, int from) {
    const Table u = readTable(data + "/cavity_u_centreline_computed.csv"),
                v = readTable(data + "/cavity_v_centreline_computed.csv");
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
        for (size_t i = 0; i < points.size(); ++i)
            mean[i] = mean[i] + (1.0 / Samples) * fields[i].velocity;
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
    run.chart = {"",
                 "y or x",
                 "u or v",
                 {{"u, reference", at, u.at(column), Curve::Line},
                  ourU,
                  {"v, reference", at, v.at(column), Curve::Line},
                  ourV}};
    run.metrics = {
        {"rms of u", "%", 100 * std::sqrt(sumU / count), targetAt(run.resolution, from, target)},
        {"rms of v", "%", 100 * std::sqrt(sumV / count), targetAt(run.resolution, from, target)},
        {"largest", "%", 100 * most, {}}};
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
            sum += mass *
                   (dot(p.velocity, p.velocity) / 2 + c * c * (std::log(ratio) + 1 / ratio - 1));
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

namespace {

// The part of a wave A sin(kx - wt) that travels along x: its phase wt, and A.
struct Travelling {
    double phase, amplitude;
};
Travelling travelling(const std::vector<Particle>& particles, double k, double rho0, double c) {
    double sine = 0, cosine = 0;
    for (const Particle& p : particles) {
        const double value = ((p.density / rho0 - 1) + p.velocity.x / c) / double(particles.size());
        sine += value * std::sin(k * p.position.x), cosine += value * std::cos(k * p.position.x);
    }
    return {std::atan2(-cosine, sine), std::hypot(sine, cosine)};
}

// What steps of dt make of an oscillation that is damped by the diffusion of density: the roots of
// the leapfrog's equation z^2 - (2 - theta^2 - 2 g) z + 1 - 2 g = 0, where the diffusion is as old
// as the step; midpoints have both in the middle.
struct Oscillation {
    double omega, decay;
};  // 1/s
Oscillation stepOscillation(double undamped, double damping, double dt, Integrator integrator) {
    const double theta = undamped * dt, g = damping * dt;
    if (integrator == Integrator::PredictorCorrector)
        return {2 / dt * std::asin(std::sqrt(theta * theta - g * g) / 2), damping};
    return {std::acos((1 - theta * theta / 2 - g) / std::sqrt(1 - 2 * g)) / dt,
            -std::log(1 - 2 * g) / (2 * dt)};
}

}  // namespace

void runSoundWave(const Scene& scene, ValidationRun& run) {
    constexpr int Periods = 5, PerPeriod = 20;
    const double c = scene.fluid.soundSpeed, rho0 = scene.fluid.restDensity,
                 dx = scene.simulation.spacing, k = 2 * pi;
    const double D =
        scene.fluid.densityDiffusion * supportRadius(scene) / 2 * c;  // m^2/s, of density
    const LatticeWave seen = latticeWave(scene.simulation.kernel, scene.simulation.dimensions,
                                         scene.simulation.support, k * dx);
    const double damping = D * seen.k2 / (dx * dx) / 2, undamped = c * seen.k / dx;  // 1/s
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
    // A line through the phases: the start, not yet staggered in time, also sends a little the
    // other way.
    const double n = Periods * PerPeriod,
                 omega = (sumTP - sumT * sumP / n) / (sumTT - sumT * sumT / n);
    const Oscillation stepped =
        stepOscillation(undamped, damping, sim->measure().dt, scene.time.integrator);
    for (double t : ours.x)
        known.x.push_back(t), known.y.push_back(std::exp(-stepped.decay * t / c));
    run.chart = {"", "t c / L", "amplitude / at the start", {known, ours}};
    run.metrics = {
        {"phase after 5 periods, of c", "% of a period", 100 * Periods * (omega / (c * k) - 1),
         targetAt(run.resolution, 64, 2.0)},
        {"phase, of the lattice's relation", "% of a period",
         100 * Periods * (omega - stepped.omega) / (c * k), targetAt(run.resolution, 32, 0.1)},
        {"amplitude, of its decay by diffusion", "%", 100 * (ours.y.back() / known.y.back() - 1),
         targetAt(run.resolution, 64, 1.0)},
        {"amplitude left", "%", 100 * ours.y.back(), {}}};
}

}  // namespace spindrift
