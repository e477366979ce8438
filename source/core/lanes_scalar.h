// One particle at a time: CUDA threads, and the CPU instance in double precision.
// SPINDRIFT_REAL chooses the number type, LANES the namespace.
#pragma once
#include <cmath>
#include <cstddef>

#ifdef __CUDACC__
#define HD __host__ __device__
#else
#define HD
#endif
#define HD_OUT HD
#define LANE_CALL

namespace spindrift::LANES {

using real = SPINDRIFT_REAL;
inline constexpr int clusterSize = 1;   // particles that neighbour search treats as one
inline constexpr int vectorStride = 4;  // numbers stored per vector: 16-byte groups of float
using ICluster = int;
using JCluster = int;
using Lanes4 = int;
template <class I> using Real = real;
using Mask = bool;

HD inline int firstOf(int i) { return i; }
HD inline int origin(int) { return 0; }
HD inline real loadAt(const real* p, int i) { return p[i]; }
HD inline void storeAt(real* p, int i, real value) { p[i] = value; }

HD inline real mulAdd(real a, real b, real c) { return a * b + c; }
HD inline real negMulAdd(real a, real b, real c) { return c - a * b; }
HD inline real min(real a, real b) { return a < b ? a : b; }
HD inline real max(real a, real b) { return a > b ? a : b; }
HD inline real select(bool condition, real yes, real no) { return condition ? yes : no; }
HD inline real squareRoot(real a) { return sqrt(a); }
HD inline real reciprocal(real a) { return 1 / a; }
HD inline real nearestInteger(real a) { return rint(a); }
HD inline real roundDown(real a) { return floor(a); }
HD inline real total(real sum) { return sum; }

// Calls pass(i) for i in [begin, end).
template <class Pass> void runRange(const Pass& pass, int begin, int end) {
    for (int i = begin; i < end; ++i) pass(i);
}
// Adds reduction.addTo for every particle in [begin, end).
template <class Reduction, class Value>
void sumRange(const Reduction& reduction, int begin, int end, Value& sum) {
    for (int i = begin; i < end; ++i) reduction.addTo(sum, i);
}

}  // namespace spindrift::LANES
