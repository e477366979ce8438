#pragma once
// Which NVIDIA GPUs there are; usable from plain C++, with and without CUDA in the build.
#include <cstdint>
#include <string>

namespace spindrift {

// Why the CUDA device with this number can't be used, and how to mend it, in one line; "" when it
// can.
std::string cudaProblem(int index);
// "NVIDIA H200"
std::string cudaDeviceName(int index);
// Free memory on the device, bytes.
int64_t cudaFreeMemory(int index);

}  // namespace spindrift
