#include "scene/mesh.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <numeric>
#include <string_view>
#include <tuple>

namespace spindrift {
namespace {

constexpr size_t LargestFile = 512 << 20, MostTriangles = 5'000'000;
constexpr double Farthest = 1e6;   // that a coordinate may lie from 0
constexpr int TrianglesInBox = 4;
// Of a field: nodes, and those beyond the surface on each side.
constexpr double MostNodes = 1 << 24, MostNodesAlong = 4096;
constexpr int NodesBeyond = 2;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(Exit::Scene, fmt::format("{}: {}", path, what));
}

std::string shown(Vec3d p) { return fmt::format("({:g}, {:g}, {:g})", p.x, p.y, p.z); }
Vec3d lower(Vec3d a, Vec3d b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3d upper(Vec3d a, Vec3d b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

// An edge between two vertices, in the direction from the first to the second in which a triangle uses it.
struct Edge {
    int low, high;
    bool upward;
    int place;   // 3 triangle + corner
};

std::vector<Edge> edgesOf(const std::vector<Mesh::Triangle>& triangles) {
    std::vector<Edge> edges;
    for (size_t t = 0; t < triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const int from = triangles[t][k], to = triangles[t][(k + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), from < to, int(3 * t + k)});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.place) < std::tie(b.low, b.high, b.place);
    });
    return edges;
}

// Calls f(first, end) for the uses of each edge.
template <class F> void forUses(const std::vector<Edge>& edges, const F& f) {
    for (size_t i = 0, end; i < edges.size(); i = end) {
        for (end = i; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;) ++end;
        f(i, end);
    }
}

void requireClosed(const std::string& name, const std::vector<Vec3d>& vertices, const std::vector<Mesh::Triangle>& triangles) {
    const std::vector<Edge> edges = edgesOf(triangles);
    size_t wrong = 0, first = 0, uses = 0;
    forUses(edges, [&](size_t i, size_t end) {
        if (end - i == 2 && edges[i].upward != edges[i + 1].upward) return;
        if (wrong++ == 0) first = i, uses = end - i;
    });
    if (wrong == 0) return;
    const std::string edge = shown(vertices[size_t(edges[first].low)]) + " to " + shown(vertices[size_t(edges[first].high)]);
    const std::string owners = uses == 2 ? "two triangles that face opposite sides" : uses == 1 ? "one triangle" : fmt::format("{} triangles", uses);
    refuse(name, fmt::format("is not closed: the edge from {} belongs to {}, each must to two that face the same side ({} such edge{}); close the "
                             "surface where it was made", edge, owners, wrong, wrong == 1 ? "" : "s"));
}

double boxDistance2(Vec3d low, Vec3d high, Vec3d p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double beyond = std::max({low[k] - p[k], p[k] - high[k], 0.0});
        sum += beyond * beyond;
    }
    return sum;
}

}  // namespace

Mesh::Mesh(const std::string& name, std::vector<Vec3d> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
    join(name);
    if (triangles_.empty()) refuse(name, "has no faces; it needs lines f");
    requireClosed(name, vertices_, triangles_);
    low_ = high_ = vertices_[size_t(triangles_[0][0])];
    for (const Triangle& t : triangles_)
        for (int v : t) low_ = lower(low_, vertices_[size_t(v)]), high_ = upper(high_, vertices_[size_t(v)]);
    const double volume = weigh().volume;
    if (!(std::abs(volume) > 1e-9 * std::pow(length(high_ - low_), 3))) refuse(name, "encloses no volume; thicken it");
    if (volume < 0)
        for (Triangle& t : triangles_) std::swap(t[1], t[2]);
    boxes_.reserve(triangles_.size());
    divide(0, int(triangles_.size()));
    findNormals();
}

// Files write a corner once for each of its faces now and then.
void Mesh::join(const std::string& name) {
    std::vector<int> order(vertices_.size()), same(vertices_.size());
    std::iota(order.begin(), order.end(), 0);
    auto key = [&](int v) { const Vec3d& p = vertices_[size_t(v)]; return std::tie(p.x, p.y, p.z); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool first = i == 0 || key(order[i]) != key(order[i - 1]);
        same[size_t(order[i])] = first ? order[i] : same[size_t(order[i - 1])];
    }
    for (Triangle& t : triangles_)
        for (int& v : t) {
            if (v < 0 || v >= int(vertices_.size())) refuse(name, "a face has a corner that is not there");
            v = same[size_t(v)];
        }
    std::erase_if(triangles_, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

// Angle-weighted ones at corners and sums at edges tell inside from outside wherever the nearest point lies (Baerentzen & Aanaes 2005).
void Mesh::findNormals() {
    faceNormals_.resize(triangles_.size());
    vertexNormals_.assign(vertices_.size(), {});
    edgeNormals_.resize(3 * triangles_.size());
    for (int t = 0; t < int(triangles_.size()); ++t) {
        const Vec3d n = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
        const double twice = length(n);
        area_ += twice / 2;
        faceNormals_[size_t(t)] = twice > 0 ? (1 / twice) * n : Vec3d{};
        for (int k = 0; k < 3; ++k) {
            const Vec3d a = corner(t, k + 1) - corner(t, k), b = corner(t, k + 2) - corner(t, k);
            const double angle = std::atan2(length(cross(a, b)), dot(a, b));
            Vec3d& sum = vertexNormals_[size_t(triangles_[size_t(t)][size_t(k)])];
            sum = sum + angle * faceNormals_[size_t(t)];
        }
    }
    const std::vector<Edge> edges = edgesOf(triangles_);
    forUses(edges, [&](size_t i, size_t end) {
        Vec3d sum;
        for (size_t e = i; e < end; ++e) sum = sum + faceNormals_[size_t(edges[e].place / 3)];
        for (size_t e = i; e < end; ++e) edgeNormals_[size_t(edges[e].place)] = sum;
    });
}

// Boxes of few triangles that lie near each other: halves, by their middles along the longest side.
int Mesh::divide(int first, int count) {
    const int index = int(boxes_.size());
    Box box{corner(first, 0), corner(first, 0), first, count, -1};
    for (int t = first; t < first + count; ++t)
        for (int k = 0; k < 3; ++k) box.low = lower(box.low, corner(t, k)), box.high = upper(box.high, corner(t, k));
    boxes_.push_back(box);
    if (count <= TrianglesInBox) return index;
    const Vec3d size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2, half = count / 2;
    auto middle = [&](const Triangle& t) { return vertices_[size_t(t[0])][axis] + vertices_[size_t(t[1])][axis] + vertices_[size_t(t[2])][axis]; };
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](const Triangle& a, const Triangle& b) { return std::pair(middle(a), a) < std::pair(middle(b), b); });
    boxes_[size_t(index)].count = 0;
    divide(first, half);
    const int right = divide(first + half, count - half);
    boxes_[size_t(index)].right = right;
    return index;
}

// Above the triangle the nearest point is p's own image, otherwise it lies on an edge that p is beyond.
Mesh::Touch Mesh::touch(int t, Vec3d p) const {
    const Vec3d n = faceNormals_[size_t(t)];
    Touch best{1e300, {}, 6};
    bool above = dot(n, n) > 0;
    for (int k = 0; k < 3; ++k) {
        const Vec3d a = corner(t, k), along = corner(t, k + 1) - a, from = p - a;
        if (dot(n, n) > 0 && dot(cross(along, n), from) <= 0) continue;
        above = false;
        const double share = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
        const Vec3d at = share < 1 ? a + share * along : corner(t, k + 1);
        const double d2 = dot(p - at, p - at);
        if (d2 < best.distance2) best = {d2, at, share <= 0 ? k : share >= 1 ? (k + 1) % 3 : 3 + k};
    }
    if (!above) return best;
    const double height = dot(n, p - corner(t, 0));
    return {height * height, p - height * n, 6};
}

Mesh::Nearest Mesh::nearest(Vec3d p, int& triangle) const {
    Touch best{1e300, {}, 6};
    if (triangle >= 0) best = touch(triangle, p);
    struct Open { int box; double distance2; } open[64];   // halves make it no deeper than that
    int count = 0;
    open[count++] = {0, boxDistance2(low_, high_, p)};
    while (count > 0) {
        const Open now = open[--count];
        if (now.distance2 >= best.distance2) continue;
        const Box& box = boxes_[size_t(now.box)];
        for (int t = box.first; t < box.first + box.count; ++t)
            if (const Touch touched = touch(t, p); touched.distance2 < best.distance2) best = touched, triangle = t;
        if (box.count > 0) continue;
        auto other = [&](int b) { return Open{b, boxDistance2(boxes_[size_t(b)].low, boxes_[size_t(b)].high, p)}; };
        const Open left = other(now.box + 1), right = other(box.right);
        const bool leftFirst = left.distance2 <= right.distance2;
        open[count++] = leftFirst ? right : left;
        open[count++] = leftFirst ? left : right;
    }
    const size_t t = size_t(triangle);
    const Vec3d outward = best.part == 6  ? faceNormals_[t]
                          : best.part < 3 ? vertexNormals_[size_t(triangles_[t][size_t(best.part)])]
                                          : edgeNormals_[3 * t + size_t(best.part) - 3];
    const Vec3d from = p - best.point;
    const double distance = std::sqrt(best.distance2), sign = dot(from, outward) < 0 ? -1 : 1;
    const double whole = length(outward);
    const Vec3d normal = distance > 1e-9 * length(high_ - low_) ? (sign / distance) * from : whole > 0 ? (1 / whole) * outward : Vec3d{0, 1, 0};
    return {sign * distance, normal};
}

Mesh::Nearest Mesh::nearest(Vec3d p) const {
    int triangle = -1;
    return nearest(p, triangle);
}

// As far below each of many points of the surface as half of `most`, the nearest surface is theirs, unless another one that faces the opposite way is
// nearer. (Only nearly parallel ones: towards its edge every wedge is thin.)
Mesh::Thinnest Mesh::thinnest(double most) const {
    Thinnest found{most, {}};
    constexpr double Samples = 3e5;
    const double apart = std::max(0.5 * most, std::sqrt(area_ / Samples));
    for (int t = 0; t < int(triangles_.size()); ++t) {
        const Vec3d n = faceNormals_[size_t(t)], a = corner(t, 0), ab = corner(t, 1) - a, ac = corner(t, 2) - a;
        const int pieces = 1 + int(std::max({length(ab), length(ac), length(ac - ab)}) / apart);
        for (int i = 0; i < pieces; ++i)
            for (int j = 0; i + j < pieces; ++j) {
                const Vec3d at = a + ((i + 1.0 / 3) / pieces) * ab + ((j + 1.0 / 3) / pieces) * ac;
                const Nearest below = nearest(at - 0.5 * most * n);
                const Vec3d facing = below.normal;
                const double thickness = 0.5 * most - below.distance;
                if (dot(facing, n) < -0.95 && thickness < found.thickness) found = {thickness, at};
            }
    }
    return found;
}

namespace {

// Of a field of this size.
Int3 nodesOf(Vec3d size, double spacing) {
    auto along = [&](double length) { return int(std::min(std::ceil(length / spacing), 1e6)) + 1 + 2 * NodesBeyond; };
    return {along(size.x), along(size.y), along(size.z)};
}
bool isTooLarge(Int3 n) {
    return double(n.x) * double(n.y) * double(n.z) > MostNodes || std::max({n.x, n.y, n.z}) > MostNodesAlong;
}

}  // namespace

double Mesh::fieldSpacing(double apart) const {
    double spacing = 0.5 * apart;
    while (isTooLarge(nodesOf(high_ - low_, spacing))) spacing *= 1.1;
    const Thinnest t = thinnest(2 * spacing);
    if (t.thickness >= 2 * spacing) return spacing;
    if (isTooLarge(nodesOf(high_ - low_, 0.5 * t.thickness)))
        throw Error(Exit::Scene, fmt::format("is {:.3g} thin near {}, too thin for its size, {:.3g}: fluid could pass; thicken it, or divide it into several",
                                             t.thickness, shown(t.at), length(high_ - low_)));
    return 0.5 * t.thickness;
}

DistanceField Mesh::field(double spacing) const {
    DistanceField f{{}, spacing, nodesOf(high_ - low_, spacing), {}};
    const Vec3d middle = 0.5 * (low_ + high_);
    f.low = -0.5 * spacing * Vec3d{double(f.nodes.x - 1), double(f.nodes.y - 1), double(f.nodes.z - 1)};
    const size_t row = size_t(f.nodes.x), plane = row * size_t(f.nodes.y);
    f.distances.resize(plane * size_t(f.nodes.z));
    // Cubes of nodes that are all far from the surface are filled from their middles: outside with what is surely free, inside in a straight line.
    constexpr int Side = 8;
    const Int3 cubes{(f.nodes.x + Side - 1) / Side, (f.nodes.y + Side - 1) / Side, (f.nodes.z + Side - 1) / Side};
    const double reach = 0.5 * std::sqrt(3.0) * (Side - 1) * spacing, near = 6 * spacing;
#pragma omp parallel for schedule(dynamic, 1)
    for (int cube = 0; cube < cubes.x * cubes.y * cubes.z; ++cube) {
        const int x = cube % cubes.x * Side, y = cube / cubes.x % cubes.y * Side, z = cube / (cubes.x * cubes.y) * Side;
        auto at = [&](double i, double j, double k) { return middle + f.low + spacing * Vec3d{x + i, y + j, z + k}; };
        constexpr double half = 0.5 * (Side - 1);
        const Vec3d center = at(half, half, half);
        int triangle = -1;
        const Nearest whole = nearest(center, triangle);
        for (int k = 0; k < Side && z + k < f.nodes.z; ++k)
            for (int j = 0; j < Side && y + j < f.nodes.y; ++j)
                for (int i = 0; i < Side && x + i < f.nodes.x; ++i) {
                    const Vec3d p = at(i, j, k), from = p - center;
                    const double distance = whole.distance > reach + near    ? whole.distance - length(from)
                                            : whole.distance < -reach - near ? whole.distance + dot(from, whole.normal)
                                                                             : nearest(p, triangle).distance;
                    f.distances[size_t(z + k) * plane + size_t(y + j) * row + size_t(x + i)] = float(distance);
                }
    }
    return f;
}

// Sums over the tetrahedra from the middle of the box to each triangle.
Mesh::Weight Mesh::weigh() const {
    const Vec3d middle = 0.5 * (low_ + high_);
    Weight w{};
    Vec3d first;
    double second[3][3] = {};
    for (const Triangle& t : triangles_) {
        const Vec3d a = vertices_[size_t(t[0])] - middle, b = vertices_[size_t(t[1])] - middle, c = vertices_[size_t(t[2])] - middle, sum = a + b + c;
        const double six = dot(a, cross(b, c));
        w.volume += six / 6;
        first = first + (six / 24) * sum;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) second[i][j] += six / 120 * (sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    }
    const Vec3d arm = (1 / w.volume) * first;
    w.centroid = middle + arm;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) second[i][j] -= w.volume * arm[i] * arm[j];
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) w.inertia[i][j] = (i == j ? trace : 0) - second[i][j];
    return w;
}

namespace {

// The lines of an OBJ file, one after the other.
class ObjReader {
public:
    explicit ObjReader(const std::string& path) : path_(path) {}
    Mesh read() {
        std::ifstream stream(path_, std::ios::binary);
        std::error_code none;
        if (!stream || !std::filesystem::is_regular_file(path_, none)) refuse(path_, "can't be read; check the path");
        if (std::filesystem::file_size(path_, none) > LargestFile) refuse(path_, "is larger than 512 MiB; simplify the surface");
        for (std::string line; std::getline(stream, line);) {
            ++line_;
            readLine(line);
        }
        return Mesh(path_, std::move(vertices_), std::move(triangles_));
    }

private:
    [[noreturn]] void fail(const std::string& what) const { refuse(path_, fmt::format("line {}: {}", line_, what)); }
    void readLine(std::string_view line) {
        const std::string_view kind = takeWord(line);
        if (kind == "v") readVertex(line);
        if (kind == "f") readFace(line);
    }
    static std::string_view takeWord(std::string_view& line) {
        constexpr const char* Blank = " \t\r";
        const size_t begin = std::min(line.find_first_not_of(Blank), line.size()), end = std::min(line.find_first_of(Blank, begin), line.size());
        const std::string_view word = line.substr(begin, end - begin);
        line.remove_prefix(end);
        return word;
    }
    template <class T> static bool parse(std::string_view word, T& value) {
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc() && end == word.data() + word.size();
    }
    static std::string brief(std::string_view word) { return std::string(word.substr(0, 40)); }
    void readVertex(std::string_view line) {
        Vec3d p;
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = takeWord(line);
            if (!parse(word, p[k]) || !std::isfinite(p[k])) fail(fmt::format("{} = \"{}\" is no number; a vertex is v x y z", "xyz"[k], brief(word)));
            if (std::abs(p[k]) > Farthest) fail(fmt::format("{} = {:g} is farther than {:g} from 0; move or scale it", "xyz"[k], p[k], Farthest));
        }
        vertices_.push_back(p);
    }
    // v, v/vt, v//vn or v/vt/vn; from 1 on, or from the last one backward.
    int readCorner(std::string_view word) const {
        int64_t index = 0;
        const auto count = int64_t(vertices_.size());
        if (!parse(word.substr(0, word.find('/')), index) || index == 0) fail(fmt::format("\"{}\" is no corner of a face; give vertex numbers from 1 on", brief(word)));
        if (index > count || index < -count) fail(fmt::format("vertex {} of {} that are there so far; mend the face", index, count));
        return int(index > 0 ? index - 1 : count + index);
    }
    void readFace(std::string_view line) {
        std::vector<int> corners;
        for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) corners.push_back(readCorner(word));
        if (corners.size() < 3) fail(fmt::format("a face of {} corners; it needs three", corners.size()));
        for (size_t k = 2; k < corners.size(); ++k) triangles_.push_back({corners[0], corners[k - 1], corners[k]});
        if (triangles_.size() > MostTriangles) fail(fmt::format("more than {} triangles; simplify the surface", MostTriangles));
    }

    const std::string& path_;
    int line_ = 0;
    std::vector<Vec3d> vertices_;
    std::vector<Mesh::Triangle> triangles_;
};

}  // namespace

std::shared_ptr<const Mesh> readMesh(const std::string& path) {
    struct Known { std::filesystem::file_time_type time; uintmax_t size; std::shared_ptr<const Mesh> mesh; };
    static std::mutex mutex;
    static std::map<std::string, Known> known;
    if (path.empty()) refuse("\"\"", "no file is named; give its path");
    const std::lock_guard lock(mutex);
    std::error_code none, gone;
    const auto time = std::filesystem::last_write_time(path, none);
    const uintmax_t size = std::filesystem::file_size(path, gone);
    Known& k = known[path];
    // A run goes on when the file is gone.
    if (k.mesh && (none || gone || (k.time == time && k.size == size))) return k.mesh;
    k = {time, size, std::make_shared<const Mesh>(ObjReader(path).read())};
    return k.mesh;
}

}  // namespace spindrift
