// The known answers themselves: they solve their equations, and meet figures printed elsewhere.
#include "measure/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// du/dt + u.grad u + grad p / rho = nu Laplacian u, and div u = 0, by central differences.
TEST(Exact, TaylorGreenSolvesNavierStokes) {
    const TaylorGreenFlow f{2, 0.7, 0.03, 5};
    const double e = 1e-4, t = 0.4;
    for (Vec3d x : {Vec3d{0.3, 0.9, 0}, Vec3d{1.7, 0.2, 0}}) {
        auto u = [&](double dx, double dy, double dt = 0) {
            return f.velocity({x.x + dx, x.y + dy, 0}, t + dt);
        };
        auto p = [&](double dx, double dy) { return f.pressure({x.x + dx, x.y + dy, 0}, t); };
        const Vec3d ux = (1 / (2 * e)) * (u(e, 0) - u(-e, 0)),
                    uy = (1 / (2 * e)) * (u(0, e) - u(0, -e));
        const Vec3d laplacian =
            (1 / (e * e)) * (u(e, 0) + u(-e, 0) + u(0, e) + u(0, -e) - 4.0 * u(0, 0));
        const Vec3d rate = (1 / (2 * e)) * (u(0, 0, e) - u(0, 0, -e));
        const Vec3d force =
            (-1 / (2 * e * f.rho0)) * Vec3d{p(e, 0) - p(-e, 0), p(0, e) - p(0, -e), 0};
        const Vec3d rest = rate + u(0, 0).x * ux + u(0, 0).y * uy - force - f.nu * laplacian;
        EXPECT_LT(length(rest), 1e-5);
        EXPECT_NEAR(ux.x + uy.y, 0, 1e-7);
    }
}

// Long waves are seen as they are, with an error that goes with the square of their wave number;
// the shortest have no slope.
TEST(Exact, LatticesSeeLongWavesBest) {
    for (Kernel kernel : {Kernel::WendlandC2, Kernel::QuinticSpline}) {
        const auto missing = [&](double kdx) {
            return 1 - latticeWave(kernel, 2, 2.6, kdx).k / kdx;
        };
        EXPECT_NEAR(missing(0.1) / missing(0.05), 4, 0.05);
        EXPECT_LT(missing(0.1), 0.01);
        EXPECT_NEAR(latticeWave(kernel, 3, 2.6, 0.01).k2, 1e-4, 1e-8);
        EXPECT_NEAR(latticeWave(kernel, 2, 2.6, M_PI).k, 0, 1e-12);
    }
}

// Table values of Morris, Fox and Zhu's series, L = 1e-3 m, nu = 1e-6 m^2/s, V0 = 1.25e-5 m/s, at
// nu t / L^2 = 0.1125.
TEST(Exact, FlowsBetweenPlatesStartAtRestAndEndSteady) {
    const double L = 1e-3, nu = 1e-6, F = 1e-4, V = 1.25e-5;
    for (double y : {0.0, 0.2e-3, 0.5e-3, 0.9e-3, 1e-3}) {
        EXPECT_NEAR(poiseuilleFlow(y, 0, L, nu, F) / V, 0, 1e-6) << y;
        EXPECT_NEAR(poiseuilleFlow(y, 10, L, nu, F) / V, 4 * y / L * (1 - y / L), 1e-9);
        EXPECT_NEAR(couetteFlow(y, 10, L, nu, V) / V, y / L, 1e-9);
    }
    EXPECT_NEAR(couetteFlow(0.5e-3, 1e-3, L, nu, V) / V, 0, 1e-9);
    // One term of the series is enough at late times: 1 - 32/pi^3 exp(-pi^2 nu t / L^2) in the
    // middle.
    EXPECT_NEAR(poiseuilleFlow(0.5e-3, 0.225, L, nu, F) / V,
                1 - 32 / std::pow(M_PI, 3) * std::exp(-M_PI * M_PI * 0.225), 1e-4);
}

// Period and largest semi-axis as in Monaghan and Rafiee 2013 and Sun 2017 (T = 4.827, 1.932 R).
TEST(Exact, DropComesBackAfterItsPeriod) {
    OscillatingDrop drop;
    double most = 0;
    for (int k = 0; k < 1000; ++k) {
        drop.advance(OscillatingDrop::period / 1000);
        most = std::max(most, drop.a);
    }
    EXPECT_NEAR(drop.a, 1, 2e-6);
    EXPECT_NEAR(drop.rate, 1, 2e-6);
    EXPECT_NEAR(most, 1.931852, 1e-4);
}

// Where viscosity is weak all is lost where potential flow shears: 2 nu k^2 of waves on deep water,
// 2 n (n - 1) nu / R^2 of drops (Lamb 1932); what vorticity below the surface changes goes with the
// root of the viscosity.
TEST(Exact, WeakViscosityDampsAsLambSays) {
    const double k = 3, g = 9.81, R = 0.5, Omega = 2;
    double before = 1;
    for (const double nu : {1e-5, 1e-6, 1e-7}) {
        const std::complex<double> wave = viscousWave(k, 100, g, nu);
        EXPECT_NEAR(wave.imag(), std::sqrt(g * k), 1e-4);
        const double missing = 1 - wave.real() / (-2 * nu * k * k);
        EXPECT_GT(missing, 0);
        EXPECT_NEAR(missing / before, std::sqrt(0.1), before < 1 ? 0.02 : 1);
        before = missing;
    }
    for (const int n : {2, 3}) {
        const double nu = 1e-4;
        const std::complex<double> drop = viscousDrop(n, R, Omega, nu);
        EXPECT_NEAR(drop.imag(), std::sqrt(n) * Omega, 1e-3);
        EXPECT_NEAR(drop.real() / (-2 * n * (n - 1) * nu / (R * R)), 1, 0.02 * n);
    }
}

// The sum over all images, brute force; far walls change nothing.
TEST(Exact, BoxesMirrorBodies) {
    const double pi = std::numbers::pi;
    for (const Vec3d box : {Vec3d{1, 1, 1}, Vec3d{2, 1, 1}, Vec3d{1, 1.5, 1}}) {
        double field = 0;
        for (int m = -8; m <= 8; ++m)
            for (int n = -20000; n <= 20000; ++n) {
                const double X = m * box.x, Y = n * box.y, r2 = X * X + Y * Y;
                if (r2 > 0) field += (m % 2 ? -1 : 1) * (Y * Y - X * X) / (r2 * r2);
            }
        const double a = 0.1, e = a * a * field;
        const BodyInBox body = bodyInBox(pi * a * a, pi * a * a, box, 2);
        EXPECT_NEAR(body.addedMass, pi * a * a * (1 + e) / (1 - e), 1e-5) << box.x << box.y;
        EXPECT_NEAR(body.faster, 1 / (1 - e), 1e-3);
    }
    const double ball = 4 * pi / 3;
    EXPECT_NEAR(bodyInBox(ball / 2, ball, {100, 100, 100}, 3).addedMass, ball / 2, 1e-4);
    EXPECT_NEAR(bodyInBox(ball / 2, ball, {6, 6, 6}, 3).addedMass / ball, 0.5344, 1e-4);
    // Constant from the start: 2 A sqrt(t).
    EXPECT_NEAR(bassetIntegral(3, 1e-6, 4), 12, 1e-4);
}

// In oil as thick as this drag is as the speed: v = terminal (1 - exp(-t / T)).
TEST(Exact, SpheresSink) {
    SettlingSphere sphere{0.01, 2000, 1000, 1000, 10, 0.05};
    const double T = 0.05 * 2.5 / 10;
    for (const double t : {0.5 * T, T}) {
        sphere.advance(0.5 * T);
        EXPECT_NEAR(sphere.speed, 0.05 * (1 - std::exp(-t / T)), 2e-4);
    }
    EXPECT_NEAR(sphere.depth, 0.05 * T * std::exp(-1), 2e-6);
    sphere.advance(20 * T);
    EXPECT_NEAR(sphere.speed, 0.05, 1e-6);
}

}  // namespace
}  // namespace spindrift
