// Several fluids in one scene: what each of their forces comes to.
#include "sim/simulation.h"

#include "scene/json.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

Scene twoFluids(Formulation formulation, Precision precision) {
    Scene s;
    s.compute.backend = Backend::Cpu, s.compute.precision = precision, s.compute.threads = 1;
    s.simulation.formulation = formulation;
    s.domain.max = {1, 1, 1};
    s.walls.kind = WallKind::Reflect;
    s.simulation.spacing = 0.05f, s.simulation.jitter = 0.2f, s.simulation.gravity = {0, 0, 0};
    s.fluid.soundSpeed = 5, s.fluid.viscosity = 2;
    s.fluid.bodies = {Body{}, Body{}};
    for (Body& body : s.fluid.bodies) {
        body.min = {0.3f, 0.3f, 0.3f}, body.max = {0.7f, 0.7f, 0.7f};
        body.field = Field::Shear, body.velocity = {2, 0, 0};
    }
    s.fluid.bodies[0].max.y = 0.5f, s.fluid.bodies[1].min.y = 0.5f;
    return s;
}
double massOf(const Scene& s, int body) {
    return restDensity(s, s.fluid.bodies[size_t(body)]) * std::pow(double(s.simulation.spacing), 3);
}

constexpr Formulation Formulations[] = {Formulation::Wcsph, Formulation::DeltaSph};
constexpr Precision Precisions[] = {Precision::Float, Precision::Double};

TEST(Mixture, OfTwiceTheSameFluidIsThatFluid) {
    for (Formulation formulation : Formulations)
        for (Precision precision : Precisions) {
            const Scene one = twoFluids(formulation, precision);
            Scene two = one;
            two.fluid.bodies[0].viscosity = 2.0000005f;  // another fluid, but hardly
            ASSERT_TRUE(isMultiFluid(two) && !isMultiFluid(one));
            const auto a = makeSimulation(one), b = makeSimulation(two);
            a->step(10), b->step(10);
            const auto p = a->particles(), q = b->particles();
            double fastest = 0, apart = 0;
            for (size_t i = 0; i < p.size(); ++i) {
                fastest = std::max(fastest, length(p[i].acceleration)),
                apart = std::max(apart, length(p[i].acceleration - q[i].acceleration));
            }
            EXPECT_LT(apart, 2e-4 * fastest);
            EXPECT_NEAR(a->measure().kineticEnergy, b->measure().kineticEnergy,
                        1e-5 * a->measure().kineticEnergy);
        }
}

// Whether a fluid is the scene's or a body's own: walls, weight, both viscosities and diffusion are
// the same.
TEST(Mixture, OfOneFluidIsThatFluidAlone) {
    for (Formulation formulation : Formulations)
        for (Precision precision : Precisions) {
            Scene alone = twoFluids(formulation, precision);
            alone.walls.kind = WallKind::Particles, alone.simulation.gravity = {0, -9.81f, 0};
            alone.fluid.bodies.resize(1), alone.fluid.bodies[0].min = {0, 0, 0},
                                          alone.fluid.bodies[0].max = {0.5f, 0.5f, 1};
            alone.fluid.restDensity = 3000, alone.fluid.stiffness = 1e5f,
            alone.fluid.artificialViscosity = 0.2f;
            Scene body = alone;
            body.fluid.restDensity = 1000, body.fluid.bodies[0].restDensity = 3000;
            const auto a = makeSimulation(alone), b = makeSimulation(body);
            a->step(40), b->step(40);
            const Measurement p = a->measure(), q = b->measure();
            const double tolerance = precision == Precision::Float ? 1e-4 : 1e-6;
            EXPECT_NEAR(p.kineticEnergy, q.kineticEnergy, tolerance * p.kineticEnergy);
            EXPECT_NEAR(p.potentialEnergy, q.potentialEnergy, tolerance * p.potentialEnergy);
            EXPECT_NEAR(p.meanDensity, q.meanDensity, tolerance * p.meanDensity);
            EXPECT_NEAR(p.maxDensityError, q.maxDensityError, 10 * tolerance * p.maxDensityError);
            EXPECT_NEAR(p.dt, q.dt, tolerance * p.dt);
            EXPECT_NEAR(p.maxSpeed, q.maxSpeed, tolerance * p.maxSpeed);
            for (int id : {0, 100, 1999})
                EXPECT_NEAR(a->particle(id).pressure, b->particle(id).pressure,
                            10 * tolerance * 1e5);
        }
}

TEST(Mixture, KeepsMassAndMomentum) {
    for (Formulation formulation : Formulations)
        for (Precision precision : Precisions) {
            Scene s = twoFluids(formulation, precision);
            s.fluid.bodies[0].restDensity = 250, s.fluid.bodies[0].viscosity = 0.1f;
            for (Body& body : s.fluid.bodies) body.field = Field::Uniform;
            s.fluid.bodies[0].velocity = {-1, 0, 0};
            const auto simulation = makeSimulation(s);
            const Measurement before = simulation->measure();
            const int half = simulation->fluidCount() / 2;
            EXPECT_NEAR(before.momentum.x, half * (2 * massOf(s, 1) - massOf(s, 0)),
                        1e-5 * half * massOf(s, 1));
            EXPECT_NEAR(before.kineticEnergy, half * (4 * massOf(s, 1) + massOf(s, 0)) / 2,
                        1e-5 * half * massOf(s, 1));
            simulation->step(30);
            const Measurement after = simulation->measure();
            const double scale = half * massOf(s, 1) * after.maxSpeed;
            EXPECT_LT(length(after.momentum - before.momentum),
                      (precision == Precision::Float ? 2e-6 : 1e-9) * scale);
            for (const Particle& p : simulation->particles()) {
                const double rest =
                    p.id < half ? 250
                                : 1000;  // sums find less at the surface, but nowhere a third more
                EXPECT_TRUE(p.density < 1.33 * rest &&
                            p.density > (formulation == Formulation::DeltaSph ? 0.75 : 0.2) * rest)
                    << p.id << " " << p.density;
            }
        }
}

// Stress goes on unchanged where fluids meet: across y = 0.5, u = y / mu has none.
TEST(Mixture, ViscousStressIsTheSameOnBothSides) {
    for (Formulation formulation : Formulations) {
        Scene s = twoFluids(formulation, Precision::Double);
        s.simulation.jitter = 0, s.fluid.artificialViscosity = 0;
        s.fluid.bodies[0].viscosity = 0.25f;  // against 2: u turns by eight at the interface
        RunState state(placeParticles(s));
        for (size_t i = 0; i < state.particles.positions.size(); ++i) {
            const float y = state.particles.positions[i].y - 0.5f;
            state.particles.velocities[i] = {y < 0 ? y / 0.25f : y / 2, 0, 0};
        }
        const auto simulation = makeSimulation(s, state);
        double worst = 0, inside = 0;
        for (const Particle& p : simulation->particles()) {
            if (std::abs(p.position.x - 0.5) > 0.06 || std::abs(p.position.y - 0.5) > 0.06 ||
                std::abs(p.position.z - 0.5) > 0.06)
                continue;
            worst = std::max(worst, std::abs(p.acceleration.x)), ++inside;
        }
        EXPECT_GT(inside, 7);
        // With the arithmetic mean of viscosities it would be 0.10 m/s^2, a stress that jumps by a
        // fifth of itself over a particle.
        std::printf("viscous stress across an interface, 1 to 8: %.3g m/s^2 of %.3g\n", worst,
                    1 / (1000 * 0.05));
        EXPECT_LT(worst, 0.3 / (1000 * 0.05));
    }
}

// A body that names the viscosity that the scene has is one of a mixture from the start: the
// scene's may change.
TEST(Mixture, DoesNotBeginWhileItRuns) {
    Scene s = twoFluids(Formulation::Wcsph, Precision::Float);
    s.fluid.bodies[0].viscosity = s.fluid.viscosity;
    const auto simulation = makeSimulation(s);
    s.fluid.viscosity = 5;
    simulation->apply(s);
    simulation->step(5);
    EXPECT_TRUE(simulation->measure().finite);
}

// Terms that read the walls' velocities are there whether anything sticks to walls or not.
TEST(Mixture, MayBeWithoutViscosity) {
    for (bool mixture : {true, false}) {
        Scene s = twoFluids(Formulation::Wcsph, Precision::Float);
        s.walls.kind = WallKind::Particles, s.fluid.viscosity = 0;
        if (mixture)
            s.fluid.bodies[0].restDensity = 700;
        else
            s.simulation.pressureForm = PressureForm::Mean;
        const auto simulation = makeSimulation(s);
        simulation->step(5);
        EXPECT_TRUE(simulation->measure().finite);
    }
}

TEST(Mixture, GoesOnFromItsStateAndTakesKnobs) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/mixture_small.json");
    s.compute.backend = Backend::Cpu;
    const auto whole = makeSimulation(s);
    whole->step(30);
    whole->restart(whole->state());
    const auto rest = makeSimulation(s, whole->state());
    whole->step(30), rest->step(30);
    EXPECT_EQ(whole->state().particles.positions, rest->state().particles.positions);
    EXPECT_EQ(rest->state().particles.bodies.size(), size_t(rest->fluidCount()));
    // A live knob reaches the fluid that has none of its own.
    Scene thick = s;
    thick.fluid.viscosity = 20;
    rest->apply(thick);
    whole->apply(s);
    whole->step(30), rest->step(30);
    const auto p = whole->particles(), q = rest->particles();
    const std::vector<uint16_t> bodies = rest->state().particles.bodies;
    double apart[2] = {0, 0};
    for (size_t i = 0; i < p.size(); ++i)
        apart[bodies[i]] = std::max(apart[bodies[i]], length(p[i].velocity - q[i].velocity));
    EXPECT_GT(apart[1], 0.05);
    EXPECT_LT(apart[0], apart[1]) << "oil has a viscosity of its own";
    EXPECT_NEAR(rest->particle(0).density, 800, 40);
}

}  // namespace
}  // namespace spindrift
