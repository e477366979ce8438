#pragma once
// A tree of boxes around things that lie near each other: halves, by their middles along the
// longest side, down to a few things.
#include "core/vec.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace spindrift {

struct Box {
    Vec3d low, high;
};
inline Vec3d lower(Vec3d a, Vec3d b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3d upper(Vec3d a, Vec3d b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

class BoxTree {
public:
    // The order into which the caller has to bring the things; from then on they are known by their
    // place in it.
    std::vector<int> build(const std::vector<Box>& things) {
        nodes_.clear();
        std::vector<int> order(things.size());
        std::iota(order.begin(), order.end(), 0);
        if (!order.empty()) divide(things, order, 0, int(order.size()));
        return order;
    }

    // Calls thing(i) for those in boxes that are entered.
    template <class Enter, class Thing> void visit(const Enter& enter, const Thing& thing) const {
        int open[MostOpen], count = 0;
        if (!nodes_.empty()) open[count++] = 0;
        while (count > 0) {
            const int index = open[--count];
            const Node& node = nodes_[size_t(index)];
            if (!enter(node.box)) continue;
            for (int i = node.first; i < node.first + node.count; ++i) thing(i);
            if (node.count == 0) open[count++] = node.right, open[count++] = index + 1;
        }
    }
    // The same for those that may lie nearer to p than the root of `nearest2`, which thing()
    // lowers.
    template <class Thing>
    void visitNearer(Vec3d p, const double& nearest2, const Thing& thing) const {
        struct Open {
            int node;
            double distance2;
        } open[MostOpen];
        int count = 0;
        const auto known = [&](int n) { return Open{n, distance2(nodes_[size_t(n)].box, p)}; };
        if (!nodes_.empty()) open[count++] = known(0);
        while (count > 0) {
            const Open now = open[--count];
            if (now.distance2 >= nearest2) continue;
            const Node& node = nodes_[size_t(now.node)];
            for (int i = node.first; i < node.first + node.count; ++i) thing(i);
            if (node.count > 0) continue;
            const Open left = known(now.node + 1), right = known(node.right);
            const bool leftFirst = left.distance2 <= right.distance2;
            open[count++] = leftFirst ? right : left;
            open[count++] = leftFirst ? left : right;
        }
    }

private:
    static constexpr int FewThings = 4, MostOpen = 64;  // halves make it no deeper than that
    struct Node {
        Box box;
        int first, count, right;
    };  // without things there is a left node, the next one, and a right one

    static double distance2(const Box& box, Vec3d p) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            const double beyond = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
            sum += beyond * beyond;
        }
        return sum;
    }
    int divide(const std::vector<Box>& things, std::vector<int>& order, int first, int count) {
        const int index = int(nodes_.size());
        Box box = things[size_t(order[size_t(first)])];
        for (int i = first; i < first + count; ++i) {
            const Box& thing = things[size_t(order[size_t(i)])];
            box = {lower(box.low, thing.low), upper(box.high, thing.high)};
        }
        nodes_.push_back({box, first, count, -1});
        if (count <= FewThings) return index;
        const Vec3d size = box.high - box.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0
                         : size.y >= size.z                   ? 1
                                                              : 2,
                  half = count / 2;
        const auto middle = [&](int i) {
            return things[size_t(i)].low[axis] + things[size_t(i)].high[axis];
        };
        const auto begin = order.begin() + first;
        std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
            return std::pair(middle(a), a) < std::pair(middle(b), b);
        });
        nodes_[size_t(index)].count = 0;
        divide(things, order, first, half);
        const int right = divide(things, order, first + half, count - half);
        nodes_[size_t(index)].right = right;
        return index;
    }

    std::vector<Node> nodes_;
};

}  // namespace spindrift
