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
    bool keepsUp = false;             // whoever asks whether work is done finds that it is
};
inline Machine machine;

// What has been done since the start of the program. `waits` counts what the host stands still
// for: synchronisation, copies without pinned memory, freeing memory; `launches` what it starts by
// itself, kernels and whole recordings.
struct Counts {
    int64_t kernels = 0, recordings = 0, instantiations = 0, replays = 0, allocations = 0,
            registrations = 0, maps = 0, repeats = 0, waits = 0, launches = 0, copies = 0,
            copiedBytes = 0;
    Counts operator-(const Counts& o) const {
        return {
            kernels - o.kernels,   recordings - o.recordings,   instantiations - o.instantiations,
            replays - o.replays,   allocations - o.allocations, registrations - o.registrations,
            maps - o.maps,         repeats - o.repeats,         waits - o.waits,
            launches - o.launches, copies - o.copies,           copiedBytes - o.copiedBytes};
    }
};
inline Counts counts;

// Done by `work`.
template <class F> Counts countsOf(const F& work) {
    const Counts before = counts;
    work();
    return counts - before;
}

}  // namespace emulation
