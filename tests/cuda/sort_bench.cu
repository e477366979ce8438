// The device's counting sort against CUB's radix sort, on the cells of a dam break: same result,
// which one is faster? sort_bench [N...] prints a JSON line a size. Exit code 6 without a GPU, 1
// when the results differ. sort_bench ceilings [N] prints what the card's memory and arithmetic
// make of N numbers.
#include "core/error.h"
#include "device/cuda.h"

#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace spindrift {
namespace {

struct Numbers {
    int* out;
    __device__ void operator()(int i) const { out[i] = i; }
};
// First slot whose key is not below the cell.
struct CellStarts {
    const int* keys;
    int n;
    int* start;
    __device__ void operator()(int cell) const {
        int low = 0, high = n;
        while (low < high) {
            const int middle = low + (high - low) / 2;
            if (keys[middle] < cell)
                low = middle + 1;
            else
                high = middle;
        }
        start[cell] = low;
    }
};

struct Case {
    int n, cells;
    std::vector<int> keys;
};

// About half a particle per cell that is filled, one cell in five filled, particles nearly in
// order, as from step to step.
Case makeCase(int n) {
    Case c{n, 3 * n, std::vector<int>(size_t(n))};
    std::mt19937 random(1);
    for (int i = 0; i < n; ++i)
        c.keys[i] = std::clamp(int(0.55 * i) + int(random() % 64) - 32, 0, c.cells - 1);
    return c;
}

double median(std::vector<double> ms) {
    std::nth_element(ms.begin(), ms.begin() + long(ms.size() / 2), ms.end());
    return ms[ms.size() / 2];
}

bool compare(int n) {
    const Case c = makeCase(n);
    Cuda device(0);
    Buffer<int, Cuda> key(device), start(device), order(device), radixStart(device),
        keysOut(device), items(device), radixOrder(device);
    for (auto* b : {&key, &items, &keysOut, &radixOrder}) b->resize(size_t(n));
    start.resize(size_t(c.cells) + 2), radixStart.resize(size_t(c.cells) + 1);
    device.upload(key.data(), c.keys.data(), c.keys.size());
    device.sortByCell(n, key.data(), 1, c.cells, 1, start.data(), order);  // makes room
    const double counting = median(device.timeEach(
        100, [&] { device.sortByCell(n, key.data(), 1, c.cells, 1, start.data(), order); }));

    const int bits = int(std::ceil(std::log2(double(c.cells) + 1)));
    size_t bytes = 0;
    cub::DeviceRadixSort::SortPairs(nullptr, bytes, key.data(), keysOut.data(), items.data(),
                                    radixOrder.data(), n, 0, bits);
    Buffer<char, Cuda> space(device);
    space.resize(bytes);
    const double radix = median(device.timeEach(100, [&] {
        device.forEach(n, Numbers{items.data()});
        requireCuda(cub::DeviceRadixSort::SortPairs(space.data(), bytes, key.data(), keysOut.data(),
                                                    items.data(), radixOrder.data(), n, 0, bits,
                                                    device.stream()),
                    "sorting");
        device.forEach(c.cells + 1, CellStarts{keysOut.data(), n, radixStart.data()});
    }));

    auto fetch = [&](const Buffer<int, Cuda>& b) {
        std::vector<int> host(b.size());
        device.download(host.data(), b.data(), host.size());
        return host;
    };
    std::vector<int> starts = fetch(start);
    starts.pop_back();  // where those in no cell end
    const bool same = fetch(order) == fetch(radixOrder) && starts == fetch(radixStart);
    std::printf(
        "{\"particles\": %d, \"cells\": %d, \"counting_ms\": %.4f, \"radix_ms\": %.4f, \"same\": "
        "%s}\n",
        n, c.cells, counting, radix, same ? "true" : "false");
    return same;
}

// Read and written; and multiplied and added, independent of one another.
struct Copy {
    const float* from;
    float* to;
    __device__ void operator()(int i) const { to[i] = from[i]; }
};
struct MultiplyAndAdd {
    static constexpr int rounds = 4096, chains = 8;
    float* out;
    __device__ void operator()(int i) const {
        float sums[chains] = {}, factor = 0.999f;
        for (int k = 0; k < rounds; ++k)
            for (int c = 0; c < chains; ++c) sums[c] = sums[c] * factor + float(i);
        for (int c = 1; c < chains; ++c) sums[0] += sums[c];
        out[i] = sums[0];
    }
};
void printCeilings(int n) {
    Cuda device(0);
    Buffer<float, Cuda> from(device), to(device);
    from.fill(std::vector<float>(size_t(n)));
    to.resize(size_t(n));
    const auto copy = [&] { device.forEach(n, Copy{from.data(), to.data()}); };
    const auto add = [&] { device.forEach(n, MultiplyAndAdd{to.data()}); };
    copy(), add();
    const double perCopy = median(device.timeEach(20, copy)),
                 perSum = median(device.timeEach(5, add));
    std::printf("{\"numbers\": %d, \"copied_GB_per_s\": %.1f, \"float_GFLOP_per_s\": %.1f}\n", n,
                8e-6 * n / perCopy,
                2e-6 * n * MultiplyAndAdd::rounds * MultiplyAndAdd::chains / perSum);
}

}  // namespace
}  // namespace spindrift

int main(int count, char** arguments) {
    if (const std::string problem = spindrift::cudaProblem(0); !problem.empty()) {
        std::fprintf(stderr, "skipped: no CUDA device (%s)\n", problem.c_str());
        return 6;
    }
    if (count > 1 && std::string(arguments[1]) == "ceilings")
        return spindrift::printCeilings(count > 2 ? std::atoi(arguments[2]) : 100'000'000), 0;
    bool same = true;
    std::vector<int> sizes = {50'000, 1'000'000, 10'000'000};
    if (count > 1) sizes.clear();
    for (int k = 1; k < count; ++k) sizes.push_back(std::atoi(arguments[k]));
    for (int n : sizes) same &= spindrift::compare(n);
    return same ? 0 : 1;
}
