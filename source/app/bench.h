#pragma once
#include <string>

namespace spindrift {

struct BenchOptions {
    std::string only, json, simd;
    int threads = 0;   // 0 = all cores
};

// Times whole steps of shipped scenes: the historical files against the original program's figures, 50k particles with
// about 28 and 73 neighbours, and the same flow from 10k to 2M particles. Writes a table to standard output and, when
// asked, JSON. Returns Exit::Ok. Throws Error.
int bench(const BenchOptions&);

}  // namespace spindrift
