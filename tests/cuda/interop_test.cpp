// Vertices that a kernel writes into the GL buffer make the picture that copied vertices make.
#include "app/frame.h"
#include "core/error.h"
#include "cuda/gpu.h"
#include "render/egl_context.h"
#include "render/cuda_interop.h"
#include "sim/make_simulation.h"
#ifdef SPINDRIFT_EMULATED_GPU
#include "emulation.h"
#endif

#include <algorithm>
#include <cstdio>

namespace spindrift {
namespace {

class Interop : public testing::Test {
protected:
    void SetUp() override {
        NEED_GPU();
        static EglContext context(0);
        static const int said = std::printf("OpenGL: %s\n", glName().c_str());
        EXPECT_GT(said, 0);
        if (drawingDevice() != 0)
            GTEST_SKIP() << "skipped: OpenGL (" << glName() << ") draws elsewhere";
        scene.compute.backend = Backend::Cuda;
        scene.compute.device = 0;
        simulation = makeSimulation(scene);
    }
#ifdef SPINDRIFT_EMULATED_GPU
    // A picture of copied vertices; that of vertices written in place is the same.
    void expectCopied(Frame& frame) {
        EXPECT_TRUE(frame.copiesVertices());
        const Image copied = frame.image();
        emulation::machine = {};
        Frame direct(200, 150, 1);
        direct.update(*simulation, scene);
        direct.draw(scene);
        EXPECT_EQ(copied, direct.image());
    }
#endif
    Scene scene = testScene("dam_break_small.json");
    std::unique_ptr<Simulation> simulation;
};

// A GPU's run that says it is the CPU's: its vertices go through the host.
class ThroughHost final : public Simulation {
public:
    explicit ThroughHost(Simulation& s) : s_(s) {}
    int cudaDevice() const override { return hostMemory; }
    void* cudaStream() const override { return nullptr; }
    Range writeVertices(VertexMemory out, ColorBy by, int walls) override {
        EXPECT_EQ(out.device, hostMemory);
        return s_.writeVertices(out, by, walls);
    }
    void step(int n) override { s_.step(n); }
    void apply(const Scene& scene) override { s_.apply(scene); }
    void stir(const Stir& stir) override { s_.stir(stir); }
    void hold(const Hold& hold) override { s_.hold(hold); }
    std::vector<SolidPose> solidPoses() override { return s_.solidPoses(); }
    int solidAt(Vec3d point) override { return s_.solidAt(point); }
    void drive(ObjectDriver* driver) override { s_.drive(driver); }
    void stopAt(double time) override { s_.stopAt(time); }
    int fluidCount() override { return s_.fluidCount(); }
    int wallCount() const override { return s_.wallCount(); }
    int solidParticleCount() const override { return s_.solidParticleCount(); }
    int objectParticleCount() const override { return s_.objectParticleCount(); }
    StepState clock() override { return s_.clock(); }
    bool hasReached(double time) override { return s_.hasReached(time); }
    Measurement measure() override { return s_.measure(); }
    std::vector<Particle> particles() override { return s_.particles(); }
    std::optional<Particle> find(int id) override { return s_.find(id); }
    Particle particle(int id) override { return s_.particle(id); }
    RunState state() override { return s_.state(); }
    void restart(const RunState& state) override { s_.restart(state); }
    std::vector<PassTime> times() override { return s_.times(); }
    void resetTimes() override { s_.resetTimes(); }
    std::vector<double> timeSteps(int n) override { return s_.timeSteps(n); }
    void wait() override { s_.wait(); }
    PairsSeen pairsSeen() override { return s_.pairsSeen(); }
    std::vector<PlanRow> plan() const override { return s_.plan(); }
    int64_t bytes() const override { return s_.bytes(); }
    std::string deviceName() const override { return s_.deviceName(); }

private:
    Simulation& s_;
};

TEST_F(Interop, PictureEqualsThatOfTheCopyPixelForPixel) {
    for (ColorBy by : {ColorBy::Velocity, ColorBy::Pressure}) {
        Frame direct(320, 240, 1);  // as new as the other: legends say what a frame has seen
        scene.view.colorBy = by;
        scene.view.showWalls = by == ColorBy::Pressure;
        simulation->step(15);
        direct.update(*simulation, scene);
        EXPECT_FALSE(direct.copiesVertices());
        direct.draw(scene);
        ThroughHost copying(*simulation);
        Frame copied(320, 240, 1);
        copied.update(copying, scene);
        copied.draw(scene);
        EXPECT_EQ(direct.image(), copied.image());
    }
}

TEST_F(Interop, BufferGrowsAndShrinksWithTheScene) {
    Frame frame(200, 150, 1);
    for (float spacing : {1.0f, 0.8f, 1.2f, 0.7f}) {
        Scene other = scene;
        other.simulation.spacing *= spacing;
        const auto s = makeSimulation(other);
        s->step(2);
        frame.update(*s, other);
        frame.draw(other);
        EXPECT_FALSE(frame.copiesVertices());
    }
}

#ifdef SPINDRIFT_EMULATED_GPU
TEST_F(Interop, RegistersOnceAndMapsOncePerFrame) {
    Frame frame(200, 150, 1);
    frame.update(*simulation, scene);
    const emulation::Counts before = emulation::counts;
    for (int k = 0; k < 10; ++k) {
        simulation->step();
        frame.update(*simulation, scene);
        frame.draw(scene);
        frame.draw(scene);  // looked at again: nothing is mapped
    }
    EXPECT_EQ(emulation::counts.registrations, before.registrations);
    EXPECT_EQ(emulation::counts.maps - before.maps, 10);
    scene.view.showWalls = true;  // more vertices
    frame.update(*simulation, scene);
    EXPECT_EQ(emulation::counts.registrations, before.registrations + 1);
}

// After steps that have been waited for: the range of what is shown, and how it is spread.
TEST_F(Interop, APictureIsWaitedForOnce) {
    for (const char* file : {"dam_break_small.json", "solids_small.json", "floating_small.json",
                             "tap_small.json", "artery_small.json"}) {
        SCOPED_TRACE(file);
        Scene other = testScene(file);
        other.compute.backend = Backend::Cuda;
        const auto run = makeSimulation(other);
        Frame frame(200, 150, 1);
        for (int k = 0; k < 4; ++k) run->step(), frame.update(*run, other);
        for (ColorBy by : {ColorBy::Plain, ColorBy::Velocity, ColorBy::Density}) {
            other.view.colorBy = by;
            run->step();
            run->wait();
            const emulation::Counts c =
                emulation::countsOf([&] { frame.update(*run, other), frame.draw(other); });
            EXPECT_EQ(c.waits, 1);
            EXPECT_EQ(emulation::countsOf([&] { run->step(4); }).waits, 0);
        }
    }
}

TEST_F(Interop, WhereGlRunsElsewhereVerticesAreCopied) {
    emulation::machine.drawsToo = false;
    Frame frame(200, 150, 1);
    simulation->step(3);
    frame.update(*simulation, scene);
    frame.draw(scene);
    expectCopied(frame);
}

// CUDA may say that its device draws and refuse the buffer all the same.
TEST_F(Interop, WhereCudaRefusesTheBufferVerticesAreCopiedAndThatIsSaidOnce) {
    emulation::machine.sharesMemory = false;
    Frame frame(200, 150, 1);
    simulation->step(3);
    testing::internal::CaptureStderr();
    for (int k = 0; k < 3; ++k) frame.update(*simulation, scene), frame.draw(scene);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("do not share their memory"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    expectCopied(frame);
}

TEST_F(Interop, ALostDeviceLeavesNothingMapped) {
    Frame frame(200, 150, 1);
    frame.update(*simulation, scene);
    emulation::machine.lost = true;
    EXPECT_THROW(frame.update(*simulation, scene), Error);
    EXPECT_NO_THROW(frame.draw(scene));
    emulation::machine = {};
}
#endif

}  // namespace
}  // namespace spindrift
