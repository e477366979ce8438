#pragma once
#include "cuda_runtime.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace cub {

struct DeviceRadixSort {
    static cudaError_t SortPairs(void* space, size_t& bytes, const int* keys, int* keysOut,
                                 const int* items, int* itemsOut, int n, int, int,
                                 cudaStream_t stream = nullptr) {
        if (!space) return bytes = 1, cudaSuccess;
        return emulation::enqueue(stream, [=] {
            std::vector<int> order(static_cast<size_t>(n));
            std::iota(order.begin(), order.end(), 0);
            std::stable_sort(order.begin(), order.end(),
                             [=](int a, int b) { return keys[a] < keys[b]; });
            for (int i = 0; i < n; ++i) keysOut[i] = keys[order[i]], itemsOut[i] = items[order[i]];
        });
    }
};

}  // namespace cub
