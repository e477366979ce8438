#pragma once

namespace spindrift {

// What the passes of a step make of the machine: pairs a second, the share of them that are within
// the support radius, GFLOP/s against a measured peak of fused multiply-adds, and GB/s against a
// measured copy of large arrays. Dam break of 50 and 500 thousand particles in flow, new lists in
// every step. A table on standard output. Returns Exit::Ok.
int benchCeilings();

}  // namespace spindrift
