// The orders of the integrators, on motions whose answer is known and on a flow against much
// smaller steps.
#include "scene/json.h"
#include "scene/schema.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

// From bad to good, but for the first; what splits is for carried densities that are not shifted.
constexpr Integrator All[] = {Integrator::Split, Integrator::SymplecticEuler,
                              Integrator::VelocityVerlet, Integrator::PredictorCorrector};
bool fits(Formulation f, Integrator i) {
    return i != Integrator::Split || f == Formulation::DeltaSph;
}
bool isFirstOrder(Integrator i) {
    return i == Integrator::Split || i == Integrator::SymplecticEuler;
}

void fixSteps(Scene& s, Integrator integrator, double step) {
    s.time.integrator = integrator;
    s.time.mode = TimeMode::Fixed, s.time.step = float(step);
    s.compute.precision = Precision::Double, s.compute.backend = Backend::Cpu;
}

// One particle in the central force field: x(t) = x0 cos Omega t + u0 / Omega sin Omega t about the
// centre.
double orbitError(Formulation formulation, Integrator integrator, double step) {
    Scene s;
    s.simulation.formulation = formulation;
    s.simulation.gravity = {0, 0, 0}, s.simulation.centralRate = 1;
    s.simulation.spacing = 0.0625f;
    s.walls.kind = WallKind::Reflect;
    s.domain.max = {2, 2, 2};
    s.fluid.bodies[0].min = {1.5f, 0.96875f, 0.96875f},
    s.fluid.bodies[0].max = {1.5625f, 1.03125f, 1.03125f};
    s.fluid.bodies[0].velocity = {0.25f, 0.5f, 0};
    s.fluid.soundSpeed = 10;
    fixSteps(s, integrator, step);
    const auto simulation = makeSimulation(s);
    EXPECT_EQ(simulation->fluidCount(), 1);
    simulation->step(int(std::lround(5 / step)));
    const double t = simulation->measure().time;
    const Vec3d exact = std::cos(t) * Vec3d{0.53125, 0, 0} + std::sin(t) * Vec3d{0.25, 0.5, 0};
    return length(simulation->particle(0).position - Vec3d{1, 1, 1} - exact);
}

TEST(Integrators, OrbitsHaveTheirOrder) {
    for (Formulation f : {Formulation::Wcsph, Formulation::DeltaSph})
        for (Integrator i : All) {
            if (!fits(f, i)) continue;
            const double coarse = orbitError(f, i, 1.0 / 64), fine = orbitError(f, i, 1.0 / 128);
            const double order = std::log2(coarse / fine);
            std::printf("orbit, %s: %.2e, %.2e, order %.2f\n", enumNames(i)[size_t(i)], coarse,
                        fine, order);
            EXPECT_NEAR(order, isFirstOrder(i) ? 1 : 2, 0.1) << int(i);
            EXPECT_LT(fine, isFirstOrder(i) ? 5e-3 : 5e-5) << int(i);
        }
}

// Viscous Taylor-Green vortices on few particles: velocities at t = 0.1 against steps of an eighth.
std::vector<Particle> vortices(Formulation formulation, Integrator integrator, double step) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/validation/taylor_green.json");
    s.simulation.formulation = formulation;
    s.simulation.spacing = 0.05f;
    s.fluid.viscosity = 0.05f;
    // What moves particles is then the flow alone: shifts go with the largest speed, which is no
    // smooth function of time.
    s.fluid.shifting = 0;
    fixSteps(s, integrator, step);
    const auto simulation = makeSimulation(s);
    simulation->step(int(std::lround(0.1 / step)));
    return simulation->particles();
}

double distance(const std::vector<Particle>& a, const std::vector<Particle>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += dot(a[i].velocity - b[i].velocity, a[i].velocity - b[i].velocity);
    return std::sqrt(sum / double(a.size()));
}

TEST(Integrators, FlowsHaveTheirOrder) {
    constexpr double Step = 1.0 / 640;
    for (Formulation f :
         {Formulation::Wcsph, Formulation::DeltaSph, Formulation::TransportVelocity}) {
        const std::vector<Particle> exact = vortices(f, Integrator::PredictorCorrector, Step / 8);
        double before = 1e9;
        for (Integrator i : All) {
            if (!fits(f, i)) continue;
            const double coarse = distance(vortices(f, i, Step), exact),
                         fine = distance(vortices(f, i, Step / 2), exact);
            const double order = std::log2(coarse / fine);
            std::printf("%s, %s: %.2e, %.2e, order %.2f\n", enumNames(f)[size_t(f)],
                        enumNames(i)[size_t(i)], coarse, fine, order);
            const bool second = !isFirstOrder(i) &&
                                (f == Formulation::Wcsph || i == Integrator::PredictorCorrector);
            // Where particles are shifted the part of the velocity that they are carried through is
            // of first order, and small.
            EXPECT_GT(order, second && f != Formulation::TransportVelocity ? 1.9 : 0.9);
            if (i == Integrator::Split) continue;  // which is better here than its order says
            EXPECT_LT(fine, before * (i == Integrator::VelocityVerlet ? 0.7 : 0.5))
                << "a better integrator is no better";
            before = fine;
        }
    }
}

}  // namespace
}  // namespace spindrift
