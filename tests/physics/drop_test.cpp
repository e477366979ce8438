// Surface tension: drops are round, press with sigma / r, and swing with Rayleigh's period.
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

constexpr double Radius = 0.1, Tension = 1, Density = 1000;

Scene drop(int dimensions, double particles,
           float speed) {  // particles: along a radius; speed: of stretching at its end, m/s
    Scene s;
    s.compute.backend = Backend::Cpu;
    s.simulation.formulation = Formulation::DeltaPlus, s.simulation.dimensions = dimensions,
    s.simulation.placement = StartPlaces::Relaxed;
    s.simulation.spacing = float(Radius / particles), s.simulation.gravity = {0, 0, 0};
    s.domain.max = {0.4f, 0.4f, dimensions == 3 ? 0.4f : 0.1f};
    s.walls.kind = WallKind::Reflect;
    s.fluid.viscosity = 0, s.fluid.artificialViscosity = 0.02f,
    s.fluid.surfaceTension = float(Tension);
    Body& body = s.fluid.bodies[0];
    body.shape = dimensions == 3 ? Shape::Sphere : Shape::Cylinder, body.axis = Axis::Z;
    body.center = 0.5f * s.domain.max, body.radius = float(Radius), body.height = 0.1f;
    body.field = Field::Stretching, body.velocity = {speed, 0, 0};
    return s;
}

// Second moments about the middle: along x less along y, and the radius that a disc has of them;
// the farthest particle.
struct Shape2 {
    Vec3d middle;
    double stretch, radius, farthest;
};
Shape2 shapeOf(const std::vector<Particle>& particles) {
    const double each = 1 / double(particles.size());
    Vec3d middle{};
    double x2 = 0, y2 = 0, farthest = 0;
    for (const Particle& p : particles) middle = middle + each * p.position;
    for (const Particle& p : particles) {
        const Vec3d r = p.position - middle;
        x2 += each * r.x * r.x, y2 += each * r.y * r.y;
        farthest = std::max(farthest, length(r));
    }
    return {middle, x2 - y2, std::sqrt(2 * (x2 + y2)), farthest};
}

// s, of a swing: twice the time until it is a circle again.
double periodOf(const Scene& scene, double expected) {
    const auto simulation = makeSimulation(scene);
    double before = 0, last = 0;
    while (last < expected) {
        simulation->step(20);
        const double now = simulation->clock().time,
                     stretch = shapeOf(simulation->particles()).stretch;
        if (now > expected / 8 && stretch < 0)
            return 2 * (last + (now - last) * before / (before - stretch));
        before = stretch, last = now;
    }
    return 0;
}

// Rayleigh 1879: omega^2 = 8 sigma / (rho r^3), in two dimensions 6. There the period depends on
// how a drop happens to be packed, 2 to 13 % too long: the mean of some counts.
void expectRayleighsPeriod(int dimensions, double particles, int packings) {
    const double period =
        2 * std::numbers::pi /
        std::sqrt((dimensions == 3 ? 8 : 6) * Tension / (Density * std::pow(Radius, 3)));
    Scene scene = drop(dimensions, particles, 0.04f);
    double mean = 0;
    for (int seed = 1; seed <= packings; ++seed) {
        scene.simulation.seed = seed;
        const double one = periodOf(scene, period);
        std::printf(
            "drop, %d dimensions, %g particles along the radius: period %.4f s, "
            "Rayleigh's %.4f s\n",
            dimensions, particles, one, period);
        mean += one / packings;
    }
    EXPECT_NEAR(mean, period, 0.08 * period);
}
TEST(Drop, SwingsWithRayleighsPeriod) {
    expectRayleighsPeriod(2, 25, 4);
    expectRayleighsPeriod(3, 12, 1);
}

TEST(Drop, IsRoundAndPressesAsLaplaceSays) {
    Scene s = drop(2, 15, 0);
    Body& body = s.fluid.bodies[0];
    body = {};
    body.min = {0.12f, 0.12f, 0}, body.max = {0.28f, 0.28f, 0.1f};  // a square becomes round
    s.fluid.viscosity = 5;
    const auto simulation = makeSimulation(s);
    while (simulation->clock().time < 4) simulation->step(50);
    const std::vector<Particle> particles = simulation->particles();
    const Shape2 shape = shapeOf(particles);
    double pressure = 0, inside = 0;
    for (const Particle& p : particles)
        if (length(p.position - shape.middle) < shape.radius - supportRadius(s))
            pressure += p.pressure, ++inside;
    pressure /= inside;
    std::printf(
        "drop: mean pressure inside %.2f Pa, Laplace's %.2f Pa; radius %.4f m, farthest %.4f m\n",
        pressure, Tension / shape.radius, shape.radius, shape.farthest + s.simulation.spacing / 2);
    EXPECT_NEAR(pressure, Tension / shape.radius, 0.25 * Tension / shape.radius);
    EXPECT_LT(std::abs(shape.stretch), 0.03 * shape.radius * shape.radius);
    EXPECT_LT(shape.farthest + s.simulation.spacing / 2,
              1.06 * shape.radius);  // a square's corners: 1.2
    EXPECT_LT(simulation->measure().maxSpeed, 0.05);
    EXPECT_LT(length(shape.middle - Vec3d{0.2, 0.2, 0.05}),
              0.7 * Radius);  // its forces don't quite cancel
}

}  // namespace
}  // namespace spindrift
