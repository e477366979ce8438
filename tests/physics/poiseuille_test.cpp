// Flow between plates, driven by a body force from rest, against the series of Poiseuille flow: the
// first test of two dimensions, a periodic axis, viscosity and walls that fluid sticks to,
// together.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

struct Errors {
    double l2 = 0, across = 0;
};  // of the velocity, relative; largest velocity across the plates, m/s

// u(y, t) for plates at 0 and 1 m, F = 0.8 m/s^2, nu = 0.1 m^2/s (Morris 1997, eq. 21).
double exact(double y, double t) {
    const double F = 0.8, nu = 0.1, pi = 3.14159265358979323846;
    double u = F / (2 * nu) * y * (1 - y);
    for (int n = 0; n < 50; ++n) {
        const double k = (2 * n + 1) * pi;
        u -= 4 * F / (nu * k * k * k) * std::sin(k * y) * std::exp(-k * k * nu * t);
    }
    return u;
}

Errors errorsAt(double time, int particlesAcross) {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/poiseuille.json");
    scene.compute.backend = Backend::Cpu;
    scene.simulation.spacing = 1.0f / float(particlesAcross);
    const auto simulation = makeSimulation(scene);
    while (simulation->measure().time < time) simulation->step(10);
    const double t = simulation->measure().time;
    double difference = 0, sum = 0;
    Errors e;
    for (const Particle& p : simulation->particles()) {
        const double u = exact(p.position.y, t);
        difference += (p.velocity.x - u) * (p.velocity.x - u) + p.velocity.y * p.velocity.y;
        sum += u * u;
        e.across = std::max(e.across, std::abs(p.velocity.y));
        EXPECT_EQ(p.velocity.z, 0);
    }
    e.l2 = std::sqrt(difference / sum);
    return e;
}

TEST(Poiseuille, StartingFlowConvergesInSecondOrder) {
    const Errors coarse = errorsAt(0.5, 20), fine = errorsAt(0.5, 40);
    std::printf("L2 %.2f %% at 20, %.2f %% at 40 particles across\n", 100 * coarse.l2,
                100 * fine.l2);
    EXPECT_LT(coarse.l2, 0.01);
    EXPECT_LT(fine.l2, 0.003);
    EXPECT_GT(std::log2(coarse.l2 / fine.l2), 1.5);
    EXPECT_LT(fine.across, 1e-3);
}

TEST(Poiseuille, SteadyStateIsTheParabola) {
    const Errors e = errorsAt(5, 20);
    std::printf("L2 %.2f %%\n", 100 * e.l2);
    EXPECT_LT(e.l2, 0.01);
    EXPECT_LT(e.across, 2e-3);
}

}  // namespace
}  // namespace spindrift
