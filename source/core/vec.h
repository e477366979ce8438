#pragma once
// Plain vectors for values that are not in a hot loop: scene corners, cameras, measurements.
#include <array>
#include <cmath>

#ifdef __CUDACC__
#define EVERYWHERE __host__ __device__
#else
#define EVERYWHERE
#endif

namespace spindrift {

template <class T> struct Vec3Of {
    T x = 0, y = 0, z = 0;
    EVERYWHERE T& operator[](int k) { return k == 0 ? x : k == 1 ? y : z; }
    EVERYWHERE T operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
    bool operator==(const Vec3Of&) const = default;
};
template <class T> EVERYWHERE Vec3Of<T> operator+(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> EVERYWHERE Vec3Of<T> operator-(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> EVERYWHERE Vec3Of<T> operator*(T s, Vec3Of<T> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class T> EVERYWHERE T dot(Vec3Of<T> a, Vec3Of<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> T length(Vec3Of<T> a) { return std::sqrt(dot(a, a)); }
template <class T> EVERYWHERE Vec3Of<T> cross(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> Vec3Of<T> normalized(Vec3Of<T> a) { return (T(1) / length(a)) * a; }

using Vec3 = Vec3Of<float>;
using Vec3d = Vec3Of<double>;
struct Int3 {
    int x = 0, y = 0, z = 0;
    bool operator==(const Int3&) const = default;
};

inline Vec3d toDouble(Vec3 a) { return {a.x, a.y, a.z}; }
inline Vec3 toFloat(Vec3d a) { return {float(a.x), float(a.y), float(a.z)}; }

}  // namespace spindrift
