// A run that is stopped and goes on is the run that is not stopped.
#include "measure/checkpoint.h"
#include "shell.h"

namespace spindrift {
namespace {

class Restart : public Shell {
protected:
    const std::string Run =
        "test/dam_break_small --headless --backend cpu --quiet --set output.checkpoint_every=0.02 ";
    Checkpoint read(const std::string& name) const {
        return readCheckpoint((folder_ / name).string());
    }
    static void expectSame(const Checkpoint& a, const Checkpoint& b) {
        EXPECT_EQ(a.state.particles.positions, b.state.particles.positions);
        EXPECT_EQ(a.state.particles.velocities, b.state.particles.velocities);
        EXPECT_EQ(a.state.clock.time, b.state.clock.time);
        EXPECT_EQ(a.state.clock.steps, b.state.clock.steps);
    }
};

TEST_F(Restart, GoesOnWithTheSameBitsForAnyNumberOfThreads) {
    ASSERT_EQ(call(Run + "--threads 2 --time 0.07 --checkpoint whole.h5").code, 0);
    ASSERT_EQ(call(Run + "--threads 2 --time 0.02 --checkpoint half.h5").code, 0);
    ASSERT_EQ(call("half.h5 --headless --quiet --threads 1 --time 0.07 --checkpoint rest.h5").code,
              0);
    expectSame(read("whole.h5"), read("rest.h5"));
    EXPECT_GE(read("rest.h5").state.clock.time, 0.07);
    EXPECT_LT(read("half.h5").state.clock.time, 0.03);
}

TEST_F(Restart, DensityThatIsCarriedGoesOnToo) {
    const std::string run =
        "validation/cavity --headless --backend cpu --quiet --set output.checkpoint_every=0.1 ";
    ASSERT_EQ(call(run + "--time 0.3 --checkpoint whole.h5").code, 0);
    ASSERT_EQ(call(run + "--time 0.1 --checkpoint half.h5").code, 0);
    ASSERT_EQ(call("half.h5 --headless --quiet --time 0.3 --checkpoint rest.h5").code, 0);
    expectSame(read("whole.h5"), read("rest.h5"));
    EXPECT_EQ(read("whole.h5").state.densities, read("rest.h5").state.densities);
    EXPECT_EQ(read("rest.h5").state.densities.size(), 2500u);
}

TEST_F(Restart, SolvedPressuresGoOnToo) {
    const std::string run = Run + "--set simulation.formulation=incompressible ";
    ASSERT_EQ(call(run + "--time 0.3 --checkpoint whole.h5").code, 0);
    ASSERT_EQ(call(run + "--time 0.1 --checkpoint half.h5").code, 0);
    ASSERT_EQ(call("half.h5 --headless --quiet --time 0.3 --checkpoint rest.h5").code, 0);
    expectSame(read("whole.h5"), read("rest.h5"));
    EXPECT_EQ(read("whole.h5").state.pressures, read("rest.h5").state.pressures);
    EXPECT_GT(read("rest.h5").state.pressures.size(), 0u);
}

TEST_F(Restart, FluidThatComesAndLeavesGoesOnToo) {
    const std::string run =
        "test/tap_small --headless --backend cpu --quiet --set output.checkpoint_every=0.1 ";
    ASSERT_EQ(call(run + "--threads 2 --time 0.3 --checkpoint whole.h5").code, 0);
    ASSERT_EQ(call(run + "--threads 2 --time 0.1 --checkpoint half.h5").code, 0);
    ASSERT_EQ(call("half.h5 --headless --quiet --threads 1 --time 0.3 --checkpoint rest.h5").code,
              0);
    const RunState whole = read("whole.h5").state, rest = read("rest.h5").state;
    expectSame(read("whole.h5"), read("rest.h5"));
    EXPECT_EQ(whole.particles.ids, rest.particles.ids);
    EXPECT_EQ(whole.particles.heldBy, rest.particles.heldBy);
    EXPECT_EQ(whole.densities, rest.densities);
    EXPECT_EQ(whole.sources.came, rest.sources.came);
    EXPECT_EQ(whole.sources.left, rest.sources.left);
    EXPECT_GT(rest.sources.came, read("half.h5").state.sources.came);
    EXPECT_GT(rest.sources.left, read("half.h5").state.sources.left);
}

TEST_F(Restart, SolidsGoOnFromWhereTheyAre) {
    const std::string run =
        "test/solids_small --headless --backend cpu --quiet --set output.checkpoint_every=0.05 ";
    ASSERT_EQ(call(run + "--time 0.15 --checkpoint whole.h5").code, 0);
    ASSERT_EQ(call(run + "--time 0.05 --checkpoint half.h5").code, 0);
    ASSERT_EQ(call("half.h5 --headless --quiet --threads 1 --time 0.15 --checkpoint rest.h5").code,
              0);
    expectSame(read("whole.h5"), read("rest.h5"));
    EXPECT_EQ(read("rest.h5").state.particles.solidSizes.size(), 3u);
}

// The end of a run as the start of another one; a checkpoint of that has its own particles and
// needs the file no more.
TEST_F(Restart, ParticlesOfOneRunBeginAnother) {
    const std::string tank =
        "dam_break --headless --backend cpu --quiet --set simulation.spacing=0.04 --set "
        "simulation.formulation=delta_sph ";
    for (const std::string end : {"end.csv", "end.h5"}) {
        ASSERT_EQ(
            call(tank + "--steps 20 --set output.particles=" + end + " --checkpoint first.h5").code,
            0);
        const Outcome next =
            call(tank + "--steps 1 --set 'fluid.bodies=[{\"shape\":\"file\",\"path\":\"" + end +
                 "\"}]' --checkpoint next.h5");
        ASSERT_EQ(next.code, 0) << next.text;
        const Outcome same = call("first.h5 --headless --quiet --steps 21 --checkpoint went_on.h5");
        ASSERT_EQ(same.code, 0) << same.text;
        const Checkpoint a = read("went_on.h5"), b = read("next.h5");
        ASSERT_EQ(a.state.particles.positions.size(), b.state.particles.positions.size());
        double apart = 0;
        for (size_t i = 0; i < a.state.particles.positions.size(); ++i)
            apart = std::max<double>(
                apart, length(a.state.particles.positions[i] - b.state.particles.positions[i]));
        EXPECT_LT(apart, 1e-4)
            << "the speed of sound, and with it the step, is that of another start";
        fs::remove(folder_ / end);
        EXPECT_EQ(call("next.h5 --headless --quiet --steps 2").code, 0) << "needs the file still";
    }
    expectMistake(
        tank + "--steps 1 --set 'fluid.bodies=[{\"shape\":\"file\",\"path\":\"gone.csv\"}]'",
        Exit::Scene, "gone.csv: no such file");
}

TEST_F(Restart, EveryIntegratorGoesOn) {
    for (const char* scene :
         {"test/dam_break_small", "test/solids_small", "validation/taylor_green"})
        for (const char* integrator : {"velocity_verlet", "predictor_corrector"}) {
            const std::string run =
                std::string(scene) +
                " --headless --backend cpu --quiet --set output.checkpoint_every=0.02 "
                "--set time.integrator=" +
                integrator;
            ASSERT_EQ(call(run + " --time 0.06 --checkpoint whole.h5").code, 0);
            ASSERT_EQ(call(run + " --time 0.02 --checkpoint half.h5").code, 0);
            ASSERT_EQ(call("half.h5 --headless --quiet --time 0.06 --checkpoint rest.h5").code, 0);
            expectSame(read("whole.h5"), read("rest.h5"));
            EXPECT_EQ(read("whole.h5").state.densities, read("rest.h5").state.densities);
        }
}

TEST_F(Restart, LiveKnobsMayChangeOthersNot) {
    ASSERT_EQ(call(Run + "--steps 5 --checkpoint a.h5").code, 0);
    EXPECT_EQ(call("a.h5 --headless --quiet --steps 7 --set fluid.viscosity=0.2").code, 0);
    expectMistake("a.h5 --headless --steps 2 --set simulation.spacing=0.5", Exit::Usage,
                  "simulation.spacing: can't be changed in a run that has begun");
    expectMistake("explain a.h5", Exit::Scene, "is a checkpoint; here a scene is wanted");
    std::ofstream(folder_ / "broken.h5", std::ios::binary)
        << slurp(folder_ / "a.h5").substr(0, 3000);
    expectMistake("broken.h5 --headless", Exit::Scene, "the checkpoint is damaged or incomplete");
}

TEST_F(Restart, SignalsEndTheRunWithItsOutputs) {
    for (const auto& [signal, code] : {std::pair{"TERM", 143}, {"INT", 130}}) {
        const std::string command =
            "cd '" + folder_.string() + "' && { '" SPINDRIFT_PROGRAM "' " + Run +
            "--time 30 --csv run.csv --checkpoint stopped.h5 2>said & } && sleep 2 && kill -" +
            signal + " $! && wait $!";
        const int status = std::system(command.c_str());
        EXPECT_EQ(WEXITSTATUS(status), code) << signal;
        EXPECT_NE(slurp(folder_ / "said").find("stopped by a signal after"), std::string::npos)
            << slurp(folder_ / "said");
        EXPECT_GT(read("stopped.h5").state.clock.steps, 0);
        EXPECT_GT(slurp(folder_ / "run.csv").size(), 200u);
        fs::remove(folder_ / "stopped.h5");
    }
}

}  // namespace
}  // namespace spindrift
