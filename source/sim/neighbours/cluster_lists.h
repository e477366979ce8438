// Neighbour lists for SIMD lanes: for each cluster of four particles the clusters that may hold
// neighbours. Rows of cells narrow the choice, bounding boxes decide. Built once a step or less
// often, read by every neighbour pass. Of a set with itself they may hold each pair once, in the
// list of the earlier cluster, and no cluster with itself.
#pragma once

#include "core/error.h"
#include "core/pass_time.h"
#include "sim/neighbours/cluster_boxes.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::LANES {

// The lists of all clusters of one set (own) in a set (other).
class ClusterLists {
public:
    ClusterList* data() { return lists_.data(); }
    int64_t bytes() const {
        size_t numbers = 0;
        for (const auto* arenas : {&entries_, &inner_})
            for (const std::vector<uint32_t>& arena : *arenas) numbers += arena.capacity();
        return int64_t(lists_.capacity() * sizeof(ClusterList) + listed_.capacity() +
                       (numbers + ends_.capacity()) * sizeof(uint32_t));
    }
    // If each pair is in one list only; within a cluster all look at all.
    PairsSeen pairsSeen() const {
        const double inside = double(lists_.size()) * clusterSize * clusterSize;
        PairsSeen seen{inside, inside};
        for (const ClusterList& list : lists_) {
            seen.first += double(list.count) * clusterSize * clusterSize;
            seen.later += double(ICluster::size == clusterSize ? list.innerCount : list.count) *
                          clusterSize * clusterSize;
        }
        return seen;
    }
    // One beyond the last cluster that clusters [begin, end) have in their lists or are themselves.
    int endOf(int begin, int end) const {
        return int(*std::max_element(ends_.begin() + begin / piece_,
                                     ends_.begin() + (end - 1) / piece_ + 1));
    }

    // Particles have another order or places: what there is holds no longer.
    void invalidate(const Particles& own) {
        const size_t clusters = size_t(own.slots / clusterSize);
        lists_.assign(clusters, ClusterList{});
        listed_.assign(clusters, false);
        complete_ = false;
        piece_ = std::max(64, (int(clusters) + 255) / 256);
        entries_.resize((clusters + piece_ - 1) / piece_);
        inner_.resize(entries_.size());
        apart_.resize(entries_.size()), innerApart_.resize(entries_.size());
        ends_.resize(entries_.size());
        for (size_t p = 0; p < ends_.size(); ++p)
            ends_[p] = uint32_t(std::min(clusters, (p + 1) * piece_));
    }
    // Makes the lists that are wanted and not there: of all clusters, or with `active` of those of
    // which it says more than Inactive. Boxes and cells are those of when the last ones were
    // forgotten.
    template <class Device> void build(Device& device, const Grid& grid, float reach,
                                       const ClusterBoxes& own, const uint8_t* active,
                                       const ClusterBoxes& other, const int* otherCellStart,
                                       bool once = false, const Sight& sight = {}) {
        if (complete_ || otherCellStart[cellCount(grid)] == 0) return;
        complete_ = !active;
        const Search search{grid,
                            reach,
                            own,
                            active,
                            other,
                            otherCellStart,
                            once,
                            sight,
                            {periodOf(grid.wraps.x, grid.cells.x, grid.perMetre.x),
                             periodOf(grid.wraps.y, grid.cells.y, grid.perMetre.y),
                             periodOf(grid.wraps.z, grid.cells.z, grid.perMetre.z)}};
        device.forRanges(int(lists_.size()), piece_, [&](int begin, int end) {
            const int piece = begin / piece_;
            bool misses = false;
            for (int c = begin; c < end && !misses; ++c) misses = search.wants(c) && !listed_[c];
            if (misses) ends_[piece] = buildPiece(begin, end, search, piece);
        });
    }

private:
    struct Search {
        const Grid& grid;
        float reach;
        const ClusterBoxes& own;
        const uint8_t* active;
        const ClusterBoxes& other;
        const int* cellStart;
        bool once;
        const Sight& sight;
        float period[3];  // m, 0 where there is none
        bool wants(int cluster) const { return !active || active[cluster] > Inactive; }
    };
    static float periodOf(int wraps, int cells, float perMetre) {
        return wraps ? float(cells) / perMetre : 0;
    }
    static size_t cellCount(const Grid& g) { return size_t(g.cells.x) * g.cells.y * g.cells.z; }

    uint32_t buildPiece(int begin, int end, const Search& s, int piece) {
        std::vector<uint32_t>&entries = entries_[piece], &inner = inner_[piece];
        std::vector<PairsApart>&apart = apart_[piece], &innerApart = innerApart_[piece];
        apart.clear();
        size_t used = 0;
        uint32_t farthest = uint32_t(end);
        for (int first = begin, last; first < end; first = last) {
            last = endOfGroup(s, first, end);
            bool wanted = false;
            for (int c = first; c < last; ++c) wanted = wanted || listed_[c] || s.wants(c);
            if (!wanted) continue;
            const RowRanges ranges = findRows(s, first, last);
            if (entries.size() < used + (ranges.clusters + width) * clustersTogether)
                entries.resize(2 * (used + (ranges.clusters + width) * clustersTogether));
            for (int c = first; c < last; ++c) {
                const size_t before = used;
                for (int r = 0; r < ranges.count; ++r) {
                    const uint32_t from =
                        s.once ? std::max(ranges.first[r], uint32_t(c) + 1) : ranges.first[r];
                    if (from >= ranges.last[r]) continue;
                    used += keepNear(s, c, from, ranges.last[r], entries.data() + used);
                    if (used > before) farthest = std::max(farthest, entries[used - 1] + 1);
                }
                lists_[c].count = lists_[c].clear = uint32_t(used - before);
                if (s.sight.screens) {
                    hide(s, c, entries.data() + before, apart);
                    used = before + lists_[c].count;
                }
                listed_[c] = true;
            }
        }
        // The arena may have moved while it grew: only now are addresses known.
        inner.resize(entries.size()), innerApart.resize(apart.size() + 1);
        size_t next = 0, nextApart = 0;
        for (int c = begin; c < end; ++c) {
            ClusterList& list = lists_[c];
            list.clusters = entries.data() + next, list.inner = inner.data() + next;
            if (list.within) list.within = apart.data() + nextApart++;
            list.apart = apart.data() + nextApart;
            list.innerApart = innerApart.data() + nextApart;
            next += list.count, nextApart += list.count - list.clear;
        }
        return farthest;
    }

    // Of cluster c's entries leaves out those whom thin solids hide from it, and puts those last of
    // whom they hide a part.
    void hide(const Search& s, int c, uint32_t* entries, std::vector<PairsApart>& apart) {
        ClusterList& list = lists_[c];
        const uint8_t* own = s.own.sidesOf(uint32_t(c));
        std::vector<uint32_t> partly;
        uint32_t clear = 0;
        PairsApart pairs;
        if (s.once && !s.sight.isFree(own, own) &&
            s.sight.pairsOf(c, c, s.reach, pairs) != Sight::All) {
            apart.push_back(pairs);
            list.within = &apart.back();  // until addresses are known
        }
        for (uint32_t k = 0; k < list.count; ++k) {
            const uint32_t j = entries[k];
            const auto seen = s.sight.isFree(own, s.other.sidesOf(j))
                                  ? Sight::All
                                  : s.sight.pairsOf(c, int(j), s.reach, pairs);
            if (seen == Sight::All)
                entries[clear++] = j;
            else if (seen == Sight::Some)
                partly.push_back(j), apart.push_back(pairs);
        }
        std::copy(partly.begin(), partly.end(), entries + clear);
        list.clear = clear, list.count = clear + uint32_t(partly.size());
    }

    // Clusters whose rows are searched together: a few that lie in one row.
    static constexpr int clustersTogether = 4;
    static int endOfGroup(const Search& s, int first, int end) {
        const float rowSize[3] = {0, 1.01f / s.grid.perMetre.y, 1.01f / s.grid.perMetre.z};
        auto sameRow = [&](int c) {
            for (int k : {1, 2})
                if (std::max(s.own.high[k][c], s.own.high[k][first]) -
                        std::min(s.own.low[k][c], s.own.low[k][first]) >
                    rowSize[k])
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
        const float reach2 = s.reach * s.reach;
        const Rows inZ = rowsWithin(g.rowZ(low[2] - s.reach), g.rowZ(high[2] + s.reach), g.cells.z,
                                    g.low.z, 1 / g.perMetre.z);
        const Rows inY = rowsWithin(g.rowY(low[1] - s.reach), g.rowY(high[1] + s.reach), g.cells.y,
                                    g.low.y, 1 / g.perMetre.y);
        RowRanges ranges;
        for (int z = inZ.first; z <= inZ.last; ++z) {
            const float gapZ = inZ.gap(z, low[2], high[2]);
            for (int y = inY.first; y <= inY.last; ++y) {
                const float gapY = inY.gap(y, low[1], high[1]);
                const float left2 = reach2 - gapY * gapY - gapZ * gapZ;
                if (left2 <= 0) continue;
                const float left = std::sqrt(left2);
                const int* row = s.cellStart + g.row(y, z);
                uint32_t done = 0;  // two stretches of a row may share a cluster
                forStretches(g.cellX(low[0] - left), g.cellX(high[0] + left), g.cells.x,
                             [&](int from, int to) {
                                 const uint32_t end =
                                     uint32_t((row[to + 1] + clusterSize - 1) / clusterSize);
                                 ranges.add(std::max(done, uint32_t(row[from] / clusterSize)), end);
                                 done = end;
                             });
            }
        }
        return ranges;
    }

    // Rows of cells along y or z, images included.
    struct Rows {
        int first, last;
        bool all;         // then the nearest image of a row is not known
        float low, size;  // m
        float gap(int row, float from, float to) const {
            return all ? 0 : rowGap(low + float(row) * size, size, from, to);
        }
    };
    static Rows rowsWithin(int first, int last, int n, float low, float size) {
        if (last - first + 1 > n) return {0, n - 1, true, low, size};
        return {first, last, false, low, size};
    }

    // Distance from the interval [lo, hi] to a row; rows at the rim are taken as endless, they hold
    // what is outside.
    static float rowGap(float rowLow, float rowSize, float lo, float hi) {
        const float slack =
            1e-3f * rowSize;  // a particle on the face may have been rounded into the next row
        return std::max(0.0f, std::max(rowLow - hi, lo - rowLow - rowSize) - slack);
    }

    // Gap between intervals, nearest images taken.
    using Wides = hn::Vec<WideTag>;
    HD static Wides gapBetween(Wides low, Wides high, float ownLow, float ownHigh, float period) {
        const WideTag d;
        const auto gap =
            hn::Max(hn::Sub(low, hn::Set(d, ownHigh)), hn::Sub(hn::Set(d, ownLow), high));
        if (period <= 0) return gap;
        const auto above = hn::Sub(hn::Add(low, hn::Set(d, period)), hn::Set(d, ownHigh));
        const auto below = hn::Sub(hn::Add(hn::Set(d, ownLow), hn::Set(d, period)), high);
        return hn::Min(gap, hn::Min(above, below));
    }

    // Of the clusters in [first, last) those whose box is nearer than `reach` to the box of cluster
    // c.
    static int keepNear(const Search& s, int c, uint32_t first, uint32_t last, uint32_t* out) {
        const WideTag d;
        const hn::RebindToUnsigned<WideTag> du;
        int kept = 0;
        for (uint32_t j = first; j < last; j += width) {
            auto distance2 = hn::Zero(d);
            for (int k = 0; k < 3; ++k) {
                const auto gap = gapBetween(hn::LoadU(d, s.other.low[k].data() + j),
                                            hn::LoadU(d, s.other.high[k].data() + j),
                                            s.own.low[k][c], s.own.high[k][c], s.period[k]);
                const auto apart = hn::Max(gap, hn::Zero(d));
                distance2 = hn::MulAdd(apart, apart, distance2);
            }
            const auto near =
                hn::And(hn::Lt(distance2, hn::Set(d, s.reach * s.reach)), hn::FirstN(d, last - j));
            const auto index = hn::Add(hn::Iota(du, 0), hn::Set(du, j));
            // Compressing to memory takes some hundred cycles on Zen 4; through a register it is
            // cheap everywhere.
            hn::StoreU(hn::Compress(index, hn::RebindMask(du, near)), du, out + kept);
            kept += int(hn::CountTrue(d, near));
        }
        return kept;
    }

    int piece_ = 1;
    bool complete_ = false;
    std::vector<uint8_t> listed_;  // which clusters have their list
    std::vector<uint32_t> ends_;   // a piece: one beyond the last cluster in its lists
    std::vector<ClusterList> lists_;
    std::vector<std::vector<uint32_t>> entries_,
        inner_;  // one arena a piece, kept from step to step
    std::vector<std::vector<PairsApart>> apart_, innerApart_;
};

}  // namespace spindrift::LANES
