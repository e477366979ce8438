#define SPINDRIFT_REAL double
#define LANES exactLanes
#include "measure/exact.h"

#include "sim/physics/kernels.h"

#include <cmath>
#include <numbers>

namespace spindrift {

using std::numbers::pi;

double TaylorGreenFlow::decay(double t) const { return std::exp(-8 * pi * pi * nu * t / (L * L)); }

Vec3d TaylorGreenFlow::velocity(Vec3d p, double t) const {
    const double x = 2 * pi * p.x / L, y = 2 * pi * p.y / L, u = U * decay(t);
    return {-u * std::cos(x) * std::sin(y), u * std::sin(x) * std::cos(y), 0};
}

double TaylorGreenFlow::pressure(Vec3d p, double t) const {
    const double x = 4 * pi * p.x / L, y = 4 * pi * p.y / L, u = U * decay(t);
    return -rho0 * u * u / 4 * (std::cos(x) + std::cos(y));
}

// Terms beyond these are below 1e-12 at any time that a run reaches.
static constexpr int Terms = 400;

double poiseuilleFlow(double y, double t, double L, double nu, double F) {
    double u = F / (2 * nu) * y * (L - y);
    for (int n = 0; n < Terms; ++n) {
        const double k = (2 * n + 1) * pi / L;
        u -= 4 * F / (nu * L * k * k * k) * std::sin(k * y) * std::exp(-k * k * nu * t);
    }
    return u;
}

double couetteFlow(double y, double t, double L, double nu, double V) {
    double u = V * y / L;
    for (int n = 1; n < Terms; ++n) {
        const double k = n * pi / L;
        u += 2 * V / (n * pi) * (n % 2 ? -1 : 1) * std::sin(k * y) * std::exp(-k * k * nu * t);
    }
    return u;
}

void OscillatingDrop::advance(double dt) {
    struct State {
        double a, rate;
    };
    auto slope = [](State s) -> State {
        const double a2 = s.a * s.a, b2 = 1 / a2;  // the area stays
        return {s.rate * s.a, (s.rate * s.rate + 1) * (b2 - a2) / (a2 + b2)};
    };
    auto along = [](State s, double h, State d) -> State {
        return {s.a + h * d.a, s.rate + h * d.rate};
    };
    const int steps = int(std::ceil(dt / 1e-3));
    const double h = steps > 0 ? dt / steps : 0;
    State s{a, rate};
    for (int k = 0; k < steps; ++k) {  // Runge-Kutta, fourth order
        const State k1 = slope(s), k2 = slope(along(s, h / 2, k1)), k3 = slope(along(s, h / 2, k2)),
                    k4 = slope(along(s, h, k3));
        s = {s.a + h / 6 * (k1.a + 2 * k2.a + 2 * k3.a + k4.a),
             s.rate + h / 6 * (k1.rate + 2 * k2.rate + 2 * k3.rate + k4.rate)};
    }
    a = s.a, rate = s.rate;
}

namespace {

using Complex = std::complex<double>;

// The root of f near a guess, by secants.
template <class F> Complex rootNear(Complex s, const F& f) {
    Complex before = 0.999 * s, valueBefore = f(before);
    for (int k = 0; k < 60; ++k) {
        const Complex value = f(s);
        if (value == valueBefore) break;
        const Complex next = s - value * (s - before) / (value - valueBefore);
        before = s, valueBefore = value, s = next;
    }
    return s;
}

// Modified Bessel function of the first kind, by its series.
Complex besselI(int n, Complex z) {
    const Complex quarter = z * z / 4.0;
    Complex term = std::pow(z / 2.0, n) / std::tgamma(n + 1.0), sum = 0;
    for (int k = 1; k < 500; ++k) {
        sum += term;
        term *= quarter / double(k * (k + n));
    }
    return sum;
}

}  // namespace

std::complex<double> viscousWave(double k, double depth, double g, double nu) {
    const double restoring = g * k * std::tanh(k * depth);  // 1/s^2
    return rootNear({-2 * nu * k * k, std::sqrt(restoring)}, [&](Complex s) {
        const Complex K = std::sqrt(k * k + s / nu), rate = s + 2 * nu * k * k;
        return rate * rate + restoring -
               4 * nu * nu * k * k * k * K * std::tanh(k * depth) / std::tanh(K * depth);
    });
}

std::complex<double> viscousDrop(int n, double R, double Omega, double nu) {
    return rootNear(
        {-2.0 * n * (n - 1) * nu / (R * R), std::sqrt(double(n)) * Omega}, [&](Complex s) {
            const Complex k = std::sqrt(s / nu), z = k * R, i = besselI(n, z),
                          slope = 0.5 * k * (besselI(n - 1, z) + besselI(n + 1, z)),
                          bend = k * k * i * (1.0 + double(n * n) / (z * z)) - slope / R;
            // Potential r^n, and so much vorticity that there is no shear at R.
            const double power = std::pow(R, n - 2), N = n;
            const Complex B = -2 * N * (N - 1) * power / (bend - slope / R + N * N * i / (R * R));
            const Complex u = N * power * R + B * N * i / R,
                          stretch = N * (N - 1) * power + B * N * (slope / R - i / (R * R));
            return s * power * R * R + Omega * Omega * R * u / s + 2 * nu * stretch;
        });
}

BodyInBox bodyInBox(double own, double volume, Vec3d box, int dimensions) {
    const double pi = std::numbers::pi;
    double field = 0;  // of all images of a dipole, along it
    for (int m = -6; m <= 6; ++m) {
        const double X = m * box.x, sign = m % 2 ? -1 : 1;
        if (dimensions == 2) {
            const double s = std::sinh(pi * X / box.y);
            field += pi * pi / (box.y * box.y) * (m == 0 ? 1.0 / 3 : -sign / (s * s));
            continue;
        }
        constexpr int far = 100;
        const double end = far * std::min(box.y, box.z);  // beyond, as if spread out in the plane
        for (int n = -far; n <= far; ++n)
            for (int l = -far; l <= far; ++l) {
                const double across2 = std::pow(n * box.y, 2) + std::pow(l * box.z, 2),
                             r2 = X * X + across2;
                if (r2 > 0 && across2 <= end * end)
                    field += sign * (r2 - 3 * X * X) / std::pow(r2, 2.5);
            }
        field += sign * 2 * pi * end * end / (std::pow(end * end + X * X, 1.5) * box.y * box.z);
    }
    const double dipole = (own + volume) / (2 * pi * (dimensions - 1)), e = dipole * field;
    return {(own + volume * e) / (1 - e), 1 / (1 - e)};
}

double bassetIntegral(double A, double onset, double t) {
    return 4.0 / 3 * A / onset * (std::pow(t, 1.5) - std::pow(std::max(t - onset, 0.0), 1.5));
}

void SettlingSphere::advance(double dt) {
    const double ratio = density / fluidDensity, perSpeed = fluidDensity * diameter / viscosity;
    auto drag = [&](double u) { return u * (1 + 0.15 * std::pow(perSpeed * u, 0.687)); };
    const int steps = int(std::ceil(dt / 1e-4));
    for (int k = 0; k < steps; ++k) {
        const double before = speed;
        speed +=
            dt / steps * (ratio - 1) * gravity * (1 - drag(speed) / drag(terminal)) / (ratio + 0.5);
        depth += dt / steps * 0.5 * (before + speed);
    }
}

// Gradients as sum V f(x_j) dW/dx, Laplacians as Morris 1997, both scaled so that lines and
// parabolas are exact, as simulations do.
LatticeWave latticeWave(Kernel kernel, int dimensions, double support, double kdx) {
    const int n = int(support) + 1, across = dimensions == 3 ? n : 0;
    double sine = 0, cosine = 0, line = 0;
    exactLanes::withKernel(kernel, [&](auto one) {
        for (int z = -across; z <= across; ++z)
            for (int y = -n; y <= n; ++y)
                for (int x = -n; x <= n; ++x) {
                    const double g =
                        decltype(one)::g(std::sqrt(double(x * x + y * y + z * z)) / support);
                    sine += g * x * std::sin(kdx * x), cosine += 2 * g * (1 - std::cos(kdx * x)),
                        line += g * x * x;
                }
    });
    return {sine / line, cosine / line};
}

}  // namespace spindrift
