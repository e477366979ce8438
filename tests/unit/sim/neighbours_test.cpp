// Density and acceleration, hence the neighbour search below them, equal a plain double-precision
// sum over all pairs: on every instruction set of this machine and in the double instance, for
// clouds that are random, clustered, or on walls.
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

struct Engine {
    const char* name;
    Simd simd;
    Precision precision;
    double tolerance;
    bool cuda = false;
};
constexpr Engine Engines[] = {
#ifndef SPINDRIFT_EMULATED_GPU  // where that is, these have been tried already
    {"avx512", Simd::Avx512, Precision::Float, 2e-5},
    {"avx2", Simd::Avx2, Precision::Float, 2e-5},
    {"sse", Simd::Sse, Precision::Float, 2e-5},
    {"double", Simd::Auto, Precision::Double, 1e-6},  // its input is rounded to float
#endif
    {"CUDA device", Simd::Auto, Precision::Float, 2e-5, true}};

// Others walk the rows of cells in each pass.
bool keepsLists(const Engine& e) { return e.precision == Precision::Float && !e.cuda; }

// The simulation, or nothing where this machine lacks the instructions or the GPU.
std::unique_ptr<Simulation> tryMake(Scene scene, const Placement& p, const Engine& e,
                                    int threads = 2) {
    scene.compute.simd = e.simd;
    if (e.precision == Precision::Double) return makeDoubleSimulation(scene, p, threads);
    try {
        if (e.cuda) return makeCudaSimulation(scene, p, 0);
        return makeSimdSimulation(scene, p, threads);
    } catch (const Error&) { return nullptr; }
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
    s.fluid.viscosity = 100;
    s.fluid.artificialViscosity = 0.2f;
    return s;
}

// A closed box in three dimensions, or not.
struct Space {
    const char* name;
    int dimensions;
    bool x, y, z;
};
constexpr Space Box{"box", 3, false, false, false};
constexpr Space OtherSpaces[] = {{"periodic x", 3, true, false, false},
                                 {"periodic", 3, true, true, true},
                                 {"flat", 2, false, false, false},
                                 {"flat and periodic y", 2, false, true, false},
                                 {"flat and periodic", 2, true, true, false}};
void put(Scene& s, const Space& space) {
    s.simulation.dimensions = space.dimensions;
    s.domain.periodicX = space.x, s.domain.periodicY = space.y, s.domain.periodicZ = space.z;
}

enum class Cloud { Random, Clustered, OnWalls };

Placement makeCloud(const Scene& s, Cloud cloud, int n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    Placement p;
    for (int i = 0; i < n; ++i) {
        Vec3 x{s.domain.max.x * unit(random), s.domain.max.y * unit(random),
               s.domain.max.z * unit(random)};
        if (cloud == Cloud::Clustered)
            x = toFloat(0.3 * toDouble(x) + double(i % 3) * Vec3d{0.4, 0.3, 0.2});
        if (cloud == Cloud::OnWalls) x[i % 3] = i % 2 ? s.domain.max[i % 3] : 0;
        Vec3 u{unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f};
        if (s.simulation.dimensions == 2) x.z = 0.5f * s.domain.max.z, u.z = 0;
        for (int k = 0; k < 3; ++k)
            if (s.domain.periodic(k)) x[k] = std::fmod(x[k], s.domain.max[k]);
        p.positions.push_back(x);
        p.velocities.push_back(u);
    }
    p.positions[1] = p.positions[0];  // two in one place must not matter
    return p;
}

// All pairs, straight from the formulas.
struct BruteForce {
    std::vector<double> rho;
    std::vector<Vec3d> a;

    static double w(Kernel k, double q, int dimensions) {
        if (q >= 1) return 0;
        const bool flat = dimensions == 2;
        auto fifth = [&](double knot) { return std::pow(std::max(0.0, knot - 3 * q), 5); };
        const double s = 2 * q;
        switch (k) {
            case Kernel::WendlandC2:
                return (flat ? 7 / Pi : 21 / (2 * Pi)) * std::pow(1 - q, 4) * (1 + 4 * q);
            case Kernel::WendlandC4:
                return (flat ? 9 / Pi : 495 / (32 * Pi)) * std::pow(1 - q, 6) *
                       (1 + 6 * q + 35 * q * q / 3);
            case Kernel::WendlandC6:
                return (flat ? 78 / (7 * Pi) : 1365 / (64 * Pi)) * std::pow(1 - q, 8) *
                       (1 + 8 * q + 25 * q * q + 32 * q * q * q);
            case Kernel::QuinticSpline:
                return (flat ? 63 / (478 * Pi) : 9 / (40 * Pi)) *
                       (fifth(3) - 6 * fifth(2) + 15 * fifth(1));
            default:
                return (flat ? 40 / (7 * Pi) : 8 / Pi) *
                       (s < 1 ? 1 - 1.5 * s * s + 0.75 * s * s * s : 0.25 * std::pow(2 - s, 3));
        }
    }
    // By central difference, so that the analytic gradients are checked as well.
    static double derivative(Kernel k, double q, int d) {
        const double e = 1e-6;
        return (w(k, q + e, d) - w(k, std::max(0.0, q - e), d)) / (q + e - std::max(0.0, q - e));
    }

    // W'/q, of particles in one place its limit: viscosity acts between them, pressure has no
    // direction.
    static double slope(Kernel k, double q, int d) {
        constexpr double AtZero[] = {-20, -12, -56.0 / 3, -22, -180.0 / 11};
        if (q == 0) return AtZero[int(k)] * w(k, 0, d);
        return derivative(k, q, d) / q;
    }

    BruteForce(const Scene& s, const Placement& p) {
        const int dim = s.simulation.dimensions;
        const double R = supportRadius(s), h = R / 2, rho0 = s.fluid.restDensity;
        const Moments moments = latticeMoments(s);
        const double m = particleMass(s) / moments.kernel;
        const double exactGradient = moments.kernel / moments.gradient;
        const double c = s.fluid.soundSpeed, k = rho0 * c * c / s.fluid.gamma;
        const size_t n = p.positions.size();
        rho.resize(n), a.resize(n);
        auto apart = [&](size_t i, size_t j) {
            Vec3d r = toDouble(p.positions[i]) - toDouble(p.positions[j]);
            for (int k = 0; k < 3; ++k) {
                const double period = s.domain.max[k];  // min is 0
                if (s.domain.periodic(k)) r[k] -= period * std::round(r[k] / period);
            }
            return r;
        };
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < n; ++j)
                rho[i] +=
                    m / std::pow(R, dim) * w(s.simulation.kernel, length(apart(i, j)) / R, dim);
        // What forces divide by.
        auto dense = [&](size_t i) { return std::max(rho[i], 0.8 * rho0); };
        // What viscosity as strong as here takes for 1 / rho.
        std::vector<double> counted;
        for (size_t i = 0; i < n; ++i) {
            double around = 0;
            for (size_t j = 0; j < n; ++j)
                if (const double q = length(apart(i, j)) / R; q < 1)
                    around += std::pow(q, 4) * slope(s.simulation.kernel, q, dim);
            counted.push_back(1 / rho0 / std::sqrt(std::max(around / moments.surroundings, 0.25)));
        }
        auto term = [&](size_t i) {
            return std::max(0.0, k * (std::pow(rho[i] / rho0, s.fluid.gamma) - 1)) /
                   (dense(i) * dense(i));
        };
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < n; ++j) {
                const Vec3d r = apart(i, j),
                            u = toDouble(p.velocities[i]) - toDouble(p.velocities[j]);
                const double d = length(r);
                if (i == j || d >= R) continue;
                const double F = exactGradient * m / std::pow(R, dim + 2) *
                                 slope(s.simulation.kernel, d / R, dim);
                const Vec3d gradW = F * r;
                const double meet = std::min(0.0, dot(u, r)) / (d * d + 0.01 * h * h);
                const double artificial = s.fluid.artificialViscosity * c * h * meet * 0.5 *
                                          (1 / dense(i) + 1 / dense(j));
                const double laminar = 2 * s.fluid.viscosity * counted[i] * counted[j];
                a[i] = a[i] + laminar * dot(u, r) / moments.squared * gradW;
                a[i] = a[i] + (artificial - term(i) - term(j)) * gradW;
            }
    }
    // What the program divides by, so that on a lattice density and gradient are exact.
    struct Moments {
        double kernel = 0, gradient = 0, squared = 0;  // m^2, of viscosity along the line of pairs
        double surroundings = 0;
    };
    static Moments latticeMoments(const Scene& s) {
        const double ratio = s.simulation.support;
        const int dim = s.simulation.dimensions, across = dim == 3 ? 4 : 0;
        const double scale =
            particleMass(s) / (s.fluid.restDensity * std::pow(double(s.simulation.spacing), dim));
        Moments m;
        for (int z = -across; z <= across; ++z)
            for (int y = -4; y <= 4; ++y)
                for (int x = -4; x <= 4; ++x) {
                    const double r = std::sqrt(double(x * x + y * y + z * z));
                    const double value = scale / std::pow(ratio, dim);
                    m.kernel += value * w(s.simulation.kernel, r / ratio, dim);
                    if (r == 0 || r >= ratio) continue;
                    const double slope =
                        value * derivative(s.simulation.kernel, r / ratio, dim) / ratio / r;
                    m.gradient -= slope * x * x;
                    m.surroundings +=
                        std::pow(r / ratio, 3) * derivative(s.simulation.kernel, r / ratio, dim);
                    m.squared -= slope * x * x * y * y;
                }
        m.squared *= std::pow(double(s.simulation.spacing), 2) / m.gradient;
        return m;
    }
};

void expectBruteForce(float support, Kernel kernel, Cloud cloud, const Engine& engine,
                      const Space& space, int count) {
    Scene scene = emptyBox(support, kernel);
    put(scene, space);
    if (space.dimensions == 2) scene.fluid.particleMass = 0.3f;
    const Placement placement = makeCloud(scene, cloud, count);
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
        acceleration =
            std::max(acceleration, length(particles[i].acceleration - exact.a[i]) / largest);
    }
    EXPECT_GT(largest, 1);
    EXPECT_LT(density, engine.tolerance);
    EXPECT_LT(acceleration,
              20 * engine.tolerance);  // pressure is a small difference of large powers of density
}

class Neighbours : public testing::TestWithParam<std::tuple<float, Kernel, Cloud, Engine>> {};
TEST_P(Neighbours, EqualBruteForce) {
    const auto& [support, kernel, cloud, engine] = GetParam();
    expectBruteForce(support, kernel, cloud, engine, Box, 1500);
}
INSTANTIATE_TEST_SUITE_P(All, Neighbours,
                         testing::Combine(testing::Values(2.0f, 2.6f),
                                          testing::Values(Kernel::WendlandC2, Kernel::CubicSpline),
                                          testing::Values(Cloud::Random, Cloud::Clustered,
                                                          Cloud::OnWalls),
                                          testing::ValuesIn(Engines)));

class Spaces : public testing::TestWithParam<std::tuple<Space, Cloud, Engine>> {};
TEST_P(Spaces, EqualBruteForce) {
    const auto& [space, cloud, engine] = GetParam();
    SCOPED_TRACE(space.name);
    for (Kernel kernel : {Kernel::WendlandC2, Kernel::CubicSpline})
        expectBruteForce(2.6f, kernel, cloud, engine, space, 700);
    if (cloud == Cloud::Random)
        for (Kernel kernel : {Kernel::WendlandC4, Kernel::WendlandC6, Kernel::QuinticSpline})
            expectBruteForce(3.2f, kernel, cloud, engine, space, 700);
}
INSTANTIATE_TEST_SUITE_P(All, Spaces,
                         testing::Combine(testing::ValuesIn(OtherSpaces),
                                          testing::Values(Cloud::Random, Cloud::Clustered,
                                                          Cloud::OnWalls),
                                          testing::ValuesIn(Engines)));

// Where one slab of cells ends and the next begins, consecutive clusters lie far apart.
TEST(NeighbourLists, TallColumnsAndSparseSprayAreFound) {
    for (const Engine& engine : Engines) {
        Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
        scene.simulation.spacing = 0.01f;
        scene.domain.max = {0.06f, 6, 0.06f};
        scene.fluid.particleMass = 0.001f;
        Placement placement;
        for (int i = 0; i < 3000;
             ++i)  // a thin column 500 spacings tall, and single drops above it
            placement.positions.push_back({0.015f + 0.01f * float(i % 2),
                                           0.005f + 0.01f * float(i / 6),
                                           0.015f + 0.01f * float(i / 2 % 3)});
        for (int i = 0; i < 40; ++i)
            placement.positions.push_back({0.03f, 5.1f + 0.02f * float(i), 0.05f * float(i % 2)});
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

// Lists that are kept for some steps give what lists made anew in each step give, up to the order
// of sums.
TEST(NeighbourLists, KeptListsMissNobody) {
    for (int k = 0; k < 9 * int(std::size(Engines)); ++k) {
        const Space& space = k % 3 == 0 ? Box : k % 3 == 1 ? OtherSpaces[1] : OtherSpaces[3];
        const Engine& engine = Engines[k / 9];
        if (!keepsLists(engine)) continue;
        SCOPED_TRACE(space.name);
        Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
        put(scene, space);
        scene.time.integrator = Integrator(k / 3 % 3);
        scene.simulation.gravity = {3, -9.81f, 0};
        if (space.dimensions == 2) scene.fluid.particleMass = 0.3f;
        const Placement placement = makeCloud(scene, Cloud::Random, 3000);
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

// A limit on accelerations, however high, makes every particle gather from all its neighbours;
// without one each pair is computed once. Nine blocks of clusters, so that sums go from block to
// block, also over the ends of periodic axes.
TEST(HalfListSums, EqualSumsOverAllNeighbours) {
    for (const Engine& engine : Engines)
        for (const Space& space : {Box, OtherSpaces[1], OtherSpaces[3]})
            for (Cloud cloud : {Cloud::Random, Cloud::Clustered}) {
                if (!keepsLists(engine)) continue;
                SCOPED_TRACE(testing::Message() << engine.name << " " << space.name);
                Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
                put(scene, space);
                if (space.dimensions == 2) scene.fluid.particleMass = 0.3f;
                const Placement placement = makeCloud(scene, cloud, 9000);
                std::vector<std::vector<Particle>> ways;
                for (float limit : {0.0f, 1e17f}) {
                    scene.simulation.accelerationLimit = limit;
                    if (const auto simulation = tryMake(scene, placement, engine))
                        ways.push_back(simulation->particles());
                }
                if (ways.empty()) continue;
                double largest = 0, density = 0, acceleration = 0;
                for (const Particle& p : ways[1])
                    largest = std::max(largest, length(p.acceleration));
                for (size_t i = 0; i < ways[0].size(); ++i) {
                    density =
                        std::max(density, std::abs(ways[0][i].density / ways[1][i].density - 1));
                    acceleration = std::max(
                        acceleration,
                        length(ways[0][i].acceleration - ways[1][i].acceleration) / largest);
                }
                EXPECT_GT(largest, 1);
                EXPECT_LT(density, engine.tolerance);
                EXPECT_LT(acceleration, 20 * engine.tolerance);
            }
}

// Pair forces are equal and opposite: without gravity and walls total momentum stays as it is.
TEST(Conservation, MomentumToRoundOff) {
    Scene scene = emptyBox(2.6f, Kernel::WendlandC2);
    scene.domain.min = {-5, -5, -5};
    scene.domain.max = {6, 6, 6};  // nobody reaches the box
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
