// Each shipped scene survives somebody who drags its solids and stirs its fluid at random, through
// the calls that the mouse makes.
#include "measure/handled.h"
#include "measure/stress.h"
#include "scene/json.h"
#include "scene/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> shippedScenes() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(SPINDRIFT_SOURCE_DIR "/configs"))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
}

// A coarse one of the same scene. Those of the original program say what a particle weighs, and the
// wall of the artery is as fine as its fluid.
Scene coarse(const std::string& name) {
    const bool small = name == "artery";
    Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR "/configs/") +
                            (small ? "test/artery_small" : name) + ".json");
    scene.compute.backend = Backend::Cpu;
    scene.compute.threads = 1;
    if (scene.simulation.formulation != Formulation::Classic && !small)
        while (countParticles(scene).fluid > 4000) scene.simulation.spacing *= 1.25f;
    return scene;
}

class Handled : public testing::TestWithParam<std::string> {};

TEST_P(Handled, AtRandom) {
    for (const uint64_t seed : {1, 2}) {
        const StressResult r = handle(coarse(GetParam()), seed, 1);
        std::printf("%d particles, %lld steps, %.3g s, fastest %.3g m/s, density %.1f %%\n",
                    r.particles, static_cast<long long>(r.steps), r.time, r.speed, 100 * r.density);
        EXPECT_EQ(r.what, "") << "from seed " << seed << " after " << r.time << " s";
        EXPECT_EQ(r.verdict, Verdict::Sound);
    }
}

// What the judge says when the first particle is somewhere else, m from the domain's corner, or
// faster.
std::string judged(const Scene& scene, Vec3 place, Vec3 velocity) {
    const auto sound = makeSimulation(scene);
    HandlingJudge judge(scene, *sound);
    RunState state = sound->state();
    state.particles.positions[0] = place, state.particles.velocities[0] = velocity;
    return judge.look(*makeSimulation(scene, state), 1);
}

TEST(HandlingJudge, SeesWhatIsWrong) {
    const Scene artery = coarse("artery");
    const Vec3 inside{0.08f, 0.03f, 0.06f}, beside{0.08f, 0.03f, 0.1f}, inPlug{0.01f, 0.03f, 0.06f};
    EXPECT_EQ(judged(artery, inside, {0, 0, 0}), "");
    const std::pair<std::string, const char*> cases[] = {
        {judged(artery, inside, {62, 0, 0}), "a particle at 62 m/s"},
        {judged(artery, beside, {0, 0, 0}), "1 particles went through the wall of a tube, 0"},
        {judged(artery, inPlug, {0, 0, 0}), "spacings in solid 0"}};
    for (const auto& [said, words] : cases) EXPECT_NE(said.find(words), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Handled, testing::ValuesIn(shippedScenes()),
                         [](const auto& info) { return "Scene_" + info.param; });

}  // namespace
}  // namespace spindrift
