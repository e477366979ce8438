// Smoothing kernels as functions of q = |x| / R, R the support radius, in d dimensions. Each
// vanishes for q >= 1 by itself, so that lanes whose neighbour is too far need no mask.
//     W = norm(d) / R^d * w(q)        grad W = gradient(d) norm(d) / R^(d+2) * g(q) * x
#pragma once

#include "core/lanes.h"
#include "scene/scene.h"

#include <type_traits>

namespace spindrift::LANES {

// Wendland 1995, C2: w = (1-q)^4 (1+4q), g = (1-q)^3.
struct WendlandC2Kernel {
    static constexpr double norm(int d) { return (d == 2 ? 7 : 10.5) / 3.14159265358979323846; }
    static constexpr double gradient(int) { return -20; }
    template <class R> HD static R w(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t;
        return t2 * t2 * mulAdd(R(4), q, R(1));
    }
    template <class R> HD static R g(R q) {
        const R t = max(R(1) - q, R(0));
        return t * t * t;
    }
};

// Wendland 1995, C4: w = (1-q)^6 (1 + 6q + 35/3 q^2), g = (1-q)^5 (1+5q).
struct WendlandC4Kernel {
    static constexpr double norm(int d) {
        return (d == 2 ? 9 : 495.0 / 32) / 3.14159265358979323846;
    }
    static constexpr double gradient(int) { return -56.0 / 3; }
    template <class R> HD static R w(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t;
        return t2 * t2 * t2 * mulAdd(q, mulAdd(R(real(35) / 3), q, R(6)), R(1));
    }
    template <class R> HD static R g(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t;
        return t2 * t2 * t * mulAdd(R(5), q, R(1));
    }
};

// Wendland 1995, C6: w = (1-q)^8 (1 + 8q + 25q^2 + 32q^3), g = (1-q)^7 (1 + 7q + 16q^2).
struct WendlandC6Kernel {
    static constexpr double norm(int d) {
        return (d == 2 ? 78.0 / 7 : 1365.0 / 64) / 3.14159265358979323846;
    }
    static constexpr double gradient(int) { return -22; }
    template <class R> HD static R w(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t, t4 = t2 * t2;
        return t4 * t4 * mulAdd(q, mulAdd(q, mulAdd(R(32), q, R(25)), R(8)), R(1));
    }
    template <class R> HD static R g(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t;
        return t2 * t2 * t2 * t * mulAdd(q, mulAdd(R(16), q, R(7)), R(1));
    }
};

// Morris 1997, quintic spline with s = 3q: w = (3-s)^5 - 6(2-s)^5 + 15(1-s)^5, each bracket only
// where positive. Their h is a third of the support.
struct QuinticSplineKernel {
    static constexpr double norm(int d) {
        return (d == 2 ? 63.0 / 478 : 9.0 / 40) / 3.14159265358979323846;
    }
    static constexpr double gradient(int) { return -45; }
    template <class R> HD static R fifth(R t) {
        const R t2 = t * t;
        return t2 * t2 * t;
    }
    template <class R> HD static R w(R q) {
        const R s = R(3) * q;
        const R a = max(R(3) - s, R(0)), b = max(R(2) - s, R(0)), c = max(R(1) - s, R(0));
        return mulAdd(R(15), fifth(c), negMulAdd(R(6), fifth(b), fifth(a)));
    }
    // In the middle the brackets' sum over s, multiplied out.
    template <class R> HD static R g(R q) {
        const R s = R(3) * q;
        const R a = max(R(3) - s, R(0)), b = max(R(2) - s, R(0)), a2 = a * a, b2 = b * b;
        const R inner = mulAdd(s * s, mulAdd(R(10), s, R(-24)), R(24));
        const R outer = negMulAdd(R(6), b2 * b2, a2 * a2) / max(s, R(0.5f));
        return select(s < R(1), inner, outer);
    }
};

// Monaghan 1992, cubic spline with s = 2q: w = (2-s)^3/4 - (1-s)^3, each bracket only where
// positive.
struct CubicSplineKernel {
    static constexpr double norm(int d) { return (d == 2 ? 40.0 / 7 : 8) / 3.14159265358979323846; }
    static constexpr double gradient(int) { return 1; }
    template <class R> HD static R w(R q) {
        const R s = q + q, a = max(R(2) - s, R(0)), b = max(R(1) - s, R(0));
        return R(0.25f) * a * a * a - b * b * b;
    }
    template <class R> HD static R g(R q) {
        const R s = q + q, a = max(R(2) - s, R(0));
        const R inner = R(9) * s - R(12), outer = R(-1.5f) * a * a / max(q, R(0.25f));
        return select(s < R(1), inner, outer);
    }
};

// Mueller 2003, three kernels in one: densities by poly6, w = (1-q^2)^3; gradients by the spiky
// kernel, g = (1-q)^2 / q; viscosity by the one with a Laplacian that is positive everywhere,
// (1-q). In two dimensions with the spiky kernel's norm there, 10 / pi.
struct MuellerKernel {
    static constexpr double norm(int d) {
        return (d == 2 ? 4 : 315.0 / 64) / 3.14159265358979323846;
    }
    static constexpr double gradient(int d) { return d == 2 ? -7.5 : -64.0 / 7; }
    template <class R> HD static R w(R q) {
        const R t = max(negMulAdd(q, q, R(1)), R(0));
        return t * t * t;
    }
    // Of finite length at q = 0, where it points nowhere.
    template <class R> HD static R g(R q) {
        const R t = max(R(1) - q, R(0));
        return t * t / max(q, R(1e-6f));
    }
    template <class R> HD static R viscous(R q) { return max(R(1) - q, R(0)); }
};

// What sums for Laplacians weigh differences with: (x.grad W) / d^2 as Morris 1997 does, hence g,
// unless a kernel has its own. What a unit of it comes to is found on the lattice
// (lattice_sums.h).
template <class Kernel, class R> HD inline R viscous(R q) {
    if constexpr (requires { Kernel::viscous(q); })
        return Kernel::viscous(q);
    else
        return Kernel::g(q);
}

// Of means that are the same whichever kernel a scene has.
using MeanKernel = WendlandC2Kernel;

// Calls f with the kernel of that name; on a GPU f must be of the GPU, which nvcc can't tell.
#ifdef __CUDACC__
#pragma nv_exec_check_disable
#endif
template <class F> HD inline auto withKernel(Kernel kernel, F f) {
    switch (kernel) {
        case Kernel::CubicSpline:
            return f(CubicSplineKernel{});
        case Kernel::WendlandC4:
            return f(WendlandC4Kernel{});
        case Kernel::WendlandC6:
            return f(WendlandC6Kernel{});
        case Kernel::QuinticSpline:
            return f(QuinticSplineKernel{});
        case Kernel::Mueller:
            return f(MuellerKernel{});
        case Kernel::WendlandC2:
            break;
    }
    return f(WendlandC2Kernel{});
}

// --- in passes: kernels that are compiled ---

// Stands for the kernel that StepParameters name, which costs a branch that always goes the same
// way. Passes are compiled for it and for Wendland's C2, which most scenes have: passes for each of
// six kernels took three times as long to compile.
struct NamedKernel {};

template <class K, class C, class R> HD inline R valueOf(const C& c, R q) {
    if constexpr (std::is_same_v<K, NamedKernel>)
        return withKernel(c.kernel, [q](auto kernel) LANE_CALL { return decltype(kernel)::w(q); });
    else
        return K::w(q);
}
template <class K, class C, class R> HD inline R slopeOf(const C& c, R q) {
    if constexpr (std::is_same_v<K, NamedKernel>)
        return withKernel(c.kernel, [q](auto kernel) LANE_CALL { return decltype(kernel)::g(q); });
    else
        return K::g(q);
}
template <class K, class C, class R> HD inline R viscousOf(const C& c, R q) {
    if constexpr (std::is_same_v<K, NamedKernel>)
        return withKernel(c.kernel,
                          [q](auto kernel) LANE_CALL { return viscous<decltype(kernel)>(q); });
    else
        return viscous<K>(q);
}

template <class F> auto withCompiledKernel(Kernel kernel, F f) {
    return kernel == Kernel::WendlandC2 ? f(WendlandC2Kernel{}) : f(NamedKernel{});
}

}  // namespace spindrift::LANES
