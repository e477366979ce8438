#pragma once
#include <cstdint>
#include <string>

namespace spindrift {

struct BenchOptions {
    std::string only, json, simd, baseline;
    int threads = 0;  // 0 = all cores
    bool gpu = false;
    int64_t most = 1'000'000'000;  // particles
};

// Times whole steps of shipped scenes: the historical files against the original program's figures,
// 50k particles with about 28 and 73 neighbours, and the same flow from 10k to 2M particles; on a
// GPU up to 100M, and what a frame and a change of backend cost at 1M. Writes a table to standard
// output and, when asked, JSON. With a baseline, a file that an earlier run on this machine has
// written, it says which cases got slower, and notes those that are not in it yet. Returns
// Exit::Ok. Throws Error.
int bench(const BenchOptions&);

}  // namespace spindrift
