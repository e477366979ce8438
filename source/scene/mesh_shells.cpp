#include "scene/mesh_shells.h"

#include "core/error.h"
#include "scene/facet.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

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
        dropDoubled();
        findEdges();
        requireClosed();
        findPatches();
        joinPatches();
        return shells();
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(Exit::Scene, fmt::format("{}: {}", name_, what));
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

    // Triangles that are there several times are there once, or as often as the solids beside them
    // need them: see timesOf.
    void dropDoubled() {
        std::vector<std::pair<Triangle, size_t>> sorted;
        for (size_t t = 0; t < triangles_.size(); ++t) {
            Triangle key = triangles_[t];
            std::sort(key.begin(), key.end());
            sorted.push_back({key, t});
        }
        std::sort(sorted.begin(), sorted.end());
        std::vector<Triangle> once, all;
        std::vector<size_t> times;
        for (size_t i = 0, end; i < sorted.size(); i = end) {
            for (end = i; end < sorted.size() && sorted[end].first == sorted[i].first;) ++end;
            once.push_back(triangles_[sorted[i].second]), times.push_back(end - i);
        }
        if (once.size() == triangles_.size()) return;
        triangles_ = std::move(once);
        findEdges();
        std::vector<char> known(triangles_.size());
        for (size_t t = 0; t < triangles_.size(); ++t) {
            if (known[t] || times[t] == 1) continue;
            const std::vector<int> patch = alike(int(t), times);
            const size_t wanted = timesOf(patch, times);
            for (const int p : patch) known[size_t(p)] = true, times[size_t(p)] = wanted;
        }
        for (size_t t = 0; t < triangles_.size(); ++t)
            all.insert(all.end(), times[t], triangles_[t]);
        triangles_ = std::move(all);
        if (triangles_.empty()) refuse("encloses no volume; thicken it");
    }
    // Those that hang together with this one and are there as often.
    std::vector<int> alike(int first, const std::vector<size_t>& times) const {
        std::vector<int> reached{first};
        std::unordered_set<int> known{first};
        for (size_t i = 0; i < reached.size(); ++i)
            forEdges(reached[i], [&](const Use* uses, size_t count) {
                for (size_t u = 0; u < count && count == 2; ++u)
                    if (const int next = uses[u].triangle;
                        times[size_t(next)] == times[size_t(first)] && known.insert(next).second)
                        reached.push_back(next);
            });
        return reached;
    }
    // Where they end at an edge of as many others, each of these belongs to a solid above or below.
    // What is above and what is below share a wall, which goes; more on one side lie in each other.
    // Others in the same plane take theirs by going on straight. Elsewhere once is enough.
    size_t timesOf(const std::vector<int>& patch, const std::vector<size_t>& times) const {
        const size_t count = times[size_t(patch[0])];
        size_t wanted = 1;
        for (const int p : patch) {
            const Triangle& t = triangles_[size_t(p)];
            const Facet facet(vertices_[size_t(t[0])], vertices_[size_t(t[1])],
                              vertices_[size_t(t[2])]);
            forEdges(p, [&](const Use* uses, size_t n) {
                int above = 0, below = 0, others = 0;
                for (const Use* use = uses; use < uses + n; ++use) {
                    if (times[size_t(use->triangle)] > 1) continue;
                    const double height = facet.height(vertices_[size_t(thirdOf(*use))]);
                    ++others, above += height > precision_, below += height < -precision_;
                }
                if (size_t(others) == count)
                    wanted = above + below == others ? size_t(std::abs(above - below)) : count;
            });
        }
        return wanted;
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
    // Calls f(uses, count) for each edge of a triangle.
    template <class F> void forEdges(int triangle, const F& f) const {
        for (const int e : edgeOf_[size_t(triangle)])
            f(&uses_[edges_[size_t(e)]], countOf(size_t(e)));
    }

    void requireClosed() const {
        size_t wrong = 0;
        const Use* first = nullptr;
        size_t count = 0;
        for (size_t e = 0; e < edges_.size(); ++e)
            if (countOf(e) % 2 == 1 && wrong++ == 0) first = &uses_[edges_[e]], count = countOf(e);
        if (wrong == 0) return;
        refuse(fmt::format(
            "is not closed: {} belongs to {}, each must to two ({} such edge{}); close the surface "
            "where it was made",
            edge(*first), count == 1 ? "one triangle" : fmt::format("{} triangles", count), wrong,
            wrong == 1 ? "" : "s"));
    }

    // Triangles that hang together by edges of two triangles, turned to face the same side.
    void findPatches() {
        patch_.assign(triangles_.size(), -1), turned_.assign(triangles_.size(), 0);
        for (size_t t = 0; t < triangles_.size(); ++t) {
            if (patch_[t] >= 0) continue;
            std::vector<int> reached{int(t)};
            patch_[t] = patches_;
            for (size_t i = 0; i < reached.size(); ++i)
                forEdges(reached[i], [&](const Use* uses, size_t count) {
                    if (count != 2) return;
                    const bool opposed = uses[0].upward == uses[1].upward;
                    const size_t next = size_t(uses[uses[0].triangle == reached[i]].triangle);
                    const char turned = char(turned_[size_t(reached[i])] ^ char(opposed));
                    if (patch_[next] >= 0 && turned_[next] != turned) refuseToOrient(*uses);
                    if (patch_[next] >= 0) return;
                    patch_[next] = patches_, turned_[next] = turned, reached.push_back(int(next));
                });
            ++patches_;
        }
    }

    // The patch that stands for the shell of this one, and whether this one faces the other way.
    std::pair<int, char> shellOf(int patch) const {
        char turned = 0;
        for (; parent_[size_t(patch)] != patch; patch = parent_[size_t(patch)])
            turned = char(turned ^ turnedToParent_[size_t(patch)]);
        return {patch, turned};
    }
    bool isUpward(const Use& use) const {
        const size_t t = size_t(use.triangle);
        return use.upward != bool(turned_[t] ^ shellOf(patch_[t]).second);
    }

    // Where more than two triangles share an edge, and not each patch has two of them, those go on
    // in each other that do so most nearly straight.
    void joinPatches() {
        parent_.resize(size_t(patches_)), turnedToParent_.assign(size_t(patches_), 0);
        std::iota(parent_.begin(), parent_.end(), 0);
        for (size_t e = 0; e < edges_.size(); ++e) {
            std::vector<Use> open(uses_.begin() + long(edges_[e]),
                                  uses_.begin() + long(edges_[e] + countOf(e)));
            if (open.size() == 2) continue;
            std::map<int, int> ofPatch;
            for (const Use& use : open) ++ofPatch[shellOf(patch_[size_t(use.triangle)]).first];
            if (std::all_of(ofPatch.begin(), ofPatch.end(),
                            [](const auto& p) { return p.second % 2 == 0; }))
                continue;
            while (!open.empty()) joinStraightest(open);
        }
        for (size_t e = 0; e < edges_.size(); ++e) {
            std::map<int, int> sums;
            for (size_t i = edges_[e]; i < edges_[e] + countOf(e); ++i)
                sums[shellOf(patch_[size_t(uses_[i].triangle)]).first] +=
                    isUpward(uses_[i]) ? 1 : -1;
            for (const auto& [shell, sum] : sums)
                if (sum != 0) refuseToOrient(uses_[edges_[e]]);
        }
    }
    void joinStraightest(std::vector<Use>& open) {
        size_t a = 0, b = 1;
        double least = 1e300;
        for (size_t i = 0; i < open.size(); ++i)
            for (size_t j = i + 1; j < open.size(); ++j)
                if (const double c = dot(away(open[i]), away(open[j])); c < least)
                    least = c, a = i, b = j;
        const auto [one, oneTurned] = shellOf(patch_[size_t(open[a].triangle)]);
        const auto [other, otherTurned] = shellOf(patch_[size_t(open[b].triangle)]);
        const bool opposed = isUpward(open[a]) == isUpward(open[b]);
        if (one == other && opposed) refuseToOrient(open[a]);
        if (one != other) parent_[size_t(other)] = one, turnedToParent_[size_t(other)] = opposed;
        open.erase(open.begin() + long(b)), open.erase(open.begin() + long(a));
    }
    // From its edge into a triangle.
    Vec3d away(const Use& use) const {
        const Vec3d along = normalized(vertices_[size_t(use.high)] - vertices_[size_t(use.low)]);
        const Vec3d d = vertices_[size_t(thirdOf(use))] - vertices_[size_t(use.low)],
                    across = d - dot(d, along) * along;
        const double far = length(across);
        return far > 0 ? (1 / far) * across : across;
    }

    ShellNet shells() const {
        ShellNet net{vertices_, triangles_, std::vector<int>(triangles_.size()), 0, precision_};
        std::vector<double> volumes(size_t(patches_), 0.0), areas = volumes;
        std::vector<int> firsts(size_t(patches_), -1);
        for (size_t t = 0; t < triangles_.size(); ++t) {
            const auto [shell, patchTurned] = shellOf(patch_[t]);
            Triangle& n = net.triangles[t];
            if (turned_[t] ^ patchTurned) std::swap(n[1], n[2]);
            int& first = firsts[size_t(shell)];
            if (first < 0) first = n[0];
            const auto from = [&](int v) {
                return vertices_[size_t(v)] - vertices_[size_t(first)];
            };
            volumes[size_t(shell)] += dot(from(n[0]), cross(from(n[1]), from(n[2]))) / 6;
            areas[size_t(shell)] +=
                0.5 * length(cross(from(n[1]) - from(n[0]), from(n[2]) - from(n[0])));
            net.shells[t] = shell;
        }
        std::vector<int> numbers(size_t(patches_), -1);
        for (size_t s = 0; s < volumes.size(); ++s)
            if (std::abs(volumes[s]) > LeastVolume * std::pow(areas[s], 1.5))
                numbers[s] = net.shellCount++;
        size_t end = 0;
        for (size_t t = 0; t < triangles_.size(); ++t) {
            const size_t shell = size_t(net.shells[t]);
            if (numbers[shell] < 0) continue;
            Triangle n = net.triangles[t];
            if (volumes[shell] < 0) std::swap(n[1], n[2]);
            net.triangles[end] = n, net.shells[end++] = numbers[shell];
        }
        net.triangles.resize(end), net.shells.resize(end);
        if (end == 0) refuse("encloses no volume; thicken it");
        return net;
    }

    const std::string& name_;
    std::vector<Vec3d> vertices_;
    std::vector<Triangle> triangles_;
    double precision_ = 0;
    std::vector<Use> uses_;                   // of one edge after the other
    std::vector<size_t> edges_;               // where the uses of each begin
    std::vector<std::array<int, 3>> edgeOf_;  // of each triangle
    int patches_ = 0;
    std::vector<int> patch_, parent_;
    std::vector<char> turned_, turnedToParent_;
};

}  // namespace

ShellNet findShells(const std::string& name, std::vector<Vec3d> vertices,
                    std::vector<std::array<int, 3>> triangles, double roundOff) {
    return ShellFinder(name, std::move(vertices), std::move(triangles)).find(roundOff);
}

}  // namespace spindrift
