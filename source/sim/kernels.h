// Smoothing kernels as functions of q = |x| / R, R the support radius, in d dimensions. Each vanishes for q >= 1 by
// itself, so that lanes whose neighbour is too far need no mask.
//     W = norm(d) / R^d * w(q)        grad W = gradient norm(d) / R^(d+2) * g(q) * x
#if defined(SPINDRIFT_SIM_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_KERNELS_H
#undef SPINDRIFT_SIM_KERNELS_H
#else
#define SPINDRIFT_SIM_KERNELS_H
#endif

#include "core/lanes.h"

namespace spindrift::LANES {

// Wendland 1995, C2: w = (1-q)^4 (1+4q), g = (1-q)^3.
struct WendlandC2Kernel {
    static constexpr double norm(int d) { return (d == 2 ? 7 : 10.5) / 3.14159265358979323846; }
    static constexpr double gradient = -20;
    template <class R> HD static R w(R q) {
        const R t = max(R(1) - q, R(0)), t2 = t * t;
        return t2 * t2 * mulAdd(R(4), q, R(1));
    }
    template <class R> HD static R g(R q) {
        const R t = max(R(1) - q, R(0));
        return t * t * t;
    }
};

// Monaghan 1992, cubic spline with s = 2q: w = (2-s)^3/4 - (1-s)^3, each bracket only where positive.
struct CubicSplineKernel {
    static constexpr double norm(int d) { return (d == 2 ? 40.0 / 7 : 8) / 3.14159265358979323846; }
    static constexpr double gradient = 1;
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

}  // namespace spindrift::LANES

#endif
