#pragma once
#include "cuda_runtime.h"

namespace cub {

struct DeviceScan {
    template <class In, class Out> static cudaError_t ExclusiveSum(void* space, size_t& bytes,
                                                                   const In* in, Out* out, int n,
                                                                   cudaStream_t stream) {
        if (!space) return bytes = 1, cudaSuccess;
        return emulation::enqueue(stream, [=] {
            const auto kernel = [](const std::function<void()>& work) {
                emulation::runGrid(dim3(1), dim3(1), work);
            };
            kernel([] {});  // the real one has two
            kernel([=] {
                Out sum = 0;
                for (int i = 0; i < n; ++i) {
                    const In item = in[i];  // `out` may be `in`
                    out[i] = sum;
                    sum += item;
                }
            });
        });
    }
};

}  // namespace cub
