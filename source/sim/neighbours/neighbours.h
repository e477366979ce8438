// The one neighbour loop. f(pair, j) is called with every particle j of the other set nearer than
// the support radius R, the particle itself included when it is of the same set; with SIMD also
// with some that are further away, which kernels turn into zeros. The first pass of a step,
// `BuildInner`, notes for the later ones, `Inner`, which clusters are worth a look; lists that are
// read but once a step build no inner list, `All`.
#pragma once

#include "sim/neighbours/screens.h"

namespace spindrift::LANES {

template <class R> struct Pair {
    Vector<R> r;         // x_i - x_j, m
    R distance2;         // m^2
    R q;                 // distance / R
    R inverseDistance2;  // 1 / (distance^2 + eta^2), finite everywhere
};

// `apart`: 0, or what thin solids put the pair apart by.
template <class R>
HD inline Pair<R> makePair(const StepParameters& c, Vector<R> xi, Vector<R> xj, R apart) {
    const Vector<R> r = imageOf(c, xi - xj);
    const R d2 = dot(r, r);
    return {r, d2, squareRoot(mulAdd(d2, R(c.inverseSupport2), apart)), reciprocal(d2 + R(c.eta2))};
}

enum class Lists { All, BuildInner, Inner };

#ifdef SPINDRIFT_SIMD
// A group narrower than a cluster sees but a part of the hits, so that it can't tell.
inline constexpr bool buildsInner = ICluster::size == clusterSize;

HD inline Wide apartOf(const PairsApart& pairs, ICluster i) {
    return Wide{hn::LoadU(WideTag(), pairs.of + clusterSize * (i.first % clusterSize))};
}

// With `active` only clusters of which it says at least `from`. The clusters of which all are seen
// come first, in one stretch, then one by one those of which thin solids hide some.
template <Lists lists, uint8_t from = Active, class F>
HD inline void forNeighbours(const View& v, const Neighbourhood& near, ICluster i, Vector<Wide> xi,
                             const F& f, const uint8_t* active = nullptr) {
    ClusterList& list = near.lists[i.first / clusterSize];
    const bool inner = buildsInner && lists == Lists::Inner;
    const uint32_t* clusters = inner ? list.inner : list.clusters;
    const PairsApart* pairsApart = inner ? list.innerApart : list.apart;
    const uint32_t count = inner ? list.innerCount : list.count,
                   clear = inner ? list.innerClear : list.clear;
    uint32_t kept = 0, keptClear = 0;
    Wide apart = 0;
    for (uint32_t k = 0, end = clear;;) {
        for (; k < end; ++k) {
            if (active && active[clusters[k]] < from) continue;
            const JCluster j{int(clusters[k]) * clusterSize};
            const Pair<Wide> pair = makePair(v.c, xi, load(near.position, j), apart);
            f(pair, j);
            if constexpr (buildsInner && lists == Lists::BuildInner) {
                list.inner[kept] = clusters[k];
                kept += any(pair.distance2 < Wide(v.c.support2));
            }
        }
        if (k == clear) keptClear = kept;
        if (k == count) break;
        apart = apartOf(pairsApart[k - clear], i), end = k + 1;
        if constexpr (buildsInner && lists == Lists::BuildInner)
            list.innerApart[kept - keptClear] = pairsApart[k - clear];
    }
    if constexpr (buildsInner && lists == Lists::BuildInner)
        list.innerCount = kept, list.innerClear = keptClear;
}
#else
inline constexpr bool buildsInner = false;

// Distance from a coordinate, itself in row `own`, to a row; a bit less, as a particle on a face
// may have been rounded into the next row.
HD inline real rowGap(real x, int own, int row, real low, real rowSize) {
    const real gap = row < own   ? x - (low + real(row + 1) * rowSize)
                     : row > own ? low + real(row) * rowSize - x
                                 : real(0);
    return max(gap - real(1e-3) * rowSize, real(0));
}

// Rows of cells within reach; of each row the stretch that the support sphere cuts out.
template <Lists, class F> HD inline void forNeighbours(const View& v, const Neighbourhood& near,
                                                       int i, Vector<real> xi, const F& f) {
    const Grid& g = v.grid;
    const bool screened =
        v.screens && near.between != Between::Nobody && isBesideScreen(*v.screens, xi);
    const real R = v.c.support, rowSizeY = 1 / g.perMetre.y, rowSizeZ = 1 / g.perMetre.z;
    const int ownY = g.rowY(xi.y), y0 = g.rowY(xi.y - R), y1 = g.rowY(xi.y + R);
    const int ownZ = g.rowZ(xi.z), z0 = g.rowZ(xi.z - R), z1 = g.rowZ(xi.z + R);
    for (int z = z0; z <= z1; ++z) {
        const real gapZ = rowGap(xi.z, ownZ, z, g.low.z, rowSizeZ);
        for (int y = y0; y <= y1; ++y) {
            const real gapY = rowGap(xi.y, ownY, y, g.low.y, rowSizeY);
            const real left2 = v.c.support2 - gapY * gapY - gapZ * gapZ;
            if (left2 <= 0) continue;
            const real left = squareRoot(left2);
            const int* row = near.cellStart + g.row(y, z);
            forStretches(
                g.cellX(xi.x - left), g.cellX(xi.x + left), g.cells.x, [&](int first, int last) {
                    for (int j = row[first], end = row[last + 1]; j < end; ++j) {
                        const Vector<real> xj = load(near.position, j);
                        Pair<real> pair = makePair(v.c, xi, xj, real(0));
                        if (!(pair.distance2 < v.c.support2)) continue;
                        if (screened) {
                            const real apart =
                                apartOf(*v.screens, v.walls.id, near.between, i, j, xi, pair.r);
                            if (apart == hidden) continue;
                            pair = makePair(v.c, xi, xj, apart);
                        }
                        f(pair, j);
                    }
                });
        }
    }
}
#endif

}  // namespace spindrift::LANES
