// A SIMD register full of particles, through Google Highway: 16 floats with AVX-512, 8 with AVX2, 4
// otherwise. A neighbour pass works on pairs: a Group of width/4 particles i, each repeated over
// four lanes, against the four particles of one neighbour cluster j, repeated for every i:
//     i: a a a a b b b b c c c c d d d d        j: p q r s p q r s p q r s p q r s
// Two thirds fewer pairs miss than with 16 particles against one neighbour, because a cluster is
// compact.
#pragma once

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>

// HD: part of a pass, inlined into it. LANE_CALL: the same for lambdas. HD_OUT: also called from
// plain host code.
#define HD __attribute__((always_inline))
#define HD_OUT
#define LANE_CALL HWY_ATTR __attribute__((always_inline))
#define LANES HWY_NAMESPACE

namespace spindrift::LANES {

namespace hn = hwy::HWY_NAMESPACE;
using real = float;
inline constexpr int clusterSize = 4;
inline constexpr int vectorStride = 3;

using WideTag = hn::CappedTag<float, 16>;
using Lanes4Tag = hn::FixedTag<float, 4>;
inline constexpr int width = int(hn::MaxLanes(WideTag()));

struct ICluster {
    int first;
    static constexpr int size = width / 4;
};
struct JCluster {
    int first;
};
struct Lanes4 {
    int first;
};
HD inline int firstOf(int i) { return i; }
template <class I> HD inline int firstOf(I i) { return i.first; }
HD inline int origin(int) { return 0; }
template <class I> HD inline I origin(I) { return {0}; }

template <class D> struct Pack {
    hn::Vec<D> v;
    Pack() = default;  // implicit members are made outside of the instruction set: this one must do
                       // nothing
    HD Pack(float s) : v(hn::Set(D(), s)) {}
    HD explicit Pack(hn::Vec<D> v_) : v(v_) {}
    HD friend Pack operator+(Pack a, Pack b) { return Pack(hn::Add(a.v, b.v)); }
    HD friend Pack operator-(Pack a, Pack b) { return Pack(hn::Sub(a.v, b.v)); }
    HD friend Pack operator*(Pack a, Pack b) { return Pack(hn::Mul(a.v, b.v)); }
    HD friend Pack operator/(Pack a, Pack b) { return Pack(hn::Div(a.v, b.v)); }
    HD friend Pack operator-(Pack a) { return Pack(hn::Neg(a.v)); }
    HD Pack& operator+=(Pack b) { return *this = *this + b; }
    HD Pack& operator-=(Pack b) { return *this = *this - b; }
    struct Mask {
        hn::Mask<D> m;
    };
    HD friend Mask operator<(Pack a, Pack b) { return {hn::Lt(a.v, b.v)}; }
    HD friend Mask operator>(Pack a, Pack b) { return {hn::Gt(a.v, b.v)}; }
};
using Wide = Pack<WideTag>;

template <class I> struct RealOf { using type = Wide; };
template <> struct RealOf<Lanes4> { using type = Pack<Lanes4Tag>; };
template <> struct RealOf<int> { using type = float; };
template <class I> using Real = typename RealOf<I>::type;

template <class D> HD inline Pack<D> mulAdd(Pack<D> a, Pack<D> b, Pack<D> c) {
    return Pack<D>(hn::MulAdd(a.v, b.v, c.v));
}
template <class D> HD inline Pack<D> negMulAdd(Pack<D> a, Pack<D> b, Pack<D> c) {
    return Pack<D>(hn::NegMulAdd(a.v, b.v, c.v));
}
template <class D> HD inline Pack<D> min(Pack<D> a, Pack<D> b) {
    return Pack<D>(hn::Min(a.v, b.v));
}
template <class D> HD inline Pack<D> max(Pack<D> a, Pack<D> b) {
    return Pack<D>(hn::Max(a.v, b.v));
}
template <class D> HD inline Pack<D> select(typename Pack<D>::Mask m, Pack<D> yes, Pack<D> no) {
    return Pack<D>(hn::IfThenElse(m.m, yes.v, no.v));
}
// Whether it holds in any lane.
HD inline bool any(Wide::Mask m) { return !hn::AllFalse(WideTag(), m.m); }
// Exact root and division keep the divider busy beside the multipliers: cheaper than estimates with
// Newton steps.
template <class D> HD inline Pack<D> squareRoot(Pack<D> a) { return Pack<D>(hn::Sqrt(a.v)); }
// An estimate and one Newton step: 23 bits.
template <class D> HD inline Pack<D> reciprocal(Pack<D> a) {
    const Pack<D> x(hn::ApproximateReciprocal(a.v));
    return mulAdd(x, negMulAdd(a, x, Pack<D>(1)), x);
}
template <class D> HD inline Pack<D> nearestInteger(Pack<D> a) { return Pack<D>(hn::Round(a.v)); }
template <class D> HD inline Pack<D> roundDown(Pack<D> a) { return Pack<D>(hn::Floor(a.v)); }
// Sum over the four neighbours of each particle i, in all of its lanes.
HD inline Wide total(Wide sum) {
    sum += Wide(hn::Shuffle2301(sum.v));
    return sum + Wide(hn::Shuffle1032(sum.v));
}

// Adds to the four neighbours at p what the particles i have for them, or takes it away.
template <bool takes, class D> HD inline void addToOthers(float* p, D d, hn::Vec<D> v) {
    if constexpr (hn::MaxLanes(d) > 4) {
        const hn::Half<D> half;
        addToOthers<takes>(p, half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
    } else {
        const auto before = hn::LoadU(d, p);
        hn::StoreU(takes ? hn::Sub(before, v) : hn::Add(before, v), d, p);
    }
}
template <bool takes> HD inline void addToOthers(float* p, Wide a) {
    addToOthers<takes>(p, WideTag(), a.v);
}

HD inline float mulAdd(float a, float b, float c) { return a * b + c; }
HD inline float negMulAdd(float a, float b, float c) { return c - a * b; }
HD inline float min(float a, float b) { return a < b ? a : b; }
HD inline float max(float a, float b) { return a > b ? a : b; }
HD inline float select(bool condition, float yes, float no) { return condition ? yes : no; }
HD inline float squareRoot(float a) { return std::sqrt(a); }
HD inline float nearestInteger(float a) { return std::nearbyint(a); }
HD inline float roundDown(float a) { return std::floor(a); }

HD inline float loadAt(const float* p, int i) { return p[i]; }
HD inline void storeAt(float* p, int i, float value) { p[i] = value; }
HD inline Pack<Lanes4Tag> loadAt(const float* p, Lanes4 i) {
    return Pack<Lanes4Tag>(hn::LoadU(Lanes4Tag(), p + i.first));
}
HD inline void storeAt(float* p, Lanes4 i, Pack<Lanes4Tag> value) {
    hn::StoreU(value.v, Lanes4Tag(), p + i.first);
}
HD inline Wide loadAt(const float* p, JCluster j) {
    return Wide(hn::LoadDup128(WideTag(), p + j.first));
}

HD inline Wide permute(Wide a, const int32_t* lanes) {
    return Wide(hn::TableLookupLanes(a.v, hn::SetTableIndices(WideTag(), lanes)));
}
HD inline Wide loadAt(const float* p, ICluster i) {
    if constexpr (width == 4) return Wide(p[i.first]);
    static constexpr int32_t repeat[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    return permute(Wide(hn::LoadDup128(WideTag(), p + i.first)), repeat);
}
HD inline void storeAt(float* p, ICluster i, Wide value) {
    static constexpr int32_t firsts[16] = {0, 4, 8, 12};
    if constexpr (width == 4)
        p[i.first] = hn::GetLane(value.v);
    else
        hn::BlendedStore(permute(value, firsts).v, hn::FirstN(WideTag(), ICluster::size), WideTag(),
                         p + i.first);
}

// Calls pass(index) until all particles in [begin, end) are done; both are multiples of
// clusterSize.
template <class Pass> void runRange(const Pass& pass, int begin, int end) {
    using Index = typename Pass::Index;
    if constexpr (std::is_same_v<Index, ICluster>) {
        for (int i = begin; i < end; i += ICluster::size) pass(ICluster{i});
    } else if constexpr (std::is_same_v<Index, Lanes4>) {
        for (int i = begin; i < end; i += 4) pass(Lanes4{i});
    } else {
        for (int i = begin; i < end; ++i) pass(i);
    }
}

// Adds reduction.addTo for every particle in [begin, end).
template <class Reduction, class Value>
void sumRange(const Reduction& reduction, int begin, int end, Value& sum) {
    for (int i = begin; i < end; ++i) reduction.addTo(sum, i);
}

}  // namespace spindrift::LANES
