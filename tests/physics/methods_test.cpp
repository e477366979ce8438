// Whatever may be combined of formulation, kernel, integrator, pressure form, walls and time mode
// keeps what is promised of each.
#include "methods.h"

#include "measure/stress.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace spindrift {
namespace {

constexpr float Step = 2e-4f;  // s, half the one that cfl takes in these scenes

Scene sceneOf(const Method& m, int dimensions, const std::vector<std::string>& knobs) {
    Scene s;
    s.compute.backend = Backend::Cpu;
    s.compute.threads = 1;
    s.simulation.spacing = 0.05f, s.simulation.dimensions = dimensions;
    s.domain.max = {0.6f, 0.6f, 0.6f};
    for (const std::string& knob : knobs) setKnob(s, knob);
    setMethod(s, m);
    s.time.step = Step;
    return s;
}

// A block that falls onto the floor, or vortices where fluid fills the box.
StressCase violent(const Method& m, int dimensions) {
    const bool full = Formulation(m[0]) == Formulation::TransportVelocity;
    StressCase c;
    c.name = nameOf(m), c.steps = 120;
    c.scene = sceneOf(
        m, dimensions,
        full
            ? std::vector<
                  std::string>{"simulation.gravity=0,0,0",
                               R"(fluid.bodies=[{"shape":"block","min":[0,0,0],)"
                               R"("max":[0.6,0.6,0.6],"field":"taylor_green","velocity":[1,0,0]}])"}
            : std::vector<std::string>{R"(fluid.bodies=[{"shape":"block","min":[0.2,0.05,0.2],)"
                                       R"("max":[0.4,0.25,0.4],"velocity":[0,-3,0]}])"});
    // Neither what walls weigh in the classic formulation nor the mean of two pressures follows
    // from an energy.
    c.energyIsConserved =
        Formulation(m[0]) != Formulation::Classic && PressureForm(m[3]) == PressureForm::Squares;
    return c;
}

// Two blocks that meet in space. What is not promised is left out: shifting keeps no momentum, nor
// do local steps where the two of a pair take different ones.
void expectMomentumKept(const Method& m, int dimensions) {
    const Formulation f = Formulation(m[0]);
    if (f == Formulation::TransportVelocity || f == Formulation::Classic) return;
    const Scene scene = sceneOf(
        m, dimensions,
        {"simulation.gravity=0,0,0", "simulation.jitter=0.1", "fluid.shifting=0",
         R"(fluid.bodies=[{"shape":"block","min":[0.1,0.2,0.2],"max":[0.3,0.4,0.4],)"
         R"("velocity":[2,0.5,0]},{"shape":"block","min":[0.3,0.25,0.2],"max":[0.45,0.4,0.4]}])"});
    const auto simulation = makeSimulation(scene);
    const Measurement before = simulation->measure();
    for (int k = 0; k < 60; ++k) {
        simulation->stopAt(simulation->clock().time + double(Step));
        simulation->step();
    }
    const Measurement after = simulation->measure();
    const double mass = double(particleMass(scene)) * simulation->fluidCount();
    EXPECT_EQ(after.evaluations, 60.0 * simulation->fluidCount()) << "all take the same step";
    EXPECT_LT(after.kineticEnergy, 0.999 * before.kineticEnergy) << nameOf(m) << " did not meet";
    EXPECT_LT(length(after.momentum - before.momentum), 1e-6 * mass * after.maxSpeed)
        << dimensions << "D " << nameOf(m);
}

void expectPromisesKept(const Method& m, int dimensions) {
    const StressCase c = violent(m, dimensions);
    const StressResult r = stress(c);
    EXPECT_EQ(int(r.verdict), int(Verdict::Sound))
        << dimensions << "D " << c.name << ": " << r.what;
    EXPECT_EQ(r.retries, 0) << dimensions << "D " << c.name;
    EXPECT_EQ(r.particles,
              int(std::lround(std::pow(Formulation(m[0]) == Formulation::TransportVelocity ? 12 : 4,
                                       dimensions))));
    expectMomentumKept(m, dimensions);
}

// Every two values that may meet do. SPINDRIFT_ALL_METHODS=1: all combinations, minutes.
TEST(Methods, ThatGoTogetherKeepTheirPromises) {
    for (const int dimensions : {2, 3}) {
        std::vector<Method> methods = coveringMethods(dimensions);
        if (std::getenv("SPINDRIFT_ALL_METHODS")) {
            methods = allMethods();
            std::erase_if(methods, [&](const Method& m) { return !goesTogether(m, dimensions); });
        }
        EXPECT_GT(methods.size(), 20u);
        for (const Method& m : methods) expectPromisesKept(m, dimensions);
        std::printf("%zu methods in %d dimensions\n", methods.size(), dimensions);
    }
}

}  // namespace
}  // namespace spindrift
