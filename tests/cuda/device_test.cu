// Loops, sums, bins and the sort give on a GPU what they give on the host.
#define SPINDRIFT_REAL float
#define LANES deviceTest
#include "cuda/gpu.h"
#include "device/cuda.h"
#include "device/omp.h"
#include "sim/make_simulation.h"
#include "sim/particles/sort_passes.h"
#include "sim/physics/time_step.h"

#ifdef SPINDRIFT_EMULATED_GPU
#include "emulation.h"
#endif

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace spindrift::deviceTest {

struct Square {
    const int* in;
    int* out;
    HD void operator()(int i) const { out[i] = in[i] * in[i]; }
};
struct Sums {
    double sum = 0;
    int largest = -1;
    HD void add(const Sums& o) {
        sum += o.sum;
        largest = o.largest > largest ? o.largest : largest;
    }
};
struct AddNumbers {
    const int* in;
    HD void addTo(Sums& s, int i) const { s.add({1.0 / (1 + in[i]), in[i]}); }
};
struct LastDigit {
    static constexpr int bins = 10;
    const int* in;
    HD int bin(int i) const { return in[i] % 13 == 0 ? -1 : in[i] % 10; }
};

std::vector<int> randomNumbers(int n, int below) {
    std::mt19937 random(5);
    std::vector<int> numbers(n);
    for (int& x : numbers) x = int(random() % unsigned(below));
    return numbers;
}

template <class Device> class Devices : public testing::Test {
protected:
    void SetUp() override {
        if constexpr (std::is_same_v<Device, Cuda>) NEED_GPU();
    }
    static Device make() {
        if constexpr (std::is_same_v<Device, Cuda>)
            return Cuda(0);
        else
            return Omp(2);
    }
    template <class T>
    static std::vector<T> fetch(Device& device, const Buffer<T, Device>& buffer) {
        std::vector<T> host(buffer.size());
        device.download(host.data(), buffer.data(), host.size());
        return host;
    }
    template <class T>
    static void put(Device& device, Buffer<T, Device>& buffer, const std::vector<T>& host) {
        buffer.resize(host.size());
        device.upload(buffer.data(), host.data(), host.size());
    }
};
using Both = testing::Types<Omp, Cuda>;
TYPED_TEST_SUITE(Devices, Both);

TYPED_TEST(Devices, LoopReachesEverybody) {
    for (int n : {1, 127, 128, 129, 5000}) {
        TypeParam device = this->make();
        Buffer<int, TypeParam> in(device), out(device);
        const std::vector<int> numbers = randomNumbers(n, 1000);
        this->put(device, in, numbers);
        out.resize(n);
        device.forEach(n, Square{in.data(), out.data()});
        const std::vector<int> squares = this->fetch(device, out);
        for (int i = 0; i < n; ++i)
            ASSERT_EQ(squares[i], numbers[i] * numbers[i]) << i << " of " << n;
    }
}

TYPED_TEST(Devices, SumsAndExtremesOfAnyNumber) {
    for (int n : {0, 1, 127, 129, 20000}) {
        TypeParam device = this->make();
        Buffer<int, TypeParam> in(device);
        const std::vector<int> numbers = randomNumbers(n, 100000);
        this->put(device, in, numbers);
        const Sums sums = device.template sum<Sums>(n, AddNumbers{in.data()});
        Sums expected;
        for (int x : numbers) expected.add({1.0 / (1 + x), x});
        EXPECT_NEAR(sums.sum, expected.sum, 1e-12 * n);
        EXPECT_EQ(sums.largest, expected.largest);
    }
}

TYPED_TEST(Devices, BinsAreCounted) {
    for (int n : {0, 1, 40000}) {
        TypeParam device = this->make();
        Buffer<int, TypeParam> in(device);
        const std::vector<int> numbers = randomNumbers(n, 1000);
        this->put(device, in, numbers);
        std::vector<int> expected(10);
        for (int x : numbers)
            if (x % 13 != 0) ++expected[x % 10];
        EXPECT_EQ(device.histogram(n, LastDigit{in.data()}), expected);
    }
}

TYPED_TEST(Devices, SortIsStable) {
    const int rows = 40, rowLength = 9;
    for (int n : {0, 1, 300, 20000}) {
        TypeParam device = this->make();
        Buffer<int, TypeParam> key(device), cellStart(device), order(device);
        const std::vector<int> keys = randomNumbers(n, rows * rowLength);
        this->put(device, key, keys);
        cellStart.resize(rows * rowLength + 2);
        ASSERT_EQ(device.sortByCell(n, key.data(), rows, rowLength, 1, cellStart.data(), order), n);
        std::vector<int> expected(n);
        std::iota(expected.begin(), expected.end(), 0);
        std::stable_sort(expected.begin(), expected.end(),
                         [&](int a, int b) { return keys[a] < keys[b]; });
        EXPECT_EQ(this->fetch(device, order), expected);
        const std::vector<int> starts = this->fetch(device, cellStart);
        for (int c = 0; c <= rows * rowLength; ++c)
            ASSERT_EQ(starts[c],
                      std::count_if(keys.begin(), keys.end(), [&](int k) { return k < c; }))
                << c;
    }
}

// Particles that are nowhere must not share a cell: the run has to stop with a message, not to hang
// in N^2 pairs.
TYPED_TEST(Devices, ParticlesThatAreNowhereAreSpreadOverTheCells) {
    const int n = 1000;
    TypeParam device = this->make();
    Buffer<int, TypeParam> id(device), key(device);
    Buffer<float, TypeParam> position(device);
    this->put(device, id, std::vector<int>(n, 1));
    this->put(device, position, std::vector<float>(4 * n, NAN));
    key.resize(n);
    Particles p{};
    p.id = id.data();
    p.position = {position.data()};
    device.forEach(n, FindCell{p, Grid{{0, 0, 0}, {1, 1, 1}, {20, 10, 10}, {}}, key.data()});
    std::vector<int> keys = this->fetch(device, key);
    std::sort(keys.begin(), keys.end());
    for (int i = 1; i < n; ++i) ASSERT_NE(keys[i], keys[i - 1]);
    EXPECT_GE(keys.front(), 0);
    EXPECT_LT(keys.back(), 20 * 10 * 10);
}

// What was recorded would go on using memory that has been given back.
TEST(CudaRecordings, DontOutliveWhatTheyUse) {
    NEED_GPU();
    const int cells = 400;
    Cuda device(0);
    Buffer<int, Cuda> key(device), cellStart(device), order(device);
    const auto sort = [&] {
        device.sortByCell(int(key.size()), key.data(), 1, cells, 1, cellStart.data(), order);
    };
    const auto expectSorted = [&](const std::vector<int>& keys) {
        const std::vector<int> sorted = order.download();
        for (size_t i = 1; i < sorted.size(); ++i)
            ASSERT_LE(keys[size_t(sorted[i - 1])], keys[size_t(sorted[i])]);
    };
    cellStart.resize(cells + 2);
    const std::vector<int> few = randomNumbers(1000, cells), many = randomNumbers(90000, cells);
    key.fill(few);
    order.resize(many.size());
    sort();  // makes room
    CudaRecording recording;
    device.record(recording, sort);
    EXPECT_TRUE(device.replay(recording));
    expectSorted(few);
    // The sort's own space grows, nothing else does.
    Buffer<int, Cuda> other(device);
    other.fill(many);
    key.swap(other);
    sort();
    expectSorted(many);
    key.swap(other);
    EXPECT_FALSE(device.replay(recording)) << "it would sort in memory that was given back";
    device.record(recording, sort);
    EXPECT_TRUE(device.replay(recording));
    expectSorted(few);
}

// Of the card itself: the estimate that refuses large scenes is not asked.
TEST(Gpu, MemoryThatRunsOutIsOneLineAndTheNextRunGoes) {
    NEED_GPU();
#ifdef SPINDRIFT_EMULATED_GPU
    emulation::machine.memory = 32 << 20;
#endif
    Scene scene = shippedScene("dam_break.json");
    if (!emulated) scene.simulation.spacing = 0.0055f;  // a million
    const RunState begin(placeParticles(scene));
    const int64_t needed = makeCudaSimulation(scene, begin, 0)->bytes();
    {
        Cuda device(0);
        std::vector<void*> taken;  // all but half of what the run needs
        const auto tooMuch = [&] { return cudaFreeMemory(0) - needed / 2; };
        for (int64_t piece = tooMuch(); piece > needed / 16;) try {
                taken.push_back(device.allocate<char>(size_t(piece)));
                piece = tooMuch();
            } catch (const Error&) { piece /= 2; }
        try {
            makeCudaSimulation(scene, begin, 0);
            ADD_FAILURE() << "there was room";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::Memory);
            EXPECT_NE(std::string(error.what()).find("out of GPU memory while"), std::string::npos)
                << error.what();
        }
        for (void* p : taken) device.release(p, 0);
    }
    const auto gpu = makeCudaSimulation(scene, begin, 0);
    gpu->step(5);
    EXPECT_TRUE(gpu->measure().finite);
#ifdef SPINDRIFT_EMULATED_GPU
    emulation::machine = {};
#endif
}

TEST(CudaVertices, DeviceMemoryAndHostGetTheSame) {
    NEED_GPU();
    const Scene scene = testScene("ball_drop_small.json");
    const auto simulation = makeCudaSimulation(scene, placeParticles(scene), 0);
    simulation->step(5);
    for (int walls : {0, simulation->wallCount()}) {
        const size_t n = size_t(simulation->fluidCount() + walls);
        Cuda device(0);
        Buffer<Vertex, Cuda> own(device);
        own.resize(n);
        device.wait();  // the simulation works on another stream
        std::vector<Vertex> direct(n), copied(n);
        const Range a = simulation->writeVertices({own.data(), 0}, ColorBy::Velocity, walls);
        device.download(direct.data(), own.data(), n);
        const Range b = simulation->writeVertices({copied.data()}, ColorBy::Velocity, walls);
        EXPECT_EQ(std::memcmp(direct.data(), copied.data(), n * sizeof(Vertex)), 0);
        EXPECT_EQ(a.min, b.min);
        EXPECT_EQ(a.max, b.max);
        EXPECT_GT(b.max, 0.01f);
    }
}

}  // namespace spindrift::deviceTest
