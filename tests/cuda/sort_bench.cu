// The device's counting sort against CUB's radix sort, on the cells of a dam break: same result,
// which one is faster? sort_bench [N...] prints a JSON line a size. Exit code 6 without a GPU, 1
// when the results differ.
#include "core/error.h"
#include "device/cuda.h"

#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

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
    for (auto* b : {&start, &radixStart}) b->resize(size_t(c.cells) + 1);
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
    const bool same = fetch(order) == fetch(radixOrder) && fetch(start) == fetch(radixStart);
    std::printf(
        "{\"particles\": %d, \"cells\": %d, \"counting_ms\": %.4f, \"radix_ms\": %.4f, \"same\": "
        "%s}\n",
        n, c.cells, counting, radix, same ? "true" : "false");
    return same;
}

}  // namespace
}  // namespace spindrift

int main(int count, char** arguments) {
    if (const std::string problem = spindrift::cudaProblem(0); !problem.empty()) {
        std::fprintf(stderr, "skipped: no CUDA device (%s)\n", problem.c_str());
        return 6;
    }
    bool same = true;
    std::vector<int> sizes = {50'000, 1'000'000, 10'000'000};
    if (count > 1) sizes.clear();
    for (int k = 1; k < count; ++k) sizes.push_back(std::atoi(arguments[k]));
    for (int n : sizes) same &= spindrift::compare(n);
    return same ? 0 : 1;
}
