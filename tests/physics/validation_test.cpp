// The quick part of `spindrift validate`: every target that is set there, and the orders of
// convergence.
#include "measure/validation.h"

#include "scene/check.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

const std::string Configs = SPINDRIFT_SOURCE_DIR "/configs/validation/";

class Validation : public testing::TestWithParam<ValidationCase> {};

ValidationRun runAt(const ValidationCase& c, int resolution,
                    const std::function<void(Scene&)>& change = {}) {
    Scene scene = loadScene(Configs + c.scene + ".json");
    scene.compute.backend = Backend::Cpu;
    c.adjust(scene, resolution);
    if (change) change(scene);
    checkScene(scene, c.name);
    return validate(c, scene, resolution);
}

TEST_P(Validation, MeetsItsTargets) {
    const ValidationCase& c = GetParam();
    if (c.quick.empty()) GTEST_SKIP() << "takes minutes: spindrift validate " << c.name;
    std::vector<double> errors;
    for (int resolution : c.quick) {
        const ValidationRun run = runAt(c, resolution);
        EXPECT_FALSE(run.chart.curves.empty());
        for (const Metric& m : run.metrics) {
            EXPECT_TRUE(std::isfinite(m.value)) << m.name;
            EXPECT_LE(std::abs(m.value), m.target.value_or(1e9)) << m.name << " at " << resolution;
        }
        errors.push_back(run.metrics[0].value);
        std::printf("%s at %d: %s %.3g %s\n", c.name.c_str(), resolution,
                    run.metrics[0].name.c_str(), errors.back(), run.metrics[0].unit.c_str());
    }
    // Where two resolutions are run, the error falls: 1.5 for flows between plates and sound, 1 for
    // Taylor-Green and on uneven particles.
    const double order = errors.size() == 2 ? std::log2(errors[0] / errors[1]) : 9;
    EXPECT_GT(order, c.name.starts_with("taylor") || c.name == "operators" ? 1.0 : 1.5);
}

std::string nameOf(const testing::TestParamInfo<ValidationCase>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Cases, Validation, testing::ValuesIn(validationCases(Configs + "data")),
                         nameOf);

const ValidationCase& caseNamed(const std::string& name) {
    static const std::vector<ValidationCase> all = validationCases(Configs + "data");
    for (const ValidationCase& c : all)
        if (c.name == name) return c;
    throw std::runtime_error(name);
}

// Coarse, but below what the stored results of other programs reach with four times the particles
// (0.5 and 0.9 %).
TEST(ValidationFigures, CavityAt25) {
    const ValidationRun run = runAt(caseNamed("cavity_re100"), 25);
    EXPECT_LT(run.metrics[0].value, 0.7);
    EXPECT_LT(run.metrics[1].value, 1.0);
}

// Ten periods with 15 particles along the radius. Plain delta_sph has 2.5 %, -0.9 % and -26 %.
TEST(ValidationFigures, DropAt15) {
    const ValidationRun run = runAt(caseNamed("drop"), 15);
    EXPECT_LT(run.metrics[0].value, 1.5);             // semi-axis, % of R
    EXPECT_LT(std::abs(run.metrics[1].value), 0.65);  // period, %
    EXPECT_GT(run.metrics[2].value, -19);             // energy, %
    EXPECT_LE(run.metrics[2].value, 0);
    EXPECT_LT(run.metrics[3].value, 0.004);  // momentum / (M s0 R)
}

// The measure is not blind: a fluid with another viscosity is another flow.
TEST(ValidationFigures, NoticeAnotherViscosity) {
    const ValidationRun run =
        runAt(caseNamed("cavity_re100"), 25, [](Scene& s) { s.fluid.viscosity *= 1.2f; });
    EXPECT_GT(run.metrics[0].value, 0.9);
}

TEST(ValidationFigures, DivergedRunsHaveNoFigures) {
    const ValidationRun run = runAt(
        caseNamed("couette"), 20, [](Scene& s) { s.time.mode = TimeMode::Fixed, s.time.step = 1; });
    EXPECT_TRUE(run.diverged);
    for (const Metric& m : run.metrics) EXPECT_TRUE(std::isnan(m.value)) << m.name;
}

// Round ones and ones with edges, whatever steps are made of.
TEST(ValidationFigures, BodiesThatAccelerateFeelTheirAddedMassByAnyMethod) {
    auto wrong = [](const std::string& name, Formulation formulation, Integrator integrator) {
        return runAt(caseNamed(name), 5,
                     [&](Scene& s) {
                         s.simulation.formulation = formulation, s.time.integrator = integrator;
                     })
            .metrics[0]
            .value;
    };
    using enum Formulation;
    for (const std::string name : {"added_mass", "added_mass_square"})
        for (Formulation formulation : {DeltaSph, DeltaPlus, TransportVelocity})
            EXPECT_LT(std::abs(wrong(name, formulation, Integrator::SymplecticEuler)), 5)
                << name << int(formulation);
    for (Integrator integrator : {Integrator::VelocityVerlet, Integrator::PredictorCorrector})
        EXPECT_LT(std::abs(wrong("added_mass", DeltaSph, integrator)), 5) << int(integrator);
}

}  // namespace
}  // namespace spindrift
