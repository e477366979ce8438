// What the window offers to a run that can't keep up, and that runs go on soundly with it.
#include "app/window/remedies.h"

#include "app/window/player.h"
#include "scene/formulation.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace spindrift {
namespace {

Scene shipped(const std::string& name) {
    Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/" + name + ".json");
    scene.compute.backend = Backend::Cpu;
    return scene;
}

const Remedy* find(const std::vector<Remedy>& all, Remedy::How how) {
    for (const Remedy& remedy : all)
        if (remedy.how == how) return &remedy;
    return nullptr;
}

TEST(Remedies, AreThoseThatTheSceneCanHave) {
    struct Expected {
        const char* scene;
        bool solves, coarser;
    };
    for (const auto& [name, solves, coarser] :
         {Expected{"still_pool", true, true},
          Expected{"dam_break", false, true},      // is solved for pressures already
          Expected{"wave_maker", true, false},     // the gap above its piston would be too small
          Expected{"artery", false, true},         // has elastic objects
          Expected{"oil_and_water", false, true},  // has two fluids
          Expected{"poiseuille", false, true},     // is full of fluid
          Expected{"1", false, true}}) {
        SCOPED_TRACE(name);
        const Scene scene = shipped(name);
        const auto all = remediesFor(scene, false);
        const Remedy* goOn = find(all, Remedy::How::GoOn);
        ASSERT_EQ(goOn != nullptr, solves);
        EXPECT_EQ(find(all, Remedy::How::Again) != nullptr, coarser);
        EXPECT_EQ(find(all, Remedy::How::Live) != nullptr, factsOf(scene).solvesPressure)
            << "a preview has larger errors of what is solved for";
        EXPECT_EQ(find(remediesFor(scene, true), Remedy::How::Again), nullptr)
            << "a checkpoint's run can't begin anew";
        if (!goOn) continue;
        const auto next = remediesFor(goOn->scene, false);
        EXPECT_EQ(find(next, Remedy::How::GoOn), nullptr) << "it is there already";
        const Remedy* preview = find(next, Remedy::How::Live);
        ASSERT_NE(preview, nullptr);
        EXPECT_EQ(find(remediesFor(preview->scene, false), Remedy::How::Live), nullptr);
    }
}

// What would be wrong there is not offered.
TEST(Remedies, BringNoRemark) {
    Scene scene = shipped("test/still_pool_small");
    EXPECT_NE(find(remediesFor(scene, false), Remedy::How::GoOn), nullptr);
    scene.fluid.bodies = {Body{{.min = scene.domain.min, .max = scene.domain.max}}};
    EXPECT_EQ(find(remediesFor(scene, false), Remedy::How::GoOn), nullptr) << "no free surface";
    scene.simulation.spacing = 0.4f * scene.domain.size().y;
    EXPECT_EQ(find(remediesFor(scene, false), Remedy::How::Again), nullptr) << "too few spacings";
}

TEST(Remedies, HalveTheParticles) {
    for (const char* name : {"dam_break", "still_pool", "test/still_pool_small"}) {
        const Scene scene = shipped(name);
        const auto all = remediesFor(scene, false);
        const Remedy* coarser = find(all, Remedy::How::Again);
        ASSERT_NE(coarser, nullptr);
        const double left =
            double(countParticles(coarser->scene).fluid) / double(countParticles(scene).fluid);
        EXPECT_NEAR(left, 0.5, 0.12) << name;
    }
}

TEST(Remedies, NameWhatTakesTheTime) {
    EXPECT_EQ(slowestPasses({}), "");
    EXPECT_EQ(slowestPasses({{"sort", 1, 4}, {"forces", 6, 4}, {"density", 3, 4}}),
              "forces 60 %, density 30 %");
    EXPECT_EQ(slowestPasses({{"sort", 0, 0}}), "");
}

// Wherever a run stands when the button is pressed: no particle jumps, no energy comes.
TEST(Remedies, RunsGoOnAndSolveForPressures) {
    for (const char* name : {"test/dam_break_small", "test/solids_small", "test/floating_small",
                             "test/ball_drop_small", "test/still_pool_small", "test/mesh_small"})
        for (const char* formulation : {"wcsph", "delta_sph", "delta_plus"}) {
            SCOPED_TRACE(testing::Message() << name << " " << formulation);
            Scene scene = shipped(name);
            setKnob(scene, std::string("simulation.formulation=") + formulation);
            const auto all = remediesFor(scene, false);
            const Remedy* goOn = find(all, Remedy::How::GoOn);
            ASSERT_NE(goOn, nullptr);
            auto before = makeSimulation(scene);
            before->step(60);
            const Measurement a = before->measure();
            auto after = makeSimulation(goOn->scene, before->state());
            const Measurement b = after->measure();
            EXPECT_EQ(b.steps, a.steps);
            EXPECT_NEAR(b.kineticEnergy, a.kineticEnergy, 1e-4 * a.kineticEnergy);
            EXPECT_NEAR(b.centerOfMass.y, a.centerOfMass.y, 1e-6);
            after->step(40);
            const Measurement c = after->measure();
            EXPECT_TRUE(c.finite);
            EXPECT_LT(c.densityError, 0.01);
            const double most = a.kineticEnergy + a.potentialEnergy;
            if (scene.solids.empty()) {
                EXPECT_LT(c.kineticEnergy + c.potentialEnergy, most + 0.01 * std::abs(most));
            }
            const double fall = std::sqrt(2 * 9.81 * double(scene.domain.size().y));
            EXPECT_LT(c.maxSpeed, a.maxSpeed + fall);
        }
}

TEST(Remedies, ThePlayerTakesThem) {
    Scene scene = shipped("test/dam_break_small");
    Player player(Loader([&] { return Start{scene, {}}; }).take());
    const auto play = [&](int64_t steps) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (std::chrono::steady_clock::now() < end) {
            bool moved = false;
            if (player.collect(moved)) {
                if (player.measurement().steps >= steps) return true;
                player.proceed(0.005);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    };
    ASSERT_TRUE(play(30));
    const double before = player.measurement().time;
    player.goOnWith(Formulation::Incompressible, Backend::Cpu);
    EXPECT_TRUE(player.measurement().solvesPressure);
    EXPECT_EQ(player.loadedScene().simulation.formulation, Formulation::Wcsph);
    ASSERT_TRUE(play(60));
    EXPECT_GT(player.measurement().time, before);
    EXPECT_GT(player.measurement().solve.iterations, 0);
    Scene coarser = find(remediesFor(player.scene, false), Remedy::How::Again)->scene;
    const int many = player.simulation().fluidCount();
    player.beginAnew(coarser);
    while (!player.takeLoaded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_LT(player.simulation().fluidCount(), 0.7 * many);
    EXPECT_EQ(player.measurement().steps, 0);
    EXPECT_EQ(player.loadedScene().simulation.spacing, coarser.simulation.spacing);
}

// What is outside of what a formulation is valid for is said as soon as it is in force.
TEST(Remedies, RemarksAreThoseOfTheFormulation) {
    Scene scene = shipped("test/still_pool_small");
    scene.fluid.bodies = {Body{{.min = scene.domain.min, .max = scene.domain.max}}};
    Player player(Loader([&] { return Start{scene, {}}; }).take());
    const auto saysSo = [&] {
        for (const Remark& r : player.remarks())
            if (r.text.find("use transport_velocity") != std::string::npos) return true;
        return false;
    };
    EXPECT_FALSE(saysSo());
    player.goOnWith(Formulation::Incompressible, Backend::Cpu);
    EXPECT_TRUE(saysSo());
    player.goOnWith(Formulation::Wcsph, Backend::Cpu);
    EXPECT_FALSE(saysSo());
}

}  // namespace
}  // namespace spindrift
