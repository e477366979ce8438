// Neighbour lists for SIMD lanes: for each cluster of four particles the clusters that may hold neighbours. Rows of
// cells narrow the choice, bounding boxes decide. Built once a step, read by every neighbour pass of the step.
#if defined(SPINDRIFT_SIM_CLUSTER_LISTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_CLUSTER_LISTS_H
#undef SPINDRIFT_SIM_CLUSTER_LISTS_H
#else
#define SPINDRIFT_SIM_CLUSTER_LISTS_H
#endif

#include "core/error.h"
#include "device/omp.h"
#include "sim/view.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::LANES {

// Bounding boxes of a set's clusters, empty slots left out; component by component for SIMD tests.
struct ClusterBoxes {
    std::vector<float> low[3], high[3];

    void compute(Omp& device, const Particles& p) {
        const int clusters = p.slots / clusterSize;
        for (int k = 0; k < 3; ++k) {
            low[k].resize(clusters + width);   // tests read whole registers
            high[k].resize(clusters + width);
        }
        device.forRanges(clusters, 256, [&](int begin, int end) {
            for (int c = begin; c < end; ++c) computeOne(p, c);
        });
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

// The lists of all clusters of one set (own) in a set (other).
class ClusterLists {
public:
    ClusterList* data() { return lists_.data(); }
    int64_t bytes() const {
        size_t numbers = 0;
        for (const auto* arenas : {&entries_, &pruned_})
            for (const std::vector<uint32_t>& arena : *arenas) numbers += arena.capacity();
        return int64_t(lists_.capacity() * sizeof(ClusterList) + numbers * sizeof(uint32_t));
    }

    void build(Omp& device, const Grid& grid, float reach, const ClusterBoxes& own, const Particles& ownParticles,
               const ClusterBoxes& other, const int* otherCellStart) {
        const int clusters = ownParticles.slots / clusterSize;
        lists_.resize(clusters);
        const int piece = std::max(64, (clusters + 255) / 256);
        entries_.resize((clusters + piece - 1) / piece);
        pruned_.resize(entries_.size());
        if (otherCellStart[cellCount(grid)] == 0) {
            std::fill(lists_.begin(), lists_.end(), ClusterList{});
            return;
        }
        device.forRanges(clusters, piece, [&](int begin, int end) {
            buildPiece(begin, end, Search{grid, reach, own, other, otherCellStart}, entries_[begin / piece],
                       pruned_[begin / piece]);
        });
    }

private:
    struct Search {
        const Grid& grid;
        float reach;
        const ClusterBoxes& own;
        const ClusterBoxes& other;
        const int* cellStart;
    };
    static size_t cellCount(const Grid& g) { return size_t(g.cells.x) * g.cells.y * g.cells.z; }

    void buildPiece(int begin, int end, const Search& s, std::vector<uint32_t>& entries, std::vector<uint32_t>& pruned) {
        size_t used = 0;
        for (int first = begin, last; first < end; first = last) {
            last = endOfGroup(s, first, end);
            const RowRanges ranges = findRows(s, first, last);
            if (entries.size() < used + (ranges.clusters + width) * clustersTogether)
                entries.resize(2 * (used + (ranges.clusters + width) * clustersTogether));
            for (int c = first; c < last; ++c) {
                const size_t before = used;
                for (int r = 0; r < ranges.count; ++r)
                    used += keepNear(s, c, ranges.first[r], ranges.last[r], entries.data() + used);
                lists_[c].count = uint32_t(used - before);
            }
        }
        // The arena may have moved while it grew: only now are addresses known.
        pruned.resize(entries.size());
        for (size_t c = size_t(begin), next = 0; c < size_t(end); next += lists_[c++].count) {
            lists_[c].clusters = entries.data() + next;
            lists_[c].pruned = pruned.data() + next;
        }
    }

    // Clusters whose rows are searched together: a few that lie in one row.
    static constexpr int clustersTogether = 4;
    static int endOfGroup(const Search& s, int first, int end) {
        const float rowSize = 1.01f / s.grid.perMetreRow;
        auto sameRow = [&](int c) {
            for (int k : {1, 2})
                if (std::max(s.own.high[k][c], s.own.high[k][first]) - std::min(s.own.low[k][c], s.own.low[k][first]) > rowSize)
                    return false;
            return true;
        };
        int last = first + 1;
        while (last < end && last < first + clustersTogether && sameRow(last)) ++last;
        return last;
    }

    // The other set's clusters that may be near, one range a row of cells.
    struct RowRanges {
        static constexpr int most = 512;
        uint32_t first[most], last[most];
        int count = 0;
        size_t clusters = 0;
        void add(uint32_t from, uint32_t to) {
            if (count > 0) from = std::max(from, last[count - 1]);   // no cluster twice
            if (from >= to) return;
            CHECK(count < most);
            first[count] = from;
            last[count++] = to;
            clusters += to - from;
        }
    };
    static RowRanges findRows(const Search& s, int begin, int end) {
        float low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            low[k] = *std::min_element(s.own.low[k].begin() + begin, s.own.low[k].begin() + end);
            high[k] = *std::max_element(s.own.high[k].begin() + begin, s.own.high[k].begin() + end);
        }
        const Grid& g = s.grid;
        const float reach2 = s.reach * s.reach, rowSize = 1 / g.perMetreRow;
        RowRanges ranges;
        for (int z = g.rowZ(low[2] - s.reach), lastZ = g.rowZ(high[2] + s.reach); z <= lastZ; ++z) {
            const float gapZ = rowGap(g.low.z + z * rowSize, rowSize, low[2], high[2]);
            for (int y = g.rowY(low[1] - s.reach), lastY = g.rowY(high[1] + s.reach); y <= lastY; ++y) {
                const float gapY = rowGap(g.low.y + y * rowSize, rowSize, low[1], high[1]);
                const float left2 = reach2 - gapY * gapY - gapZ * gapZ;
                if (left2 <= 0) continue;
                const float left = std::sqrt(left2);
                const int row = (z * g.cells.y + y) * g.cells.x;
                const int from = s.cellStart[row + g.cellX(low[0] - left)];
                const int to = s.cellStart[row + g.cellX(high[0] + left) + 1];
                ranges.add(uint32_t(from / clusterSize), uint32_t((to + clusterSize - 1) / clusterSize));
            }
        }
        return ranges;
    }

    // Distance from the interval [lo, hi] to a row; rows at the rim are taken as endless, they hold who is outside.
    static float rowGap(float rowLow, float rowSize, float lo, float hi) {
        const float slack = 1e-3f * rowSize;   // a particle on the face may have been rounded into the next row
        return std::max(0.0f, std::max(rowLow - hi, lo - rowLow - rowSize) - slack);
    }

    // Of the clusters in [first, last) those whose box is nearer than `reach` to the box of cluster c.
    static int keepNear(const Search& s, int c, uint32_t first, uint32_t last, uint32_t* out) {
        const WideTag d;
        const hn::RebindToUnsigned<WideTag> du;
        int kept = 0;
        for (uint32_t j = first; j < last; j += width) {
            auto distance2 = hn::Zero(d);
            for (int k = 0; k < 3; ++k) {
                const auto gap = hn::Max(hn::Sub(hn::LoadU(d, s.other.low[k].data() + j), hn::Set(d, s.own.high[k][c])),
                                         hn::Sub(hn::Set(d, s.own.low[k][c]), hn::LoadU(d, s.other.high[k].data() + j)));
                const auto apart = hn::Max(gap, hn::Zero(d));
                distance2 = hn::MulAdd(apart, apart, distance2);
            }
            const auto near = hn::And(hn::Lt(distance2, hn::Set(d, s.reach * s.reach)), hn::FirstN(d, last - j));
            const auto index = hn::Add(hn::Iota(du, 0), hn::Set(du, j));
            // Compressing to memory takes some hundred cycles on Zen 4; through a register it is cheap everywhere.
            hn::StoreU(hn::Compress(index, hn::RebindMask(du, near)), du, out + kept);
            kept += int(hn::CountTrue(d, near));
        }
        return kept;
    }

    std::vector<ClusterList> lists_;
    std::vector<std::vector<uint32_t>> entries_, pruned_;   // one arena a piece, kept from step to step
};

}  // namespace spindrift::LANES

#endif
