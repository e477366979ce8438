#pragma once
// How tests steer the emulated GPU (cuda_runtime.h).
#include "cuda_runtime.h"

namespace emulation {

struct Machine {
    int devices = 1;
    int driver = 13000;               // version; 0 = there is none
    bool codeFits = true;             // the build has code for this architecture
    size_t memory = size_t(2) << 30;  // bytes
    bool lost = false;                // everything fails from now on
    bool reversed = false;            // blocks and threads run last to first
    bool drawsToo = true;             // the GL context is on this GPU
    bool sharesMemory = true;         // with that context
};
inline Machine machine;

// What has been done since the start of the program.
struct Counts {
    int64_t kernels = 0, recordings = 0, instantiations = 0, replays = 0, allocations = 0,
            registrations = 0, maps = 0, repeats = 0;
};
inline Counts counts;

}  // namespace emulation
