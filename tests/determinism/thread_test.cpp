// One answer for any number of threads, and for any two runs: bit by bit.
#include "determinism/hash.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

uint64_t hashAfter(const std::string& file, int threads, int steps, int change = 0,
                   Integrator integrator = {}, TimeMode mode = TimeMode::Cfl) {
    Scene scene = loadConfig(file, {});
    scene.compute.threads = threads;
    scene.time.integrator = integrator;
    if (mode == TimeMode::Local) scene.time.mode = mode;
    scene.simulation.gravity.x += 1e-3f * float(change);
    return spindrift::hashAfter(scene, steps);
}

class Threads : public testing::TestWithParam<const char*> {};

TEST_P(Threads, SameBitsForOneTwoAndThreeThreads) {
    const uint64_t one = hashAfter(GetParam(), 1, 200);
    EXPECT_EQ(one, hashAfter(GetParam(), 2, 200));
    EXPECT_EQ(one, hashAfter(GetParam(), 3, 200));
    EXPECT_EQ(one, hashAfter(GetParam(), 1, 200));
    EXPECT_NE(one, hashAfter(GetParam(), 1, 200, 1)) << "the hash does not notice another flow";
}

TEST(Determinism, SameBitsWithEachIntegrator) {
    for (const char* file : {"test/dam_break_small.json", "validation/cavity.json"})
        for (Integrator i : {Integrator::VelocityVerlet, Integrator::PredictorCorrector}) {
            const uint64_t one = hashAfter(file, 1, 60, 0, i);
            EXPECT_EQ(one, hashAfter(file, 3, 60, 0, i)) << file;
            EXPECT_NE(one, hashAfter(file, 1, 60)) << "the integrator makes no difference";
        }
}

TEST(Determinism, SameBitsWithLocalSteps) {
    for (const char* file : {"test/dam_break_small.json", "test/ball_drop_small.json",
                             "test/solids_small.json", "test/mesh_small.json"}) {
        const uint64_t one = hashAfter(file, 1, 200, 0, {}, TimeMode::Local);
        EXPECT_EQ(one, hashAfter(file, 3, 200, 0, {}, TimeMode::Local)) << file;
        EXPECT_NE(one, hashAfter(file, 1, 200)) << "local steps make no difference";
    }
}

// Pairs once or from both sides, lists or rows of cells: no pass reads of its neighbours what it
// writes itself.
TEST(Determinism, SameBitsWithEachFormulationAndPrecision) {
    for (const char* precision : {"compute.precision=float", "compute.precision=double"})
        for (const char* formulation : {"wcsph", "delta_sph", "delta_plus", "incompressible"})
            for (const char* file : {"test/dam_break_small.json", "test/solids_small.json"}) {
                Scene scene = loadConfig(
                    file, {precision, std::string("simulation.formulation=") + formulation});
                const auto after = [&](int threads) {
                    scene.compute.threads = threads;
                    return spindrift::hashAfter(scene, 12);
                };
                const uint64_t one = after(1);
                for (const int threads : {2, 3})
                    EXPECT_EQ(one, after(threads))
                        << precision << " " << formulation << " " << file << " " << threads;
            }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Threads,
                         testing::Values("test/dam_break_small.json", "test/ball_drop_small.json",
                                         "test/historical_small.json",
                                         "validation/hydrostatic.json", "validation/cavity.json",
                                         "test/solids_small.json", "test/mesh_small.json",
                                         "test/floating_small.json", "test/artery_small.json",
                                         "test/tap_small.json"));

}  // namespace
}  // namespace spindrift
