#include "measure/accelerated_bodies.h"

#include "core/table.h"
#include "measure/exact.h"
#include "measure/stepping.h"
#include "scene/mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {

using std::numbers::pi;

namespace {

// N along x, against the body, in two dimensions of a metre of depth.
struct KnownForce {
    double rho, nu, A, onset, radius, addedMass, faster;
    double inertia(double t) const { return rho * addedMass * A * std::min(t / onset, 1.0); }
    // Of a cylinder, by two terms in the thickness of the layer: friction and the pressure of what
    // it displaces, 4 a sqrt(pi mu rho) times Basset's integral + 2 pi mu U.
    double drag(double t) const {
        const double late = std::max(t - onset, 0.0), early = std::min(t, onset),
                     speed = A * (early * early / (2 * onset) + late);
        return rho * faster * faster *
               (4 * radius * std::sqrt(pi * nu) * bassetIntegral(A, onset, t) +
                2 * pi * nu * speed);
    }
};

}  // namespace

void runAcceleratedBody(const Scene& scene, ValidationRun& run, double coefficient, double target,
                        int from) {
    constexpr int Looks = 200;
    const Solid& body = scene.solids[0];
    Solid wet = body;
    wet.density = 1;
    const double volume = massOf(scene, wet).mass, end = body.keyframes.back().time;
    const BodyInBox box =
        bodyInBox(coefficient * volume, volume, toDouble(scene.domain.max - scene.domain.min),
                  scene.simulation.dimensions);
    const Keyframe& onset = body.keyframes[1];
    const KnownForce known{scene.fluid.restDensity,
                           scene.fluid.viscosity / scene.fluid.restDensity,
                           2 * onset.velocity.x / onset.time,
                           onset.time,
                           body.radius,
                           box.addedMass,
                           box.faster};
    const double unit = known.rho * known.addedMass * known.A;
    Stepping sim(scene, run);
    Curve ours{"force", {}, {}, Curve::Points}, theirs{"theory", {}, {}, Curve::Line};
    double sum = 0, exact = 0, drag = 0, square = 0, count = 0;
    for (int k = 1; k <= Looks && !run.diverged; ++k) {
        sim.until(k * end / Looks);
        const Measurement m = sim->measure();
        const double felt = -(m.solids[0].pressureForce.x + m.solids[0].viscousForce.x),
                     viscous = known.nu > 0 ? known.drag(m.time) : 0,
                     force = known.inertia(m.time) + viscous;
        ours.x.push_back(m.time), ours.y.push_back(felt / unit);
        theirs.x.push_back(m.time), theirs.y.push_back(force / unit);
        if (k <= Looks / 2) continue;  // what the onset sent out has passed several times
        sum += felt, exact += force, drag += viscous, count += 1;
        square += std::pow(felt - force, 2);
    }
    run.chart = {"", "t, s", "force / m_a A", {theirs, ours}};
    const double wrong = sum - exact;
    if (drag > 0)
        run.metrics = {
            {"drag of the layer", "%", 100 * wrong / drag, targetAt(run.resolution, from, target)},
            {"share of it in the force", "%", 100 * drag / exact, {}}};
    else
        run.metrics = {
            {"added mass", "%", 100 * wrong / exact, targetAt(run.resolution, from, target)}};
    run.metrics.push_back({"rms of the force", "%", 100 * std::sqrt(square * count) / exact, {}});
}

namespace {

// Where a curve turns, by the parabola through three points: times of its lows.
std::vector<double> lowsOf(const std::vector<double>& t, const std::vector<double>& x) {
    std::vector<double> lows;
    for (size_t i = 1; i + 1 < t.size(); ++i) {
        const double bend = x[i - 1] - 2 * x[i] + x[i + 1];
        if (x[i] < x[i - 1] && x[i] <= x[i + 1])
            lows.push_back(t[i] + (x[i - 1] - x[i + 1]) / (2 * bend) * (t[i + 1] - t[i]));
    }
    return lows;
}

}  // namespace

void runHeave(const Scene& scene, ValidationRun& run, const std::string& data) {
    const Table table = readTable(data + "/heaving_cylinder.csv");
    const std::vector<double>&at = table.at("t"), &height = table.at("x");
    const Solid& body = scene.solids[0];
    const double a = body.radius, unit = std::sqrt(a / -double(scene.simulation.gravity.y)),
                 width = scene.domain.max.x, level = scene.fluid.bodies[0].max.y,
                 lifted = body.center.y - level;
    // The level rises once the body is half immersed.
    const double half = std::sqrt(a * a - lifted * lifted),
                 immersed = a * a * std::acos(lifted / a) - lifted * half,
                 rest = level + (pi * a * a / 2 - immersed) / width;
    Stepping sim(scene, run);
    Curve ours{"computed", {}, {}, Curve::Points};
    double square = 0;
    for (size_t k = 0; k < at.size() && !run.diverged; ++k) {
        sim.until(at[k] * unit);
        const Measurement m = sim->measure();
        ours.x.push_back(m.time / unit);
        ours.y.push_back((m.solids[0].position.y - rest) / (body.center.y - rest));
        square += std::pow(ours.y.back() - height[k], 2);
    }
    // Single impacts of particles are no swing.
    auto lows = [](const std::vector<double>& t, const std::vector<double>& x) {
        std::vector<double> found = lowsOf(t, runningMean(t, x, 0.5));
        found.resize(2, std::nan(""));
        return found;
    };
    const std::vector<double> low = lows(ours.x, ours.y), known = lows(at, height);
    run.chart = {"",
                 "t sqrt(g / a)",
                 "height above rest / at the start",
                 {{"linear theory", at, height, Curve::Line}, ours}};
    run.metrics = {
        {"period, from low to low", "%", 100 * ((low[1] - low[0]) / (known[1] - known[0]) - 1),
         targetAt(run.resolution, 5, 3.0)},
        {"first low", "%", 100 * (low[0] / known[0] - 1), targetAt(run.resolution, 5, 3.0)},
        {"rms of the height", "%", 100 * std::sqrt(square / double(at.size())), {}}};
}

}  // namespace spindrift
