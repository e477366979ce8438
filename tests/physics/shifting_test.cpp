// Fluid whose particles are shifted keeps its room and its pressure.
#include "measure/validation.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace spindrift {
namespace {

// Still water 25 spacings deep between periodic sides, for six periods of its longest wave: the
// mean height of its upper layer in spacings, less that of the beginning. Shifted particles that
// lose their order and get it back swelled it by a tenth of a spacing, and on and on.
double risenBy(const std::string& integrator, double support) {
    Scene s;
    for (const std::string& knob : std::vector<std::string>{
             "compute.backend=cpu", "compute.threads=1", "simulation.formulation=delta_plus",
             "simulation.dimensions=2", "simulation.spacing=0.04", "simulation.gravity=0,-1,0",
             "domain.max=1,1.3,0.1", "domain.periodic_x=true", "fluid.rest_density=1",
             "fluid.viscosity=0.0004", "fluid.artificial_viscosity=0", "fluid.sound_speed=20",
             "fluid.equation_of_state=linear", "time.cfl=0.8",
             R"(fluid.bodies=[{"min":[0,0,0],"max":[1,1,0.1],"pressure":"hydrostatic"}])",
             "time.integrator=" + integrator})
        setKnob(s, knob);
    s.simulation.support = float(support);
    const auto simulation = makeSimulation(s);
    const auto height = [&] {
        std::vector<double> heights;
        for (const Particle& p : simulation->particles()) heights.push_back(p.position.y);
        std::sort(heights.rbegin(), heights.rend());
        double sum = 0;
        for (int i = 0; i < 25; ++i) sum += heights[size_t(i)];
        return sum / 25 / 0.04;
    };
    const double before = height();
    while (simulation->clock().time < 15) simulation->step(50);
    return height() - before;
}

TEST(Shifting, LeavesStillWaterItsLevel) {
    for (const std::string integrator : {"predictor_corrector", "symplectic_euler"})
        for (const double support : {2.6, 3.2})
            EXPECT_NEAR(risenBy(integrator, support), 0, 0.04) << integrator << " " << support;
}

// What shifting did to densities pumped sound into it: 168 % of the pressure.
TEST(Shifting, LeavesAStretchingDiscItsPressure) {
    const std::string folder = SPINDRIFT_SOURCE_DIR "/configs/validation/";
    const std::vector<ValidationCase> cases = validationCases(folder + "data");
    const auto drop =
        std::ranges::find(cases, std::string("stretched_drop"), &ValidationCase::name);
    ASSERT_NE(drop, cases.end());
    Scene scene = loadScene(folder + "stretched_drop.json");
    drop->adjust(scene, 25);
    const ValidationRun run = validate(*drop, scene, 25);
    EXPECT_FALSE(run.diverged);
    for (const Metric& m : run.metrics) {
        const double most = m.name.starts_with("pressure") ? 15
                            : m.name.ends_with("axis")     ? 0.3
                                                           : 1;
        EXPECT_LT(std::abs(m.value), most) << m.name;
    }
}

}  // namespace
}  // namespace spindrift
