// Bounding boxes of clusters, and what lists of them have to know of thin solids.
#pragma once

#include "core/error.h"
#include "core/pass_time.h"
#include "sim/neighbours/screens.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::LANES {

// Whether thin solids may be between particles of a cluster and others: for each solid which planes
// the whole cluster is in front of, or that it is out of reach, and whether boundary particles of
// it are any thin solid's.
namespace side {
enum : uint8_t { Planes = 63, Owned = 64, Far = 128 };
}

// Bounding boxes of a set's clusters, empty slots left out; component by component for SIMD tests.
struct ClusterBoxes {
    std::vector<float> low[3], high[3];
    std::vector<uint8_t> sides;  // cluster by cluster, of each thin solid; empty: there is none
    int screens = 0;

    template <class Device> void compute(Device& device, const Particles& p) {
        const int clusters = p.slots / clusterSize;
        for (int k = 0; k < 3; ++k) {
            low[k].resize(clusters + width);  // tests read whole registers
            high[k].resize(clusters + width);
        }
        device.forRanges(clusters, 256, [&](int begin, int end) {
            for (int c = begin; c < end; ++c) computeOne(p, c);
        });
    }
    template <class Device> void findSides(Device& device, const Particles& p, const Screens* all,
                                           float reach, bool walls) {
        const int clusters = p.slots / clusterSize;
        screens = all->count;
        sides.resize(size_t(clusters) * size_t(screens));
        device.forRanges(clusters, 256, [&](int begin, int end) {
            for (int c = begin; c < end; ++c)
                for (int k = 0; k < screens; ++k)
                    sides[size_t(c) * size_t(screens) + size_t(k)] =
                        sideOf(p, c, *all, all->solids[all->thin[k]], reach, walls);
        });
    }
    static uint8_t sideOf(const Particles& p, int cluster, const Screens& all, const SolidState& s,
                          float reach, bool walls) {
        uint8_t side = 0;
        float least[Convex::mostPlanes];
        std::fill_n(least, s.planes, 3e38f);
        const Vector<real> middle = intoDomain(all.c, s.middle);
        for (int i = cluster * clusterSize; i < (cluster + 1) * clusterSize; ++i) {
            if (p.id[i] < 0) continue;
            const int solid = walls ? all.solidOf[p.id[i] - all.firstId] : -1;
            if (solid >= 0 && all.solids[solid].grace > 0) side = side::Owned;
            const Vector<real> arm = imageOf(all.c, load(p.position, i) - middle);
            for (int k = 0; k < s.planes; ++k)
                least[k] = std::min(least[k],
                                    dot(arm, turned(s, s.normal[k])) - s.offset[k] - s.beyond[k]);
        }
        // Of a solid that is periodic another image might be on the way. Cells of boundary
        // particles begin half a spacing before their middles.
        const float clear = walls ? 0.51f * all.spacing : 0;
        for (int k = 0; k < s.planes; ++k)
            side |= least[k] > reach ? side::Far : least[k] > clear && !all.c.periodic ? 1 << k : 0;
        return side;
    }
    const uint8_t* sidesOf(uint32_t cluster) const {
        return sides.data() + size_t(cluster) * size_t(screens);
    }
    void computeOne(const Particles& p, int cluster) {
        const float* x = p.position.data + vectorOffset(cluster * clusterSize, 0);
        const int* id = p.id + cluster * clusterSize;
        for (int k = 0; k < 3; ++k) {
            float lo = 3e38f, hi = -3e38f;
            for (int l = 0; l < clusterSize; ++l) {
                const float value = x[k * clusterSize + l];
                lo = id[l] >= 0 && value < lo ? value : lo;
                hi = id[l] >= 0 && value > hi ? value : hi;
            }
            low[k][cluster] = lo;
            high[k][cluster] = hi;
        }
    }
};

// What lists of one set in another have to know of thin solids; screens: null where there is none.
struct Sight {
    const Screens* screens = nullptr;
    Between between = Between::Nobody;
    Particles own{}, other{};

    // Whether no solid can be between particles of two clusters.
    bool isFree(const uint8_t* a, const uint8_t* b) const {
        for (int k = 0; k < screens->count; ++k) {
            if ((a[k] | b[k]) & side::Owned) return false;
            if (!(a[k] & b[k] & side::Planes) && !((a[k] | b[k]) & side::Far)) return false;
        }
        return true;
    }
    // How much of each other the pairs of two clusters see, as they are now: all, some, or
    // nothing. Empty slots and pairs out of reach say nothing.
    enum Seen { All, Some, Nothing };
    Seen pairsOf(int c, int j, float reach, PairsApart& apart) const {
        bool anySeen = false, anyApart = false;
        const int* wallId = between == Between::WallsAndFluid ? own.id : other.id;
        for (int l = 0; l < clusterSize * clusterSize; ++l) {
            const int a = c * clusterSize + l / clusterSize, b = j * clusterSize + l % clusterSize;
            const Vector<real> x = load(own.position, a),
                               r = imageOf(screens->c, x - load(other.position, b));
            const bool counts = own.id[a] >= 0 && other.id[b] >= 0 && dot(r, r) < reach * reach;
            const real by = counts ? apartOf(*screens, wallId, between, a, b, x, r) : real(0);
            anySeen = anySeen || (counts && by < hidden), anyApart = anyApart || by > 0;
            apart.of[l] = by;
        }
        return !anyApart ? All : anySeen ? Some : Nothing;
    }
};

}  // namespace spindrift::LANES
