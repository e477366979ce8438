// Sums over pairs that a list holds once: what a pair gives to one particle it gives, or its
// opposite, to the other (Newton's third law). Blocks of clusters are summed by one thread each,
// into memory of their own that reaches from the block's first cluster to the last one that its
// lists know; then each particle adds up what the blocks have for it, in their order. Blocks follow
// from the number of particles: the sums don't depend on the number of threads.
#pragma once

#include "sim/neighbours/cluster_lists.h"
#include "sim/neighbours/neighbours.h"

namespace spindrift::LANES {

// Numbers that a sum has a particle, and those that are stored.
HD inline Wide component(Wide a, int) { return a; }
HD inline Wide component(Vector<Wide> a, int k) { return k == 0 ? a.x : k == 1 ? a.y : a.z; }
template <class Field> inline constexpr int components = 1;
template <class Field> inline constexpr int stride = 1;
template <> inline constexpr int components<VectorField> = 3;
template <> inline constexpr int stride<VectorField> = vectorStride;

class HalfListSums {
public:
    int64_t bytes() const {
        size_t numbers = 0;
        for (const std::vector<float>& block : blocks_) numbers += block.capacity();
        return int64_t(numbers * sizeof(float));
    }

    // Adds up pass.of(pair, pass.input(i), pass.input(j)), what a pair gives to i, and
    // Pass::opposite says whether j gets that or its opposite; pass.finish(i) goes on from the sum,
    // which is then in pass.field().
    template <class Device, class Pass>
    void run(Device& device, const ClusterLists& lists, const Pass& pass) {
        const int clusters = pass.v.fluid.slots / clusterSize;
        constexpr int numbers = clusterSize * stride<decltype(pass.field())>;  // a cluster
        const int block = std::max(256, (clusters + mostBlocks - 1) / mostBlocks),
                  count = (clusters + block - 1) / block;
        blocks_.resize(size_t(count));
        device.forTasks(count, [&](int b) {
            const int begin = b * block, end = std::min(clusters, begin + block);
            std::vector<float>& sums = blocks_[size_t(b)];
            sums.clear();
            bool any = false;
            for (int c = begin; c < end && !any; ++c) any = isNear(pass.v.fluid, c);
            if (!any) return;
            sums.assign(size_t(lists.endOf(begin, end) - begin) * numbers + clusterSize,
                        0);           // readable one cluster past its end
            const Pass local = pass;  // else each store to the sums might have changed a constant,
                                      // for all the compiler knows
            for (int i = begin * clusterSize; i < end * clusterSize; i += ICluster::size)
                if (isNear(local.v.fluid, i / clusterSize))
                    sumOnce(local, ICluster{i}, sums.data(), begin);
        });
        device.forTasks(count, [&](int b) {
            const int begin = b * block, end = std::min(clusters, begin + block);
            auto isActiveOne = [&](int c) {
                return isActive<Pass::activeFrom>(pass.v.fluid, c * clusterSize);
            };
            for (int first = begin, last; first < end;
                 first = last) {  // stretches of clusters that are active, or not
                last = first + 1;
                while (last < end && isActiveOne(last) == isActiveOne(first)) ++last;
                if (isActiveOne(first)) addUp<numbers>(b, block, first, last, pass.field().data);
            }
            for (int i = begin * clusterSize; i < end * clusterSize; i += ICluster::size)
                if (isActive<Pass::activeFrom>(pass.v.fluid, ICluster{i})) pass.finish(ICluster{i});
        });
    }

private:
    static constexpr int mostBlocks = 32;

    // Clusters that are active or may have a neighbour that is.
    static bool isNear(const Particles& p, int cluster) {
        return !p.active || p.active[cluster] > Inactive;
    }

    // What blocks [0, b] have for clusters [first, last) of block b.
    template <int numbers> void addUp(int b, int block, int first, int last, float* field) const {
        const size_t count = size_t(last - first) * numbers;
        float* out = field + size_t(first) * numbers;
        std::copy_n(blocks_[size_t(b)].data() + size_t(first - b * block) * numbers, count, out);
        for (int a = 0; a < b; ++a) {
            const std::vector<float>& sums = blocks_[size_t(a)];
            const size_t skipped = size_t(first - a * block) * numbers;
            if (sums.size() <= skipped + clusterSize) continue;
            for (size_t k = 0, n = std::min(sums.size() - clusterSize - skipped, count); k < n; ++k)
                out[k] += sums[skipped + k];
        }
    }

    template <class Pass>
    HD static void sumOnce(const Pass& pass, ICluster i, float* sums, int firstCluster) {
        const View& v = pass.v;
        using Field = decltype(pass.field());
        constexpr int n = components<Field>, numbers = clusterSize * stride<Field>;
        const Vector<Wide> x = load(v.fluid.position, i);
        const auto own = pass.input(i);
        const JCluster same{i.first / clusterSize * clusterSize};
        const PairsApart* within = v.fluidNearFluid.lists[i.first / clusterSize].within;
        const Wide apart = within ? apartOf(*within, i) : Wide(0);
        auto sum = pass.of(makePair(v.c, x, load(v.fluid.position, same), apart), own,
                           pass.input(same));  // each gives itself to all four
        forNeighbours<Pass::lists, Pass::activeFrom>(
            v, v.fluidNearFluid, i, x,
            [&](const auto& p, JCluster j) LANE_CALL {
                const auto given = pass.of(p, own, pass.input(j));
                sum = sum + given;
                float* other = sums + size_t(j.first / clusterSize - firstCluster) * numbers;
                for (int k = 0; k < n; ++k)
                    addToOthers<Pass::opposite>(other + k * clusterSize, component(given, k));
            },
            isActive<Pass::activeFrom>(v.fluid, i) ? nullptr : v.fluid.active);
        const auto whole = total(sum);
        float* at =
            sums + size_t(i.first / clusterSize - firstCluster) * numbers + i.first % clusterSize;
        for (int k = 0; k < n; ++k, at += clusterSize)
            storeAt(at, ICluster{0}, loadAt(at, ICluster{0}) + component(whole, k));
    }

    std::vector<std::vector<float>> blocks_;
};

}  // namespace spindrift::LANES
