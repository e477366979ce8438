#include "measure/operators.h"

#include "sim/run_state.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

// A field in the unit square with its derivatives.
struct Field2D {
    double (*value)(Vec3d);
    Vec3d (*gradient)(Vec3d);
};
constexpr double Turn = 2 * std::numbers::pi;
const Field2D Line{[](Vec3d x) { return 0.6 * x.x - 0.3 * x.y; },
                   [](Vec3d) {
                       return Vec3d{0.6, -0.3, 0};
                   }};
const Field2D Smooth{[](Vec3d x) { return std::sin(Turn * x.x) * std::cos(Turn * x.y); },
                     [](Vec3d x) {
                         return Turn * Vec3d{std::cos(Turn * x.x) * std::cos(Turn * x.y),
                                             -std::sin(Turn * x.x) * std::sin(Turn * x.y), 0};
                     }};
double laplacian(Vec3d x) { return -2 * Turn * Turn * Smooth.value(x); }

struct Error {
    double squares = 0, exact = 0, most = 0, mostExact = 0;
    void add(Vec3d found, Vec3d known) {
        squares += dot(found - known, found - known), exact += dot(known, known);
        most = std::max(most, length(found - known)),
        mostExact = std::max(mostExact, length(known));
    }
    double L2() const { return std::sqrt(squares / exact); }
    double largest() const { return most / mostExact; }
};

// Plain sums are those of delta_sph, corrected ones those of transport_velocity.
Scene sceneWith(Scene s, bool corrected, double jitter) {
    s.simulation.formulation = corrected ? Formulation::TransportVelocity : Formulation::DeltaSph;
    s.simulation.jitter = float(jitter);
    s.fluid.shifting = 0, s.fluid.densityDiffusion = 0, s.fluid.viscosity = 1;
    s.time = {.mode = TimeMode::Fixed, .step = 1e-8f};
    s.compute.precision = Precision::Double, s.compute.backend = Backend::Cpu;
    return s;
}

// From the pressure's force at the start. The pressure is made by density; the plain force takes
// that for uneven particles and is off by its amplitude, while small amplitudes are lost in
// densities' rounding to floats.
Error gradientError(const Scene& scene, const Field2D& field, bool corrected, double jitter,
                    bool insideOnly) {
    const Scene s = sceneWith(scene, corrected, jitter);
    const double rho0 = s.fluid.restDensity, amplitude = corrected ? 0.05 : 1e-3,
                 R = supportRadius(s);
    const double scale = rho0 * std::pow(soundSpeed(s, {}), 2) * amplitude;  // Pa
    RunState start(placeParticles(s));
    for (Vec3& u : start.particles.velocities) u = {0, 0, 0};
    for (const Vec3& x : start.particles.positions)
        start.densities.push_back(float(rho0 * (1 + amplitude * field.value(toDouble(x)))));
    Error error;
    for (const Particle& p : makeSimulation(s, start)->particles()) {
        const Vec3d x = p.position;
        if (insideOnly && (std::min(x.x, x.y) < R || std::max(x.x, x.y) > 1 - R)) continue;
        error.add((-p.density / scale) * p.acceleration, field.gradient(x));
    }
    return error;
}

// From what a step changes velocities by that have this field along x: forces, and where they are
// corrected the transport pass.
Error laplacianError(const Scene& scene, bool corrected, double jitter) {
    const Scene s = sceneWith(scene, corrected, jitter);
    RunState start(placeParticles(s));
    for (size_t i = 0; i < start.particles.positions.size(); ++i)
        start.particles.velocities[i] =
            toFloat({Smooth.value(toDouble(start.particles.positions[i])), 0, 0});
    start.densities.assign(start.particles.positions.size(), s.fluid.restDensity);
    const auto simulation = makeSimulation(s, start);
    const std::vector<Particle> before = simulation->particles();
    simulation->step();
    const std::vector<Particle> after = simulation->particles();
    const double nu = s.fluid.viscosity / s.fluid.restDensity, dt = simulation->measure().dt;
    Error error;
    for (size_t i = 0; i < before.size(); ++i)
        error.add((1 / (nu * dt)) * (after[i].velocity - before[i].velocity),
                  {laplacian(before[i].position), 0, 0});
    return error;
}

}  // namespace

void runOperators(const Scene& scene, ValidationRun& run) {
    constexpr double Jitters[] = {0, 0.05, 0.2};
    run.cost.particles = int(countParticles(scene).fluid);
    run.chart = {"", "jitter / dx", "relative error, L2", {}, false, true};
    for (bool corrected : {true, false})
        for (bool second : {false, true}) {
            Curve curve{fmt::format("{}{}", second ? "Laplacian" : "gradient",
                                    corrected ? "" : ", plain sums"),
                        {},
                        {},
                        Curve::Line};
            for (double jitter : Jitters) {
                const Error error = second ? laplacianError(scene, corrected, jitter)
                                           : gradientError(scene, Smooth, corrected, jitter, false);
                curve.x.push_back(jitter), curve.y.push_back(error.L2());
                run.metrics.push_back({fmt::format("{}, jitter {:g} dx", curve.name, jitter),
                                       "%",
                                       100 * error.L2(),
                                       {}});
                if (corrected && jitter > 0 && run.resolution >= 50)
                    run.metrics.back().target = second ? 10 : 2;
            }
            run.chart.curves.push_back(curve);
        }
    // The order is that of the gradient where particles lie most unevenly.
    std::swap(run.metrics[0], run.metrics[2]);
    const double line = gradientError(scene, Line, true, 0.2, true).largest();
    run.metrics.push_back({"gradient of a linear field, largest", "%", 100 * line, 0.1});
}

}  // namespace spindrift
