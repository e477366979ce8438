// The historical files reproduce the flow that they were tuned for.
#include "physics/classic_reference.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

void expectSameFlow(const std::string& file, Precision precision, int steps) {
    Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/" + file);
    scene.compute.precision = precision;
    scene.compute.threads = 0;
    reference::Classic reference(scene, placeParticles(scene));
    auto simulation = makeSimulation(scene);
    double largestEnergy = 0;
    for (int k = 0; k < steps; ++k) {
        reference.step();
        simulation->step();
        largestEnergy = std::max(largestEnergy, reference.kineticEnergy());
        if (k % 20 != 19) continue;
        const Measurement m = simulation->measure();
        EXPECT_NEAR(m.meanDensity, reference.meanDensity(), 0.01 * reference.meanDensity()) << file << " step " << k;
        EXPECT_NEAR(m.kineticEnergy, reference.kineticEnergy(), 0.01 * largestEnergy) << file << " step " << k;
        EXPECT_LT(length(m.centerOfMass - reference.centerOfMass()), 0.01 * length(reference.centerOfMass()))
            << file << " step " << k;
    }
    EXPECT_GT(largestEnergy, 0);
}

TEST(Classic, HistoricalFile1MatchesReferenceFor300Steps) { expectSameFlow("1.json", Precision::Float, 300); }
TEST(Classic, HistoricalFile2MatchesReferenceFor300Steps) { expectSameFlow("2.json", Precision::Float, 300); }
TEST(Classic, HistoricalFile3MatchesReferenceFor300Steps) { expectSameFlow("3.json", Precision::Float, 300); }

// In double precision the same source follows the reference particle by particle until chaos sets in.
TEST(Classic, DoubleInstanceFollowsReferenceParticleByParticle) {
    Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/1.json");
    scene.compute.precision = Precision::Double;
    reference::Classic reference(scene, placeParticles(scene));
    auto simulation = makeSimulation(scene);
    for (int k = 0; k < 100; ++k) reference.step();
    simulation->step(100);
    const std::vector<Particle> particles = simulation->particles();
    double worst = 0, worstDensity = 0;
    for (size_t i = 0; i < particles.size(); ++i) {
        worst = std::max(worst, length(particles[i].position - reference.x[i]));
        worstDensity = std::max(worstDensity, std::abs(particles[i].density - reference.rho[i]));
    }
    EXPECT_LT(worst, 1e-6 * scene.domain.max.x);
    EXPECT_LT(worstDensity, 1e-4 * scene.fluid.restDensity);
}

}  // namespace
}  // namespace spindrift
