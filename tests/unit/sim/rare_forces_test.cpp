// Forces that few scenes have, against their formulas summed up one pair after the other in double
// precision.
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace spindrift {
namespace {

// A block of 512 particles in disorder, in motion, with nothing around it.
Scene block(Precision precision) {
    Scene s;
    s.compute.backend = Backend::Cpu, s.compute.precision = precision, s.compute.threads = 1;
    s.domain.max = {1, 1, 1};
    s.walls.kind = WallKind::Reflect;
    s.simulation.spacing = 0.05f, s.simulation.jitter = 0.2f;
    s.fluid.bodies[0].min = {0.3f, 0.3f, 0.3f}, s.fluid.bodies[0].max = {0.7f, 0.7f, 0.7f};
    s.fluid.bodies[0].field = Field::Shear, s.fluid.bodies[0].velocity = {2, 0, 0};
    s.fluid.soundSpeed = 5, s.fluid.viscosity = 0, s.fluid.artificialViscosity = 0;
    return s;
}

// What a change of the scene adds to the first accelerations.
using Change = std::function<void(Scene&)>;
std::vector<Vec3d> added(const Scene& scene, const Change& change) {
    Scene with = scene;
    change(with);
    const auto before = makeSimulation(scene)->particles(),
               after = makeSimulation(with)->particles();
    std::vector<Vec3d> a;
    for (size_t i = 0; i < before.size(); ++i)
        a.push_back(after[i].acceleration - before[i].acceleration);
    return a;
}

double wendland(double q) {
    return q < 1 ? 10.5 / 3.14159265358979323846 * std::pow(1 - q, 4) * (1 + 4 * q) : 0;
}

// The mass in sums makes the lattice's density that at rest.
double massInSums(const Scene& s) {
    const double ratio = s.simulation.support;
    double sum = 0;
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z)
                sum +=
                    wendland(std::sqrt(double(x * x + y * y + z * z)) / ratio) / std::pow(ratio, 3);
    return s.fluid.restDensity * std::pow(double(s.simulation.spacing), 3) / sum;
}

// Sum over pairs of f(i, j, m W).
using PairForce = std::function<Vec3d(const Particle&, const Particle&, double)>;
std::vector<Vec3d> sumOfPairs(const Scene& s, const PairForce& f) {
    const auto particles = makeSimulation(s)->particles();
    const double R = supportRadius(s), m = massInSums(s);
    std::vector<Vec3d> a(particles.size());
    for (const Particle& i : particles)
        for (const Particle& j : particles)
            a[size_t(i.id)] =
                a[size_t(i.id)] +
                f(i, j, m / (R * R * R) * wendland(length(i.position - j.position) / R));
    return a;
}

void expectEqual(const std::vector<Vec3d>& a, const std::vector<Vec3d>& exact, double tolerance) {
    double largest = 0, worst = 0;
    for (size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, length(exact[i])),
        worst = std::max(worst, length(a[i] - exact[i]));
    EXPECT_GT(largest, 0);
    EXPECT_LT(worst, tolerance * largest);
}

constexpr Precision Both[] = {Precision::Float, Precision::Double};
double roundOff(Precision p) {
    return p == Precision::Float ? 3e-5 : 3e-7;
}  // (downloads of double precision lose nothing; knobs are floats)

Vec3d total(const std::vector<Vec3d>& a) {
    Vec3d sum{};
    for (const Vec3d& v : a) sum = sum + v;
    return sum;
}
double largest(const std::vector<Vec3d>& a) {
    double most = 0;
    for (const Vec3d& v : a) most = std::max(most, length(v));
    return most;
}

TEST(VelocityTransfer, IsItsSumAndKeepsMomentum) {
    for (Precision precision : Both) {
        const Scene s = block(precision);
        const auto a = added(s, [](Scene& with) { with.fluid.velocityTransfer = 8; });
        expectEqual(
            a,
            sumOfPairs(s,
                       [](const Particle& i, const Particle& j, double mW) {
                           return 8 * mW *
                                  (1 / std::max(i.density, 800.0) +
                                   1 / std::max(j.density, 800.0)) /
                                  2 * (j.velocity - i.velocity);  // few neighbours: see storeState
                       }),
            roundOff(precision) *
                10);  // a difference of accelerations, those of pressure among them
        EXPECT_LT(length(total(a)), 1e-4 * largest(a));
    }
}

TEST(Buoyancy, IsItsSumAndKeepsMomentum) {
    for (Precision precision : Both) {
        const Scene s = block(precision);
        const auto a = added(s, [](Scene& with) { with.fluid.buoyancy = 3; });
        expectEqual(a,
                    sumOfPairs(s,
                               [&](const Particle& i, const Particle& j, double mW) {
                                   return 3 * mW * (i.density - j.density) / 1e6 *
                                          toDouble(s.simulation.gravity);
                               }),
                    roundOff(precision) * 10);
        EXPECT_LT(length(total(a)), 1e-4 * largest(a));
    }
}

TEST(Dissipation, SlowsAllAlike) {
    const Scene s = block(Precision::Double);
    const auto a = added(s, [](Scene& with) { with.fluid.dissipation = 2; });
    const auto particles = makeSimulation(s)->particles();
    for (const Particle& p : particles)
        EXPECT_LT(length(a[size_t(p.id)] + 2.0 * p.velocity), 1e-9 + 1e-6 * length(p.velocity));
}

// A drop of one particle falls at sqrt(2 m g / (rho C A)) in the end, against the wind.
TEST(Drag, EndsInTerminalSpeedAndSparesTheInside) {
    for (Precision precision : Both) {
        Scene s = block(precision);
        s.fluid.airDensity = 1.2f;
        Scene drop = s;
        drop.domain.periodicY = true;  // it falls and falls
        drop.fluid.bodies[0].min = {0.5f, 0.5f, 0.5f},
        drop.fluid.bodies[0].max = {0.55f, 0.55f, 0.55f};
        drop.fluid.bodies[0].field = Field::Uniform, drop.fluid.bodies[0].velocity = {0, 0, 0};
        drop.fluid.wind = {0, 5, 0};
        drop.time.mode = TimeMode::Fixed, drop.time.step = 0.002f;
        const auto simulation = makeSimulation(drop);
        ASSERT_EQ(simulation->fluidCount(), 1);
        simulation->step(6000);
        const double volume = std::pow(0.05, 3),
                     radius = std::cbrt(3 * volume / (4 * 3.14159265358979)),
                     area = 3.14159265358979 * radius * radius;
        EXPECT_NEAR(simulation->particle(0).velocity.y,
                    5 - std::sqrt(2 * 1000 * volume * 9.81 / (1.2 * 0.47 * area)), 0.3);

        const auto a = added(block(precision), [](Scene& with) { with.fluid.airDensity = 1.2f; });
        for (const Particle& p : makeSimulation(s)->particles()) {
            if (p.density > 1000) {
                EXPECT_EQ(length(a[size_t(p.id)]), 0);
            } else if (p.density < 700) {
                EXPECT_LT(dot(a[size_t(p.id)], p.velocity), 0);
            }
        }
    }
}

TEST(PressureForm, MeanIsMuellersSum) {
    for (Precision precision : Both) {
        Scene s = block(precision);
        s.fluid.backgroundPressure = 500;  // so that all have some
        const auto squares = makeSimulation(s)->particles();
        s.simulation.pressureForm = PressureForm::Mean;
        const auto mean = makeSimulation(s)->particles();
        const double R = supportRadius(s);
        // Gradients are calibrated on the lattice: one factor for all, which the other form shares.
        auto sum = [&](auto weight) {
            std::vector<Vec3d> a(mean.size());
            for (const Particle& i : mean)
                for (const Particle& j : mean) {
                    const double q = length(i.position - j.position) / R,
                                 rhoI = std::max(i.density, 800.0),
                                 rhoJ = std::max(j.density, 800.0);
                    if (q < 1)
                        a[size_t(i.id)] = a[size_t(i.id)] + std::pow(1 - q, 3) *
                                                                weight(i, j, rhoI, rhoJ) *
                                                                (i.position - j.position);
                }
            return a;
        };
        const auto exactMean = sum([](const Particle& i, const Particle& j, double ri, double rj) {
            return (i.pressure + j.pressure) / (2 * ri * rj);
        });
        const auto exactSquares =
            sum([](const Particle& i, const Particle& j, double ri, double rj) {
                return i.pressure / (ri * ri) + j.pressure / (rj * rj);
            });
        double scale = 0, weight = 0;
        const Vec3d g = toDouble(s.simulation.gravity);
        for (size_t i = 0; i < mean.size(); ++i)
            scale += dot(squares[i].acceleration - g, exactSquares[i]),
                weight += dot(exactSquares[i], exactSquares[i]);
        std::vector<Vec3d> a, exact;
        for (size_t i = 0; i < mean.size(); ++i)
            a.push_back(mean[i].acceleration - g), exact.push_back(scale / weight * exactMean[i]);
        expectEqual(a, exact, roundOff(precision) * 10);
        EXPECT_LT(length(total(a)), 1e-4 * largest(a));
    }
}

TEST(BackgroundPressure, IsThatOfFluidAtRestDensity) {
    Scene s = block(Precision::Double);
    s.simulation.jitter = 0, s.fluid.backgroundPressure = 123;
    bool inside = false;
    for (const Particle& p : makeSimulation(s)->particles())
        if (std::abs(p.density - 1000) < 1e-3) {
            inside = true;
            EXPECT_NEAR(p.pressure, 123, 0.1);
        }
    EXPECT_TRUE(inside);
}

// u_x = y^2 has the Laplacian 2, whatever a kernel's sums of Laplacians are made of.
TEST(Viscosity, OfAParabolaIsExactOnTheLatticeWithEveryKernel) {
    for (Kernel kernel :
         {Kernel::WendlandC2, Kernel::CubicSpline, Kernel::QuinticSpline, Kernel::Mueller})
        for (int dimensions : {2, 3}) {
            Scene s = block(Precision::Double);
            s.simulation.kernel = kernel, s.simulation.dimensions = dimensions,
            s.simulation.jitter = 0, s.simulation.gravity = {0, 0, 0};
            s.simulation.support = 2;
            s.fluid.viscosity = 10;
            RunState state(placeParticles(s));
            for (size_t i = 0; i < state.particles.positions.size(); ++i) {
                const float y = state.particles.positions[i].y;
                state.particles.velocities[i] = {y * y, 0, 0};
            }
            const auto simulation = makeSimulation(s, state);
            int inside = 0;
            for (const Particle& p : simulation->particles()) {
                bool far = true;
                for (int k = 0; k < dimensions; ++k)
                    far = far && std::abs(p.position[k] - 0.5) < 0.2 - supportRadius(s) - 0.01;
                if (!far) continue;
                ++inside;
                EXPECT_NEAR(p.acceleration.x, 10 / 1000.0 * 2, 2e-4)
                    << int(kernel) << " " << dimensions;
            }
            EXPECT_GT(inside, 3);
        }
}

// The colour mode: of a pool its upper layer, of lists with each pair once and of others.
TEST(Surface, IsWhereTheColourEnds) {
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (const Precision precision : {Precision::Float, Precision::Double}) {
            Scene scene;
            scene.compute.backend = Backend::Cpu, scene.compute.precision = precision;
            setKnob(scene, std::string("simulation.formulation=") + formulation);
            scene.domain.max = {1, 1, 1}, scene.simulation.spacing = 0.05f;
            scene.fluid.bodies[0].max = {1, 0.6f, 1};
            auto simulation = makeSimulation(scene);
            simulation->step(3);
            std::vector<Vertex> vertices(size_t(simulation->fluidCount()));
            simulation->writeVertices({vertices.data()}, ColorBy::Surface, 0);
            for (const Vertex& v : vertices) {
                if (v.y > 0.56f) { EXPECT_EQ(v.value, 1) << v.x << " " << v.y << " " << v.z; }
                if (v.y < 0.5f) { EXPECT_EQ(v.value, 0) << v.x << " " << v.y << " " << v.z; }
            }
        }
}

// Beside a block of fluid, whose corners and edges belong to its surface: drops of one, two and
// three particles, in the air, at a wall and in a corner of the box.
TEST(Surface, IsNotWhatFliesAround) {
    for (const char* formulation : {"wcsph", "delta_sph"})
        for (const int dimensions : {2, 3})
            for (const Precision precision : {Precision::Float, Precision::Double}) {
                Scene scene;
                scene.compute.backend = Backend::Cpu, scene.compute.precision = precision;
                scene.simulation.dimensions = dimensions;
                scene.simulation.spacing = 0.05f;
                setKnob(scene, std::string("simulation.formulation=") + formulation);
                scene.domain.max = {1, 1, 1};
                const float deep = dimensions == 2 ? 1 : 0.05f, block = dimensions == 2 ? 1 : 0.5f;
                scene.fluid.bodies = {Body{{.max{0.5f, 0.5f, block}}}};
                const int drops = dimensions == 2 ? 2 : 3;
                for (int n = 1; n <= drops; ++n)
                    for (const Vec3 at : {Vec3{0.75f, 0.2f * float(n), 0.5f},
                                          {0, 0.6f + 0.1f * float(n), 0.5f},
                                          {1 - 0.05f * float(n), 1 - 0.2f * float(n), 0}}) {
                        const Vec3 low{at.x, at.y, dimensions == 2 ? 0 : at.z};
                        scene.fluid.bodies.push_back(
                            Body{{.min = low, .max = low + Vec3{0.05f * float(n), 0.05f, deep}}});
                    }
                auto simulation = makeSimulation(scene);
                simulation->step(1);
                std::vector<Vertex> vertices(size_t(simulation->fluidCount()));
                simulation->writeVertices({vertices.data()}, ColorBy::Surface, 0);
                int spray = 0, edges = 0;
                for (const Vertex& v : vertices) {
                    const bool inBlock =
                        v.x < 0.5f && v.y < 0.5f && (dimensions == 2 || v.z < 0.5f);
                    const bool free = inBlock && (v.x > 0.45f || v.y > 0.45f);
                    if (!inBlock) {
                        EXPECT_EQ(v.value, 0) << "drop at " << v.x << " " << v.y << " " << v.z;
                    }
                    if (free) { EXPECT_EQ(v.value, 1) << v.x << " " << v.y << " " << v.z; }
                    spray += !inBlock, edges += free;
                }
                EXPECT_EQ(spray, 3 * drops * (drops + 1) / 2);
                EXPECT_GT(edges, 15);
            }
}

}  // namespace
}  // namespace spindrift
