// Lanes: the particles that one call of a pass works on. Physics is written against these few names
// and compiles for every SIMD width (lanes_simd.h) and, one particle at a time, for CUDA and for
// the double-precision instance (lanes_scalar.h).
//
//   Real<I>             the numbers of the particles at index I
//   Vector<R>           x, y, z of such numbers
//   load, store         a field's values at an index
//   total(sum)          ends a sum over neighbours
//
// Index kinds: `ICluster` (neighbour passes: a few particles i, each against four neighbours j at
// once), `JCluster` (the j side), `Lanes4` (four particles, no neighbours), `int` (one particle).
// Without SIMD all are int.
//
// This file and all that includes it are compiled once per instruction set, each time in another
// namespace (LANES).
#pragma once

#ifdef SPINDRIFT_SIMD
#include "core/lanes_simd.h"
#else
#include "core/lanes_scalar.h"
#endif

namespace spindrift::LANES {

template <class R> struct Vector { R x, y, z; };
template <class R> HD inline Vector<R> operator+(Vector<R> a, Vector<R> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R> HD inline Vector<R> operator-(Vector<R> a, Vector<R> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R> HD inline Vector<R> operator*(R s, Vector<R> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class R> HD inline R dot(Vector<R> a, Vector<R> b) {
    return mulAdd(a.z, b.z, mulAdd(a.y, b.y, a.x * b.x));
}
// a + s b, fused
template <class R> HD inline Vector<R> addScaled(Vector<R> a, R s, Vector<R> b) {
    return {mulAdd(s, b.x, a.x), mulAdd(s, b.y, a.y), mulAdd(s, b.z, a.z)};
}
// a - s b, fused
template <class R> HD inline Vector<R> subtractScaled(Vector<R> a, R s, Vector<R> b) {
    return {negMulAdd(s, b.x, a.x), negMulAdd(s, b.y, a.y), negMulAdd(s, b.z, a.z)};
}
template <class R> HD inline Vector<R> cross(Vector<R> a, Vector<R> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// A symmetric matrix.
template <class R> struct Symmetric { R xx, yy, zz, xy, xz, yz; };
template <class R> HD inline Symmetric<R> addOuter(Symmetric<R> m, R s, Vector<R> r) {
    const Vector<R> sr = s * r;
    return {mulAdd(sr.x, r.x, m.xx), mulAdd(sr.y, r.y, m.yy), mulAdd(sr.z, r.z, m.zz),
            mulAdd(sr.x, r.y, m.xy), mulAdd(sr.x, r.z, m.xz), mulAdd(sr.y, r.z, m.yz)};
}
template <class R> HD inline Vector<R> operator*(Symmetric<R> m, Vector<R> v) {
    return {dot(Vector<R>{m.xx, m.xy, m.xz}, v), dot(Vector<R>{m.xy, m.yy, m.yz}, v),
            dot(Vector<R>{m.xz, m.yz, m.zz}, v)};
}
template <class R> HD inline Symmetric<R> total(Symmetric<R> m) {
    return {total(m.xx), total(m.yy), total(m.zz), total(m.xy), total(m.xz), total(m.yz)};
}
template <class R> HD inline Vector<R> total(Vector<R> sum) {
    return {total(sum.x), total(sum.y), total(sum.z)};
}

// One number a particle, and three numbers a particle. Three are stored cluster by cluster, x x x x
// y y y y z z z z (clusterSize each), so that a neighbour cluster is one short stretch of memory;
// on the GPU as 16-byte groups.
struct ScalarField {
    real* data;
};
struct VectorField {
    real* data;
};

HD inline size_t vectorOffset(int i, int component) {
    return size_t(i / clusterSize) * (clusterSize * vectorStride) + component * clusterSize +
           i % clusterSize;
}
inline size_t vectorSize(int slots) { return size_t(slots) * vectorStride; }

template <class I> HD inline Real<I> load(ScalarField f, I i) { return loadAt(f.data, i); }
template <class I> HD inline void store(ScalarField f, I i, Real<I> value) {
    storeAt(f.data, i, value);
}
#ifdef SPINDRIFT_SIMD
template <class I> HD inline Vector<Real<I>> load(VectorField f, I i) {
    const real* p = f.data + vectorOffset(firstOf(i), 0);
    return {loadAt(p, origin(i)), loadAt(p + clusterSize, origin(i)),
            loadAt(p + 2 * clusterSize, origin(i))};
}
template <class I> HD inline void store(VectorField f, I i, Vector<Real<I>> value) {
    real* p = f.data + vectorOffset(firstOf(i), 0);
    storeAt(p, origin(i), value.x);
    storeAt(p + clusterSize, origin(i), value.y);
    storeAt(p + 2 * clusterSize, origin(i), value.z);
}
#else
// One aligned access instead of three. The host's copies lie in ordinary vectors, which are aligned
// to 16 bytes.
struct alignas(16) Packed {
    real x, y, z, unused;
};
HD inline Vector<real> load(VectorField f, int i) {
    const Packed p = reinterpret_cast<const Packed*>(f.data)[i];
    return {p.x, p.y, p.z};
}
HD inline void store(VectorField f, int i, Vector<real> value) {
    reinterpret_cast<Packed*>(f.data)[i] = {value.x, value.y, value.z, 0};
}
#endif

}  // namespace spindrift::LANES
