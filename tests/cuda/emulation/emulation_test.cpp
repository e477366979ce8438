// What only an emulated GPU can show: failing drivers, lost devices, the order of threads, and what
// is done how often.
#include "app/frame_bench.h"
#ifdef SPINDRIFT_WINDOW
#include "app/window/player.h"
#endif
#include "core/error.h"
#include "cuda/gpu.h"
#include "device/cuda.h"
#include "emulation.h"
#include "sim/make_simulation.h"

#include <algorithm>

namespace spindrift {
namespace {

class EmulatedGpu : public testing::Test {
protected:
    void TearDown() override { emulation::machine = {}; }
    static std::unique_ptr<Simulation> start(const Scene& s) {
        return makeCudaSimulation(s, placeParticles(s), 0);
    }
    Scene scene = testScene("dam_break_small.json");
};

void expectError(const Scene& scene, Failure failure, const std::string& words) {
    try {
        makeSimulation(scene)->step();
        FAIL() << "no error: " << words;
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, failure) << error.what();
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST_F(EmulatedGpu, EveryWayToHaveNoGpuIsOneLine) {
    scene.compute.backend = Backend::Cuda;
    emulation::machine.driver = 0;
    expectError(scene, Failure::NoDevice, "no NVIDIA driver");
    emulation::machine.driver = 12040;
    expectError(scene, Failure::NoDevice, "knows CUDA 12.4, this program needs 13.0");
    emulation::machine = {};
    emulation::machine.devices = 0;
    expectError(scene, Failure::NoDevice, "no CUDA device");
    emulation::machine = {};
    emulation::machine.codeFits = false;
    expectError(scene, Failure::NoDevice, "SPINDRIFT_CUDA_ARCHITECTURES=90");
    emulation::machine = {};
    scene.compute.device = 1;
    expectError(scene, Failure::NoDevice, "no CUDA device 1; there are 1");
    scene.compute.device = 0;
    scene.compute.precision = Precision::Double;
    expectError(scene, Failure::NoDevice, "double precision");
}

TEST_F(EmulatedGpu, AutoTakesTheGpuWhenThereIsOne) {
    EXPECT_EQ(makeSimulation(scene)->deviceName(), "emulated GPU, CUDA, float");
    emulation::machine.devices = 0;
    EXPECT_EQ(makeSimulation(scene)->deviceName().substr(0, 3), "CPU");
    emulation::machine = {};
    emulation::machine.memory = 1 << 20;  // too little for the scene
    EXPECT_EQ(makeSimulation(scene)->deviceName().substr(0, 3), "CPU");
    emulation::machine = {};
    scene.compute.precision = Precision::Double;
    EXPECT_EQ(makeSimulation(scene)->deviceName().substr(0, 3), "CPU");
}

TEST_F(EmulatedGpu, ALostDeviceIsOneLineAndNothingHangs) {
    const auto gpu = start(scene);
    gpu->step(5);
    emulation::machine.lost = true;
    try {
        gpu->step(), gpu->measure();
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::DeviceLost);
        EXPECT_NE(std::string(error.what()).find("the GPU was lost"), std::string::npos)
            << error.what();
    }
}

TEST_F(EmulatedGpu, MemoryThatRunsOutInTheMiddleIsAnError) {
    const double needed = double(start(scene)->bytes());
    for (double share : {0.0, 0.2, 0.5, 0.7, 0.8, 0.9, 0.99}) {
        emulation::machine.memory = size_t(share * needed);
        try {
            start(scene);
            FAIL() << share;
        } catch (const Error& error) { EXPECT_EQ(error.failure, Failure::Memory) << error.what(); }
    }
    emulation::machine = {};
    EXPECT_NO_THROW(start(scene)->step());
}

TEST_F(EmulatedGpu, OrderOfThreadsDoesNotMatter) {
    for (const char* file : {"dam_break_small.json", "historical_small.json"}) {
        const Scene s = testScene(file);
        std::vector<RunState> ends;
        for (bool reversed : {false, true}) {
            emulation::machine.reversed = reversed;
            const auto gpu = start(s);
            gpu->step(20);
            ends.push_back(gpu->state());
            ends.back().clock.time = gpu->measure().kineticEnergy;
        }
        EXPECT_EQ(ends[0].particles.positions, ends[1].particles.positions) << file;
        EXPECT_EQ(ends[0].particles.velocities, ends[1].particles.velocities) << file;
        EXPECT_EQ(ends[0].clock.time, ends[1].clock.time) << file;
    }
}

TEST_F(EmulatedGpu, StepsAreRecordedOnceAndAllocateNothing) {
    const auto gpu = start(scene);
    gpu->step(1);  // measured pass by pass
    const emulation::Counts before = emulation::counts;
    gpu->step(50);
    gpu->measure();
    const emulation::Counts after = emulation::counts;
    EXPECT_EQ(after.recordings - before.recordings, 2) << "one for each side of the buffers";
    EXPECT_EQ(after.instantiations - before.instantiations, 2);
    EXPECT_EQ(after.replays - before.replays, 50);
    EXPECT_EQ(after.allocations, before.allocations);
    scene.simulation.gravity.x = 1;
    gpu->apply(scene);
    gpu->step(50);
    EXPECT_EQ(emulation::counts.recordings - after.recordings, 2);
    EXPECT_EQ(emulation::counts.instantiations, after.instantiations)
        << "the same passes with other constants";
}

TEST_F(EmulatedGpu, StepsDontWaitForTheHost) {
    const auto gpu = start(scene);
    gpu->step(3);
    gpu->wait();
    gpu->stopAt(1);
    const int64_t before = emulation::counts.kernels;
    for (int k = 0; k < 20; ++k) gpu->stopAt(1), gpu->step();  // as runs with rows do
    EXPECT_EQ(emulation::counts.kernels, before) << "something waited within a step";
    gpu->wait();
    EXPECT_GT(emulation::counts.kernels, before + 200);
}

// Nor does an iteration of the pressure solve: the device itself decides whether there is another.
TEST_F(EmulatedGpu, IterationsDontWaitForTheHost) {
    scene.simulation.formulation = Formulation::Incompressible;
    const auto gpu = start(scene);
    gpu->step(3);
    int64_t iterations = 0;
    for (int k = 0; k < 10; ++k) {
        gpu->wait();
        const emulation::Counts before = emulation::counts;
        gpu->step();
        EXPECT_EQ(emulation::counts.kernels, before.kernels) << "something waited within a step";
        gpu->wait();
        const int64_t repeats = emulation::counts.repeats - before.repeats;
        EXPECT_EQ(repeats, gpu->measure().solve.iterations);
        iterations += repeats;
    }
    EXPECT_GT(iterations, 15) << "too few iterations to show anything";
    scene.solver.iterations = 2;
    scene.solver.densityError = 1e-6;
    gpu->apply(scene);
    const int64_t before = emulation::counts.repeats, failures = gpu->measure().solve.failures;
    gpu->step(5);
    EXPECT_EQ(gpu->measure().solve.failures, failures + 5);
    EXPECT_EQ(emulation::counts.repeats, before + 10) << "as many as are allowed";
}

// The benchmark is run by hand only, where there is a GPU.
TEST_F(EmulatedGpu, BenchmarkOfFramesAndSwitchingWorks) {
    scene.compute.backend = Backend::Cuda;
    const nlohmann::json row = benchFrameAndSwitch(scene);
    EXPECT_EQ(row["vertices"], "written in place");
    for (const char* key : {"particles", "frame_ms", "switch_to_cpu_ms", "switch_back_ms"})
        EXPECT_GT(row[key], 0) << key;
}

#ifdef SPINDRIFT_WINDOW
TEST_F(EmulatedGpu, TheWindowPutsLocalStepsBack) {
    scene.compute.backend = Backend::Cuda;
    Start begin;
    begin.scene = scene;
    Player player({begin, makeSimulation(scene)});
    bool moved = false;
    ASSERT_TRUE(player.collect(moved));
    player.scene.time.mode = TimeMode::Local;
    player.knobsChanged();
    ASSERT_TRUE(player.collect(moved));
    EXPECT_EQ(player.scene.time.mode, scene.time.mode);
    EXPECT_NE(player.notice.find("local steps (time.mode)"), std::string::npos) << player.notice;
    EXPECT_EQ(player.halted, "");
    EXPECT_NO_THROW(player.goOnWith(scene.simulation.formulation, Backend::Cpu));
    player.scene.time.mode = TimeMode::Local;
    player.knobsChanged();
    ASSERT_TRUE(player.collect(moved));
    EXPECT_EQ(player.scene.time.mode, TimeMode::Local);
    EXPECT_THROW(player.goOnWith(scene.simulation.formulation, Backend::Cuda), Error);
    EXPECT_EQ(player.simulation().cudaDevice(), hostMemory) << "nothing has changed";
}
#endif

// What reads memory before it is written shows in every test.
TEST_F(EmulatedGpu, FreshMemoryIsNoNumber) {
    Cuda device(0);
    Buffer<float, Cuda> buffer(device);
    buffer.resize(100);
    for (const float x : buffer.download()) EXPECT_TRUE(std::isnan(x));
}

// The emulation itself: it must notice what it is there to notice.
using EmulatedGpuDeathTest = EmulatedGpu;
TEST_F(EmulatedGpuDeathTest, HostCantReadDeviceMemory) {
    void* memory = nullptr;
    ASSERT_EQ(cudaMalloc(&memory, 64), cudaSuccess);
    EXPECT_DEATH(std::printf("%d", *static_cast<volatile int*>(memory)), "");
    cudaFree(memory);
}
TEST_F(EmulatedGpuDeathTest, KernelsCantRunOffTheEnd) {
    cudaStream_t stream = nullptr;
    cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
    void* memory = nullptr;
    ASSERT_EQ(cudaMalloc(&memory, 64), cudaSuccess);
    EXPECT_DEATH(
        {
            emulation::enqueue(stream, [=] { static_cast<volatile int*>(memory)[16] = 1; });
            cudaStreamSynchronize(stream);
        },
        "");
    cudaFree(memory);
    cudaStreamDestroy(stream);
}

}  // namespace
}  // namespace spindrift
