#include "scene/mesh_shells.h"

#include "core/error.h"
#include "scene/box_tree.h"
#include "scene/mesh_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>

namespace spindrift {
namespace {

using Triangle = std::array<int, 3>;

constexpr double Precision = 1e-6;    // of the size
constexpr double LeastVolume = 1e-9;  // of a cube whose sides have its area

// As a file has it, of single precision too.
std::string shown(double a) {
    return double(float(a)) == a ? fmt::format("{}", float(a)) : fmt::format("{:.12g}", a);
}
std::string shown(Vec3d p) {
    return fmt::format("({}, {}, {})", shown(p.x), shown(p.y), shown(p.z));
}

Box boxOf(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles) {
    Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (const Triangle& t : triangles)
        for (const int v : t)
            box = {lower(box.low, vertices[size_t(v)]), upper(box.high, vertices[size_t(v)])};
    return box;
}

// For each vertex one that lies within the tolerance: always the first of them in the order of
// their coordinates, whatever the file's order is.
std::vector<int> joined(const std::vector<Vec3d>& vertices, double tolerance) {
    std::vector<int> order(vertices.size()), same(vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int v) {
        const Vec3d& p = vertices[size_t(v)];
        return std::tie(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    const double cell = 8 * tolerance;
    std::unordered_map<uint64_t, std::vector<int>> cells;
    const auto cellOf = [&](double x, double y, double z) {
        const auto part = [&](double a, uint64_t prime) {
            return uint64_t(int64_t(std::floor(a / cell))) * prime;
        };
        return part(x, 73856093) ^ part(y, 19349663) ^ part(z, 83492791);
    };
    const auto find = [&](Vec3d p) -> std::optional<int> {
        uint64_t last = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const auto side = [&](int axis) {
                return p[axis] + (corner >> axis & 1 ? tolerance : -tolerance);
            };
            const uint64_t at = cellOf(side(0), side(1), side(2));
            if (corner > 0 && at == last) continue;
            last = at;
            if (const auto found = cells.find(at); found != cells.end())
                for (const int v : found->second)
                    if (length(vertices[size_t(v)] - p) <= tolerance) return v;
        }
        return {};
    };
    for (size_t i = 0; i < order.size(); ++i) {
        const int v = order[i];
        const Vec3d p = vertices[size_t(v)];
        if (i > 0 && key(v) == key(order[i - 1])) {
            same[size_t(v)] = same[size_t(order[i - 1])];
            continue;
        }
        const std::optional<int> found = find(p);
        same[size_t(v)] = found.value_or(v);
        if (!found) cells[cellOf(p.x, p.y, p.z)].push_back(v);
    }
    return same;
}

// A use of an edge by a triangle.
struct Use {
    int low, high;  // vertices
    bool upward;    // from the lower one to the higher
    int triangle;
};

class ShellFinder {
public:
    ShellFinder(const std::string& name, std::vector<Vec3d> vertices,
                std::vector<Triangle> triangles)
        : name_(name), vertices_(std::move(vertices)), triangles_(std::move(triangles)) {}

    ShellNet find(double roundOff) {
        weld(roundOff);
        countDoubled();
        findEdges();
        do findPatches();
        while (dropNeedless());
        requireClosed();
        return shells(findCells());
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(Failure::Scene, fmt::format("{}: {}", name_, what));
    }
    std::string edge(const Use& use) const {
        return fmt::format("the edge from {} to {}", shown(vertices_[size_t(use.low)]),
                           shown(vertices_[size_t(use.high)]));
    }
    [[noreturn]] void refuseToOrient(const Use& use) const {
        refuse(
            fmt::format("has one side only, as a Moebius strip: at {} it can't be said which is "
                        "outside; make a surface that encloses a volume",
                        edge(use)));
    }

    void weld(double roundOff) {
        for (const Triangle& t : triangles_)
            for (const int v : t)
                if (v < 0 || v >= int(vertices_.size()))
                    refuse("a face has a corner that is not there");
        if (triangles_.empty())
            refuse("has no faces; it needs a closed surface of triangles or polygons");
        const Box box = boxOf(vertices_, triangles_);
        precision_ = std::max(Precision * length(box.high - box.low), roundOff);
        const std::vector<int> same = joined(vertices_, precision_);
        const std::vector<int> parts = partsOf(triangles_, vertices_.size());
        for (Triangle& t : triangles_)
            for (int& v : t) v = same[size_t(v)];
        separate(parts);
        std::erase_if(triangles_, [](const Triangle& t) {
            return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        });
        if (triangles_.empty()) refuse("encloses no volume; thicken it");
    }

    // Which triangles have corners in common by their numbers in the file.
    static std::vector<int> partsOf(const std::vector<Triangle>& triangles, size_t vertices) {
        std::vector<int> parents(vertices), parts;
        std::iota(parents.begin(), parents.end(), 0);
        const auto root = [&](int v) {
            while (parents[size_t(v)] != v)
                v = parents[size_t(v)] = parents[size_t(parents[size_t(v)])];
            return v;
        };
        for (const Triangle& t : triangles)
            for (const int v : t) parents[size_t(root(v))] = root(t[0]);
        for (const Triangle& t : triangles) parts.push_back(root(t[0]));
        return parts;
    }
    // A part of the file that is closed keeps corners of its own, also where it touches others.
    void separate(const std::vector<int>& parts) {
        std::map<int, std::vector<size_t>> members;
        for (size_t t = 0; t < parts.size(); ++t) members[parts[t]].push_back(t);
        for (const auto& [part, triangles] : members) {
            if (triangles.size() == triangles_.size() || !isClosed(triangles)) continue;
            std::unordered_map<int, int> own;
            for (const size_t t : triangles)
                for (int& v : triangles_[t]) {
                    const auto [found, isNew] = own.try_emplace(v, int(vertices_.size()));
                    if (isNew) vertices_.push_back(Vec3d(vertices_[size_t(v)]));
                    v = found->second;
                }
        }
    }
    bool isClosed(const std::vector<size_t>& triangles) const {
        std::vector<std::pair<int, int>> edges;
        for (const size_t t : triangles)
            for (size_t k = 0; k < 3; ++k)
                if (const int a = triangles_[t][k], b = triangles_[t][(k + 1) % 3]; a != b)
                    edges.push_back({std::min(a, b), std::max(a, b)});
        std::sort(edges.begin(), edges.end());
        for (size_t i = 0, end; i < edges.size(); i = end) {
            for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
            if ((end - i) % 2 == 1) return false;
        }
        return true;
    }

    // Triangles that are there several times.
    void countDoubled() {
        std::vector<std::pair<Triangle, size_t>> sorted;
        for (size_t t = 0; t < triangles_.size(); ++t) {
            Triangle key = triangles_[t];
            std::sort(key.begin(), key.end());
            sorted.push_back({key, t});
        }
        std::sort(sorted.begin(), sorted.end());
        std::vector<Triangle> once;
        for (size_t i = 0, end; i < sorted.size(); i = end) {
            for (end = i; end < sorted.size() && sorted[end].first == sorted[i].first;) ++end;
            once.push_back(triangles_[sorted[i].second]), times_.push_back(int(end - i));
        }
        triangles_ = std::move(once);
    }
    int thirdOf(const Use& use) const {
        const Triangle& t = triangles_[size_t(use.triangle)];
        return t[0] + t[1] + t[2] - use.low - use.high;
    }

    void findEdges() {
        uses_.clear(), edges_.clear();
        edgeOf_.assign(triangles_.size(), {});
        for (size_t t = 0; t < triangles_.size(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                const int from = triangles_[t][k], to = triangles_[t][(k + 1) % 3];
                uses_.push_back({std::min(from, to), std::max(from, to), from < to, int(t)});
            }
        std::sort(uses_.begin(), uses_.end(), [](const Use& a, const Use& b) {
            return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
        });
        std::vector<int> found(triangles_.size());
        for (size_t i = 0; i < uses_.size(); ++i) {
            if (i == 0 || uses_[i].low != uses_[i - 1].low || uses_[i].high != uses_[i - 1].high)
                edges_.push_back(i);
            const size_t t = size_t(uses_[i].triangle);
            edgeOf_[t][size_t(found[t]++)] = int(edges_.size()) - 1;
        }
    }
    size_t countOf(size_t edge) const {
        return (edge + 1 < edges_.size() ? edges_[edge + 1] : uses_.size()) - edges_[edge];
    }
    int timesOf(const Use& use) const { return times_[size_t(use.triangle)]; }
    // Of all uses of an edge, the doubled ones too.
    int sumOf(const Use* uses, size_t count) const {
        int sum = 0;
        for (const Use* use = uses; use < uses + count; ++use) sum += timesOf(*use);
        return sum;
    }
    // Whether two triangles go on in each other there.
    bool isSmooth(const Use* uses, size_t count) const {
        return count == 2 && timesOf(uses[0]) == timesOf(uses[1]);
    }
    // Calls f(uses, count) for each edge of a triangle.
    template <class F> void forEdges(int triangle, const F& f) const {
        for (const int e : edgeOf_[size_t(triangle)])
            f(&uses_[edges_[size_t(e)]], countOf(size_t(e)));
    }

    void requireClosed() const {
        size_t wrong = 0;
        const Use* first = nullptr;
        int sum = 0;
        for (size_t e = 0; e < edges_.size(); ++e) {
            const Use* uses = &uses_[edges_[e]];
            const int here = countOf(e) == 1 ? 1 : sumOf(uses, countOf(e));
            if (here % 2 == 1 && wrong++ == 0) first = uses, sum = here;
        }
        if (wrong == 0) return;
        refuse(fmt::format(
            "is not closed: {} belongs to {}, each must to two ({} such edge{}); close the surface "
            "where it was made",
            edge(*first), sum == 1 ? "one triangle" : fmt::format("{} triangles", sum), wrong,
            wrong == 1 ? "" : "s"));
    }

    // Triangles that hang together by edges of two, turned to face the same side.
    void findPatches() {
        patch_.assign(triangles_.size(), -1), turned_.assign(triangles_.size(), 0);
        patches_ = 0, oneSided_.reset();
        for (size_t t = 0; t < triangles_.size(); ++t) {
            if (patch_[t] >= 0) continue;
            std::vector<int> reached{int(t)};
            patch_[t] = patches_;
            for (size_t i = 0; i < reached.size(); ++i)
                forEdges(reached[i], [&](const Use* uses, size_t count) {
                    if (!isSmooth(uses, count)) return;
                    const bool opposed = uses[0].upward == uses[1].upward;
                    const size_t next = size_t(uses[uses[0].triangle == reached[i]].triangle);
                    const char turned = char(turned_[size_t(reached[i])] ^ char(opposed));
                    if (patch_[next] >= 0 && turned_[next] != turned) oneSided_ = *uses;
                    if (patch_[next] >= 0) return;
                    patch_[next] = patches_, turned_[next] = turned, reached.push_back(int(next));
                });
            ++patches_;
        }
    }
    // One that is once too often there to be closed with what is beside it was written once too
    // often.
    bool dropNeedless() {
        std::vector<char> closes(size_t(patches_), 0), tooMany(size_t(patches_), 0);
        for (size_t t = 0; t < triangles_.size(); ++t)
            forEdges(int(t), [&](const Use* uses, size_t count) {
                if (isSmooth(uses, count)) return;
                (sumOf(uses, count) % 2 == 1 ? tooMany : closes)[size_t(patch_[t])] = true;
            });
        bool dropped = false;
        for (size_t t = 0; t < triangles_.size(); ++t)
            if (const size_t p = size_t(patch_[t]); times_[t] > 1 && tooMany[p] && !closes[p])
                --times_[t], dropped = true;
        return dropped;
    }

    std::vector<Patch> patches(Vec3d from) const {
        std::vector<Patch> found{size_t(patches_)};
        for (size_t t = 0; t < triangles_.size(); ++t) {
            Patch& p = found[size_t(patch_[t])];
            p.times = times_[t];
            const auto arm = [&](size_t k) { return vertices_[size_t(triangles_[t][k])] - from; };
            p.volume += (turned_[t] ? -1 : 1) * dot(arm(0), cross(arm(1), arm(2))) / 6;
        }
        return found;
    }
    bool isUpward(const Use& use) const {
        return use.upward != bool(turned_[size_t(use.triangle)]);
    }
    // What ends at an edge and goes on in others there. Nothing, where each patch goes on in
    // itself.
    std::vector<Sheet> sheetsAt(const Use* uses, size_t count) const {
        std::map<int, int> sums;
        for (const Use* use = uses; use < uses + count; ++use)
            sums[patch_[size_t(use->triangle)]] += isUpward(*use) ? 1 : -1;
        if (std::all_of(sums.begin(), sums.end(), [](const auto& s) { return s.second == 0; }))
            return {};
        const Vec3d along =
                        normalized(vertices_[size_t(uses->high)] - vertices_[size_t(uses->low)]),
                    first = away(*uses, along).way, second = cross(along, first);
        std::vector<Sheet> sheets;
        for (const Use* use = uses; use < uses + count; ++use) {
            const Away to = away(*use, along);
            sheets.push_back({patch_[size_t(use->triangle)], isUpward(*use),
                              std::atan2(dot(to.way, second), dot(to.way, first)),
                              4 * precision_ / std::max(to.far, precision_)});
        }
        return sheets;
    }
    MeshCells findCells() const {
        if (oneSided_) refuseToOrient(*oneSided_);
        MeshCells cells(patches(vertices_[size_t(triangles_[0][0])]));
        for (size_t e = 0; e < edges_.size(); ++e) {
            const Use* uses = &uses_[edges_[e]];
            if (isSmooth(uses, countOf(e))) continue;
            if (auto sheets = sheetsAt(uses, countOf(e)); !sheets.empty())
                cells.meet(std::move(sheets));
        }
        if (!cells.solve())
            refuse("it can't be said where its inside is; make it of closed surfaces");
        return cells;
    }
    // From its edge into a triangle, and how far that goes.
    struct Away {
        Vec3d way;
        double far;
    };
    Away away(const Use& use, Vec3d along) const {
        const Vec3d d = vertices_[size_t(thirdOf(use))] - vertices_[size_t(use.low)],
                    across = d - dot(d, along) * along;
        const double far = length(across);
        return {far > 0 ? (1 / far) * across : across, far};
    }

    // Each triangle as often as more solids are behind it than before it.
    ShellNet shells(const MeshCells& cells) const {
        ShellNet net{vertices_, {}, {}, 0, precision_};
        std::map<int, int> common, numbers;  // of groups of patches
        std::map<int, std::pair<double, double>> sizes;
        const Vec3d from = vertices_[size_t(triangles_[0][0])];
        for (size_t t = 0; t < triangles_.size(); ++t) {
            const int group = cells.groupOf(patch_[t]), jump = cells.jump(patch_[t]);
            common[group] = std::gcd(common[group], jump);
            const auto arm = [&](size_t k) { return vertices_[size_t(triangles_[t][k])] - from; };
            auto& [volume, area] = sizes[group];
            volume += (turned_[t] ? -jump : jump) * dot(arm(0), cross(arm(1), arm(2))) / 6;
            area += std::abs(jump) * length(cross(arm(1) - arm(0), arm(2) - arm(0))) / 2;
        }
        for (size_t t = 0; t < triangles_.size(); ++t) {
            const int group = cells.groupOf(patch_[t]), jump = cells.jump(patch_[t]);
            const auto [volume, area] = sizes[group];
            if (volume <= LeastVolume * std::pow(area, 1.5) || jump == 0) continue;
            const auto [number, isNew] = numbers.try_emplace(group, net.shellCount);
            net.shellCount += isNew;
            Triangle n = triangles_[t];
            if (bool(turned_[t]) != (jump < 0)) std::swap(n[1], n[2]);
            const size_t copies = size_t(std::abs(jump) / common[group]);
            net.triangles.insert(net.triangles.end(), copies, n);
            net.shells.insert(net.shells.end(), copies, number->second);
        }
        if (net.triangles.empty()) refuse("encloses no volume; thicken it");
        return net;
    }

    const std::string& name_;
    std::vector<Vec3d> vertices_;
    std::vector<Triangle> triangles_;
    double precision_ = 0;
    std::vector<Use> uses_;                   // of one edge after the other
    std::vector<size_t> edges_;               // where the uses of each begin
    std::vector<std::array<int, 3>> edgeOf_;  // of each triangle
    std::vector<int> times_;                  // that each triangle is there
    int patches_ = 0;
    std::vector<int> patch_;
    std::vector<char> turned_;
    std::optional<Use> oneSided_;  // where a patch meets itself the other way round
};

}  // namespace

ShellNet findShells(const std::string& name, std::vector<Vec3d> vertices,
                    std::vector<std::array<int, 3>> triangles, double roundOff) {
    return ShellFinder(name, std::move(vertices), std::move(triangles)).find(roundOff);
}

}  // namespace spindrift
