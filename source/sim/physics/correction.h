// What makes gradients exact for linear fields however particles lie.
#pragma once

#include "sim/particles/view.h"

namespace spindrift::LANES {

// The moments of a particle's neighbours, M = -sum_j V_j r grad W, which is 1 on a lattice, and
// what they correct: gradients divided by M are exact for linear fields, Laplacians by its trace
// for parabolas (Randles & Libersky 1996). Where neighbours are too few or lie in a plane, nothing
// is corrected.
template <class R> struct Correction {
    Symmetric<R> inverse;  // of M
    R determinant;         // of M: 1 with neighbours all around, about a third at a flat surface
    R perTrace;            // d / trace of M
    // `least`: determinant from which on it corrects; forces are content with this.
    HD Correction(const StepParameters& c, const Symmetric<R>& sums, real least = real(0.1)) {
        const R scale = -c.gradientScale;
        Symmetric<R> m{scale * sums.xx, scale * sums.yy, scale * sums.zz,
                       scale * sums.xy, scale * sums.xz, scale * sums.yz};
        perTrace = R(c.dimensions) / max(m.xx + m.yy + m.zz, R(real(0.1)));
        m.zz += R(c.flatMoment);
        const R xx = m.yy * m.zz - m.yz * m.yz, xy = m.xz * m.yz - m.xy * m.zz,
                xz = m.xy * m.yz - m.xz * m.yy;
        const R det = m.xx * xx + m.xy * xy + m.xz * xz, one = 1, zero = 0;
        const auto solvable = det > R(least);
        const R d = one / max(det, R(least));
        determinant = det;
        inverse = {select(solvable, d * xx, one),
                   select(solvable, d * (m.xx * m.zz - m.xz * m.xz), one),
                   select(solvable, d * (m.xx * m.yy - m.xy * m.xy), one),
                   select(solvable, d * xy, zero),
                   select(solvable, d * xz, zero),
                   select(solvable, d * (m.xy * m.xz - m.xx * m.yz), zero)};
    }
};

}  // namespace spindrift::LANES
