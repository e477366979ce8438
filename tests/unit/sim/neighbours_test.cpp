// Density and acceleration, hence the neighbour search below them, equal a plain double-precision sum over all pairs: on
// every instruction set of this machine and in the double instance, for clouds that are random, clustered, or on walls.
#include "core/error.h"
#include "scene/particles.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace spindrift {
namespace {

constexpr double Pi = 3.14159265358979323846;

struct Engine { const char* name; Simd simd; Precision precision; double tolerance; bool cuda = false; };
constexpr Engine Engines[] = {{"avx512", Simd::Avx512, Precision::Float, 2e-5},
                              {"avx2", Simd::Avx2, Precision::Float, 2e-5},
                              {"sse", Simd::Sse, Precision::Float, 2e-5},
                              {"double", Simd::Auto, Precision::Double, 1e-6},   // its input is rounded to float
                              {"CUDA device", Simd::Auto, Precision::Float, 2e-5, true}};

// The simulation, or nothing where this machine lacks the instructions or the GPU.
std::unique_ptr<Simulation> tryMake(Scene scene, const Placement& p, const Engine& e, int threads = 2) {
    scene.compute.simd = e.simd;
    if (e.precision == Precision::Double) return makeDoubleSimulation(scene, p, threads);
    try {
        if (e.cuda) return makeCudaSimulation(scene, p, 0);
        return makeSimdSimulation(scene, p, threads);
    } catch (const Error&) {
        return nullptr;
    }
}

Scene emptyBox(float support, Kernel kernel) {
    Scene s;
    s.domain.max = {1, 0.8f, 0.6f};
    s.simulation.spacing = 0.05f;
    s.simulation.support = support;
    s.simulation.kernel = kernel;
    s.simulation.gravity = {0, 0, 0};
    s.walls.kind = WallKind::Reflect;
    s.fluid.particleMass = 0.1f;
    s.fluid.soundSpeed = 20;
    s.fluid.viscosity = 3;
    s.fluid.artificialViscosity = 0.2f;
    return s;
}

enum class Cloud { Random, Clustered, OnWalls };

Placement makeCloud(const Scene& s, Cloud cloud, int n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    Placement p;
    for (int i = 0; i < n; ++i) {
        Vec3 x{s.domain.max.x * unit(random), s.domain.max.y * unit(random), s.domain.max.z * unit(random)};
        if (cloud == Cloud::Clustered) x = toFloat(0.3 * toDouble(x) + double(i % 3) * Vec3d{0.4, 0.3, 0.2});
        if (cloud == Cloud::OnWalls) x[i % 3] = i % 2 ? s.domain.max[i % 3] : 0;
        p.positions.push_back(x);
        p.velocities.push_back({unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f});
    }
    p.positions[1] = p.positions[0];   // two in one place must not matter
    return p;
}

// All pairs, straight from the formulas.
struct BruteForce {
    std::vector<double> rho;
    std::vector<Vec3d> a;

    static double w(Kernel k, double q) {
        if (q >= 1) return 0;
        if (k == Kernel::WendlandC2) return 21 / (2 * Pi) * std::pow(1 - q, 4) * (1 + 4 * q);
        const double s = 2 * q;
        return 8 / Pi * (s < 1 ? 1 - 1.5 * s * s + 0.75 * s * s * s : 0.25 * std::pow(2 - s, 3));
    }
    // By central difference, so that the analytic gradients are checked as well.
    static double derivative(Kernel k, double q) {
        const double e = 1e-6;
        return (w(k, q + e) - w(k, std::max(0.0, q - e))) / (q + e - std::max(0.0, q - e));
    }

    BruteForce(const Scene& s, const Placement& p) {
        const double R = supportRadius(s), h = R / 2, m = particleMass(s) / latticeSum(s), rho0 = s.fluid.restDensity;
        const double c = s.fluid.soundSpeed, k = rho0 * c * c / s.fluid.gamma;
        const size_t n = p.positions.size();
        rho.resize(n), a.resize(n);
        auto apart = [&](size_t i, size_t j) { return toDouble(p.positions[i]) - toDouble(p.positions[j]); };
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < n; ++j)
                rho[i] += m / (R * R * R) * w(s.simulation.kernel, length(apart(i, j)) / R);
        auto term = [&](size_t i) {
            return std::max(0.0, k * (std::pow(rho[i] / rho0, s.fluid.gamma) - 1)) / (rho[i] * rho[i]);
        };
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < n; ++j) {
                const Vec3d r = apart(i, j), u = toDouble(p.velocities[i]) - toDouble(p.velocities[j]);
                const double d = length(r);
                if (d == 0 || d >= R) continue;
                const Vec3d gradW = (m / std::pow(R, 4) * derivative(s.simulation.kernel, d / R) / d) * r;
                const double meet = std::min(0.0, dot(u, r)) / (d * d + 0.01 * h * h);
                const double artificial = s.fluid.artificialViscosity * c * h * meet * 0.5 * (1 / rho[i] + 1 / rho[j]);
                const double laminar = 2 * s.fluid.viscosity / (rho[i] * rho[j]) * dot(r, gradW) / (d * d + 0.01 * h * h);
                a[i] = a[i] + (artificial - term(i) - term(j)) * gradW + laminar * u;
            }
    }
    // What the program divides the mass in sums by, so that a lattice has the rest density.
    static double latticeSum(const Scene& s) {
        const double ratio = s.simulation.support;
        const double scale = particleMass(s) / (s.fluid.restDensity * std::pow(double(s.simulation.spacing), 3));
        double sum = 0;
        for (int z = -4; z <= 4; ++z)
            for (int y = -4; y <= 4; ++y)
                for (int x = -4; x <= 4; ++x)
                    sum += w(s.simulation.kernel, std::sqrt(double(x * x + y * y + z * z)) / ratio);
        return scale * sum / std::pow(ratio, 3);
    }
};

void expectBruteForce(float support, Kernel kernel, Cloud cloud, const Engine& engine) {
    const Scene scene = emptyBox(support, kernel);
    const Placement placement = makeCloud(scene, cloud, 1500);
    const auto simulation = tryMake(scene, placement, engine);
    if (!simulation) GTEST_SKIP() << "no " << engine.name << " here";
    const BruteForce exact(scene, placement);
    double largest = 0, density = 0, acceleration = 0;
    for (const Vec3d& a : exact.a) largest = std::max(largest, length(a));
    const std::vector<Particle> particles = simulation->particles();
    ASSERT_EQ(particles.size(), placement.positions.size());
    for (size_t i = 0; i < particles.size(); ++i) {
        ASSERT_EQ(particles[i].id, int(i));
        density = std::max(density, std::abs(particles[i].density / exact.rho[i] - 1));
        acceleration = std::max(acceleration, length(particles[i].acceleration - exact.a[i]) / largest);
    }
    EXPECT_GT(largest, 1);
    EXPECT_LT(density, engine.tolerance);
    EXPECT_LT(acceleration, 20 * engine.tolerance);   // pressure is a small difference of large powers of density
}

class Neighbours : public testing::TestWithParam<std::tuple<float, Kernel, Cloud, Engine>> {};
TEST_P(Neighbours, EqualBruteForce) { std::apply(expectBruteForce, GetParam()); }
INSTANTIATE_TEST_SUITE_P(All, Neighbours,
                         testing::Combine(testing::Values(2.0f, 2.6f),
                                          testing::Values(Kernel::WendlandC2, Kernel::CubicSpline),
                                          testing::Values(Cloud::Random, Cloud::Clustered, Cloud::OnWalls),
                                          testing::ValuesIn(Engines)));

// Where one slab of cells ends and the next begins, consecutive clusters lie far apart.
TEST(NeighbourLists, TallColumnsAndSparseSprayAreFound) {
    for (const Engine& engine : Engines) {
        Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
        scene.simulation.spacing = 0.01f;
        scene.domain.max = {0.06f, 6, 0.06f};
        scene.fluid.particleMass = 0.001f;
        Placement placement;
        for (int i = 0; i < 3000; ++i)   // a thin column 500 spacings tall, and single drops above it
            placement.positions.push_back({0.015f + 0.01f * float(i % 2), 0.005f + 0.01f * float(i / 6), 0.015f + 0.01f * float(i / 2 % 3)});
        for (int i = 0; i < 40; ++i) placement.positions.push_back({0.03f, 5.1f + 0.02f * float(i), 0.05f * float(i % 2)});
        placement.velocities.resize(placement.positions.size());
        const auto simulation = tryMake(scene, placement, engine);
        if (!simulation) continue;
        const BruteForce exact(scene, placement);
        double worst = 0;
        for (const Particle& p : simulation->particles())
            worst = std::max(worst, std::abs(p.density / exact.rho[size_t(p.id)] - 1));
        EXPECT_LT(worst, engine.tolerance) << engine.name;
        simulation->step(3);
        EXPECT_TRUE(simulation->measure().finite);
    }
}

// Lists that are kept for some steps give what lists made anew in each step give, up to the order of sums.
TEST(NeighbourLists, KeptListsMissNobody) {
    Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
    scene.simulation.gravity = {3, -9.81f, 1};
    const Placement placement = makeCloud(scene, Cloud::Random, 3000);
    for (const Engine& engine : Engines) {
        std::optional<std::vector<Particle>> fresh;
        for (float skin : {0.0f, 0.3f}) {
            scene.compute.skin = skin;
            const auto simulation = tryMake(scene, placement, engine);
            if (!simulation) continue;
            simulation->step(12);
            if (!fresh) {
                fresh = simulation->particles();
                continue;
            }
            const std::vector<Particle> kept = simulation->particles();
            double worst = 0;
            for (size_t i = 0; i < kept.size(); ++i)
                worst = std::max(worst, std::abs(kept[i].density / (*fresh)[i].density - 1));
            EXPECT_LT(worst, 1e-3) << engine.name;
        }
    }
}

// Pair forces are equal and opposite: without gravity and walls total momentum stays as it is.
TEST(Conservation, MomentumToRoundOff) {
    Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
    scene.domain.min = {-5, -5, -5};
    scene.domain.max = {6, 6, 6};   // nobody reaches the box
    Placement placement = makeCloud(scene, Cloud::Random, 4000);
    for (Vec3& x : placement.positions) x = toFloat(0.05 * toDouble(x) + Vec3d{5, 5, 5});
    for (const Engine& engine : Engines) {
        const auto simulation = tryMake(scene, placement, engine);
        if (!simulation) continue;
        const Vec3d before = simulation->measure().momentum;
        simulation->step(100);
        const Measurement after = simulation->measure();
        const double scale = particleMass(scene) * 4000 * after.maxSpeed;
        EXPECT_GT(after.maxSpeed, 1) << engine.name;
        EXPECT_LT(length(after.momentum - before), 1e-6 * scale) << engine.name;
    }
}

}  // namespace
}  // namespace spindrift
