#include "scene/mesh.h"

#include "core/error.h"
#include "scene/mesh_shells.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

namespace spindrift {
namespace {

constexpr double GridCells =
    1 << 30;  // along the longest side: products of two places fit into 64 bits
// Of a field: nodes, and those beyond the surface on each side.
constexpr double MostNodes = 1 << 24, MostNodesAlong = 4096;
constexpr int NodesBeyond = 2;

std::string shown(Vec3d p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z); }

template <class T>
std::vector<T> inOrder(const std::vector<T>& things, const std::vector<int>& order) {
    std::vector<T> out;
    out.reserve(things.size());
    for (const int i : order) out.push_back(things[size_t(i)]);
    return out;
}

using GridPlace = std::array<int64_t, 2>;
// Twice the area of the triangle a, b, p, exact.
int64_t areaOf(GridPlace a, GridPlace b, GridPlace p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}
// Its sign with p moved a bit along y and by far less along z (simulation of simplicity,
// Edelsbrunner & Muecke 1990), so that every line through a closed surface goes in as often as out,
// through edges and corners too.
int signOf(int64_t area, GridPlace a, GridPlace b) {
    if (area == 0) area = a[1] != b[1] ? a[1] - b[1] : b[0] - a[0];
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

struct Crossing {
    double x;
    int shell, sign;
};

// Sets that grow together.
int rootOf(std::vector<int>& parents, int i) {
    while (parents[size_t(i)] != i) i = parents[size_t(i)] = parents[size_t(parents[size_t(i)])];
    return i;
}

}  // namespace

Mesh::Mesh(const std::string& name, const std::vector<Vec3d>& vertices,
           const std::vector<Triangle>& triangles, double roundOff) {
    ShellNet net = findShells(name, vertices, triangles, roundOff);
    vertices_ = std::move(net.vertices), triangles_ = std::move(net.triangles),
    precision_ = net.precision;
    bodies_.resize(size_t(net.shellCount));
    std::iota(bodies_.begin(), bodies_.end(), 0);
    std::vector<Box> boxes;
    for (int t = 0; t < int(triangles_.size()); ++t) boxes.push_back(facetOf(t).box());
    const std::vector<int> order = triangleTree_.build(boxes);
    triangles_ = inOrder(triangles_, order), shells_ = inOrder(net.shells, order);
    findBox();
    findSurface();
    isBox_ = std::all_of(surface_.begin(), surface_.end(),
                         [&](const Facet& facet) { return liesOnBox(facet); });
}

Facet Mesh::facetOf(int triangle) const {
    const Triangle& t = triangles_[size_t(triangle)];
    return Facet(vertices_[size_t(t[0])], vertices_[size_t(t[1])], vertices_[size_t(t[2])]);
}

void Mesh::findBox() {
    low_ = high_ = vertices_[size_t(triangles_[0][0])];
    for (const Triangle& t : triangles_)
        for (int v : t)
            low_ = lower(low_, vertices_[size_t(v)]), high_ = upper(high_, vertices_[size_t(v)]);
    for (const Vec3d& p : vertices_) onGrid_.push_back(gridPlace(p.y, p.z));
}

bool Mesh::liesOnBox(const Facet& facet) const {
    const Vec3d size = high_ - low_;
    const double near = std::max(precision_, std::min(1e-5 * std::max({size.x, size.y, size.z}),
                                                      1e-3 * std::min({size.x, size.y, size.z})));
    auto liesAt = [&](int axis, double place) {
        return std::all_of(std::begin(facet.corner), std::end(facet.corner),
                           [&](Vec3d p) { return std::abs(p[axis] - place) < near; });
    };
    for (int k = 0; k < 3; ++k)
        if (liesAt(k, low_[k]) || liesAt(k, high_[k])) return true;
    return false;
}

std::array<int64_t, 2> Mesh::gridPlace(double y, double z) const {
    const Vec3d size = high_ - low_;
    const double cells = GridCells / std::max({size.x, size.y, size.z});
    const auto along = [&](double a, double low) {
        return int64_t(std::llround(std::clamp((a - low) * cells, -1.0, GridCells + 1)));
    };
    return {along(y, low_.y), along(z, low_.z)};
}

// Where the line of these y and z enters and leaves the solid, by x: the shells' winding numbers
// change there.
std::vector<double> Mesh::changesAlong(double y, double z) const {
    const GridPlace p = gridPlace(y, z);
    const double room =
        2 * std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z}) / GridCells;
    std::vector<Crossing> crossings;
    triangleTree_.visit(
        [&](const Box& b) {
            return y >= b.low.y - room && y <= b.high.y + room && z >= b.low.z - room &&
                   z <= b.high.z + room;
        },
        [&](int i) {
            const Triangle& t = triangles_[size_t(i)];
            const GridPlace a = onGrid_[size_t(t[0])], b = onGrid_[size_t(t[1])],
                            c = onGrid_[size_t(t[2])];
            const int64_t A = areaOf(b, c, p), B = areaOf(c, a, p), C = areaOf(a, b, p);
            const int sign = signOf(A, b, c);
            if (sign == 0 || signOf(B, c, a) != sign || signOf(C, a, b) != sign) return;
            const auto x = [&](int k) { return vertices_[size_t(t[size_t(k)])].x - low_.x; };
            const double at = (double(A) * x(0) + double(B) * x(1) + double(C) * x(2)) /
                              (double(A) + double(B) + double(C));
            crossings.push_back({low_.x + at, shells_[size_t(i)], -sign});
        });
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    std::vector<double> changes;
    std::vector<std::pair<int, int>> windings,
        bodies;  // of each shell, and in how many shells of each body the line is
    const auto countOf = [](auto& list, int key) -> int& {
        const auto found = std::find_if(list.begin(), list.end(),
                                        [&](const auto& entry) { return entry.first == key; });
        return found != list.end() ? found->second : list.emplace_back(key, 0).second;
    };
    bool inside = false;
    for (const Crossing& c : crossings) {
        int& winding = countOf(windings, c.shell);
        const bool before = winding != 0, after = (winding += c.sign) != 0;
        if (before == after) continue;
        int& shells = countOf(bodies, bodies_[size_t(c.shell)]);
        const bool was = shells > 0, is = (shells += after ? 1 : -1) > 0;
        if (was != is) changes.push_back(c.x), inside = !inside;
    }
    return changes;
}

bool Mesh::holds(Vec3d p) const {
    for (int k = 0; k < 3; ++k)
        if (p[k] < low_[k] || p[k] > high_[k]) return false;
    const std::vector<double> changes = changesAlong(p.y, p.z);
    return (std::lower_bound(changes.begin(), changes.end(), p.x) - changes.begin()) % 2 == 1;
}

// Whether one of two triangles with an edge in common lies on the other.
bool Mesh::liesOn(int i, int j) const {
    const Triangle &a = triangles_[size_t(i)], &b = triangles_[size_t(j)];
    const auto isIn = [](const Triangle& t, int v) { return t[0] == v || t[1] == v || t[2] == v; };
    const auto thirdOf = [&](const Triangle& t, const Triangle& other) {
        return vertices_[size_t(!isIn(other, t[0]) ? t[0] : !isIn(other, t[1]) ? t[1] : t[2])];
    };
    const int from = isIn(b, a[0]) ? a[0] : a[1], to = isIn(b, a[2]) ? a[2] : a[1];
    const Vec3d edge = vertices_[size_t(to)] - vertices_[size_t(from)], p = thirdOf(a, b),
                q = thirdOf(b, a);
    return std::abs(facetOf(i).height(q)) <= precision_ &&
           dot(cross(edge, p - vertices_[size_t(from)]), cross(edge, q - vertices_[size_t(from)])) >
               0;
}

// Of the triangles those parts with the solid on one side only, and that side behind them.
void Mesh::findSurface() {
    const int count = int(triangles_.size());
    const double tolerance = precision_;
    std::vector<std::vector<Segment>> cuts(static_cast<size_t>(count));
    std::vector<std::vector<int>> covers(static_cast<size_t>(count));  // before it in the list
    std::vector<std::pair<int, int>> touching;                         // shells
    bool simple = bodies_.size() == 1;
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < count; ++i) {
        const Facet t = facetOf(i);
        const Box box = t.box();
        triangleTree_.visit(
            [&](const Box& b) {
                for (int k = 0; k < 3; ++k)
                    if (b.low[k] > box.high[k] + tolerance || b.high[k] < box.low[k] - tolerance)
                        return false;
                return true;
            },
            [&](int j) {
                int shared = 0;
                for (const int v : triangles_[size_t(i)])
                    for (const int w : triangles_[size_t(j)]) shared += v == w;
                const bool sameShell = shells_[size_t(i)] == shells_[size_t(j)];
                if (i == j || (sameShell && shared == 2 && !liesOn(i, j))) return;
                const Meeting meeting = meet(t, facetOf(j), tolerance, cuts[size_t(i)]);
                if (meeting == Meeting::Cover && j < i) covers[size_t(i)].push_back(j);
                if (meeting == Meeting::None || sameShell) return;
#pragma omp critical
                touching.push_back({shells_[size_t(i)], shells_[size_t(j)]});
            });
    }
    for (const auto& [a, b] : touching) bodies_[size_t(rootOf(bodies_, a))] = rootOf(bodies_, b);
    for (size_t s = 0; s < bodies_.size(); ++s) bodies_[s] = rootOf(bodies_, int(s));
    for (size_t i = 0; i < cuts.size(); ++i)
        simple = simple && cuts[i].empty() && covers[i].empty();
    std::vector<std::vector<Facet>> parts(static_cast<size_t>(count));
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < count; ++i) {
        const Facet t = facetOf(i);
        if (simple)
            parts[size_t(i)] = {t};
        else if (t.area() > 0)
            for (const auto& polygon : cutUp(t, cuts[size_t(i)], tolerance))
                addSurface(t, polygon, covers[size_t(i)], parts[size_t(i)]);
    }
    for (const auto& part : parts) surface_.insert(surface_.end(), part.begin(), part.end());
    std::vector<Box> boxes;
    for (const Facet& f : surface_) boxes.push_back(f.box()), area_ += f.area();
    surface_ = inOrder(surface_, surfaceTree_.build(boxes));
}

// A part of a triangle, unless a triangle before it has it too.
void Mesh::addSurface(const Facet& t, const std::vector<Vec3d>& polygon,
                      const std::vector<int>& covers, std::vector<Facet>& out) const {
    const double beside = 2 * precision_;
    Vec3d middle;
    for (const Vec3d& p : polygon) middle = middle + (1.0 / double(polygon.size())) * p;
    const bool before = holds(middle + beside * t.normal),
               behind = holds(middle - beside * t.normal);
    if (before == behind) return;
    for (const int other : covers)
        if (facetOf(other).covers(middle, precision_)) return;
    for (size_t k = 2; k < polygon.size(); ++k)
        out.push_back(behind ? Facet(polygon[0], polygon[k - 1], polygon[k])
                             : Facet(polygon[0], polygon[k], polygon[k - 1]));
}

double Mesh::distance(Vec3d p, int& facet) const {
    double best2 = 1e300;
    const auto take = [&](int i) {
        const Vec3d from = p - surface_[size_t(i)].nearest(p);
        if (const double d2 = dot(from, from); d2 < best2) best2 = d2, facet = i;
    };
    if (const int known = facet; known >= 0) take(known);
    surfaceTree_.visitNearer(p, best2, take);
    return std::sqrt(best2);
}

Mesh::Nearest Mesh::nearest(Vec3d p, int& facet) const {
    const double far = distance(p, facet);
    const Facet& f = surface_[size_t(facet)];
    const double sign = holds(p) ? -1 : 1;
    return {sign * far, far > precision_ ? (sign / far) * (p - f.nearest(p)) : f.normal};
}

Mesh::Nearest Mesh::nearest(Vec3d p) const {
    int facet = -1;
    return nearest(p, facet);
}

// Whether a solid between a point of its surface and one of the opposite surface becomes thinner in
// a straight line from there to an edge.
bool Mesh::isTip(Vec3d at, Vec3d normal, Vec3d opposite, Vec3d facing) const {
    const double cosine = dot(facing, normal), height = dot(facing, opposite - at),
                 thickness = height / -cosine;
    const Vec3d across = facing - cosine * normal;  // towards the edge
    const double slope2 = dot(across, across);
    if (slope2 < 1e-12) return false;
    for (const double left : {0.5, 0.25}) {
        const double depth = -nearest(at + ((1 - left) * height / slope2) * across -
                                      (0.5 * left * thickness) * normal)
                                  .distance,
                     expected = 0.5 * left * thickness;
        if (depth < 0.5 * expected || depth > 1.5 * expected) return false;
    }
    return true;
}

// As far below each of many points of the surface as half of `most`, the nearest surface is theirs,
// unless another one that faces the opposite way is nearer. (Only nearly parallel ones, and away
// from edges: towards its edge every wedge is thin.)
Mesh::Thinnest Mesh::thinnest(double most) const {
    Thinnest found{most, {}};
    int foundIn = 0;
    constexpr double Samples = 3e5;
    const double apart = std::max(0.5 * most, std::sqrt(area_ / Samples));
#pragma omp parallel for schedule(dynamic, 256)
    for (int f = 0; f < int(surface_.size()); ++f) {
        const Facet& facet = surface_[size_t(f)];
        const Vec3d n = facet.normal, a = facet.corner[0], ab = facet.corner[1] - a,
                    ac = facet.corner[2] - a;
        const int pieces = 1 + int(std::max({length(ab), length(ac), length(ac - ab)}) / apart);
        for (int i = 0; i < pieces; ++i)
            for (int j = 0; i + j < pieces; ++j) {
                const Vec3d at = a + ((i + 1.0 / 3) / pieces) * ab + ((j + 1.0 / 3) / pieces) * ac;
                const Vec3d under = at - 0.5 * most * n;
                int nearby = f;
                if (distance(under, nearby) >= 0.5 * most - precision_) continue;
                const Nearest below = nearest(under, nearby);
                const double thickness = 0.5 * most - below.distance;
                if (dot(below.normal, n) >= -0.95 ||
                    isTip(at, n, under - below.distance * below.normal, below.normal))
                    continue;
#pragma omp critical
                if (thickness < found.thickness || (thickness == found.thickness && f < foundIn))
                    found = {thickness, at}, foundIn = f;
            }
    }
    return found;
}

namespace {

// Of a field of this size.
Int3 nodesOf(Vec3d size, double spacing) {
    auto along = [&](double length) {
        return int(std::min(std::ceil(length / spacing), 1e6)) + 1 + 2 * NodesBeyond;
    };
    return {along(size.x), along(size.y), along(size.z)};
}
bool isTooLarge(Int3 n) {
    return double(n.x) * double(n.y) * double(n.z) > MostNodes ||
           std::max({n.x, n.y, n.z}) > MostNodesAlong;
}

}  // namespace

double Mesh::fieldSpacing(double apart) const {
    double spacing = 0.5 * apart;
    while (isTooLarge(nodesOf(high_ - low_, spacing))) spacing *= 1.1;
    const Thinnest t = thinnest(2 * spacing);
    if (t.thickness >= 2 * spacing) return spacing;
    if (isTooLarge(nodesOf(high_ - low_, 0.5 * t.thickness)))
        throw Error(Failure::Scene,
                    fmt::format("is {:.3g} thin near {}, too thin for its size, {:.3g}: fluid "
                                "could pass; thicken it, or divide it into several",
                                t.thickness, shown(t.at), length(high_ - low_)));
    return 0.5 * t.thickness;
}

DistanceField Mesh::field(double spacing) const {
    DistanceField f{{}, spacing, nodesOf(high_ - low_, spacing), {}};
    const Vec3d middle = 0.5 * (low_ + high_);
    f.low =
        -0.5 * spacing * Vec3d{double(f.nodes.x - 1), double(f.nodes.y - 1), double(f.nodes.z - 1)};
    const size_t row = size_t(f.nodes.x);
    f.distances.resize(row * size_t(f.nodes.y) * size_t(f.nodes.z));
    std::vector<std::vector<double>> changes(size_t(f.nodes.y) * size_t(f.nodes.z));  // of each row
#pragma omp parallel for schedule(dynamic, 16)
    for (int r = 0; r < int(changes.size()); ++r)
        changes[size_t(r)] = changesAlong(middle.y + f.low.y + spacing * (r % f.nodes.y),
                                          middle.z + f.low.z + spacing * (r / f.nodes.y));
    const auto isInside = [&](double x, size_t r) {
        return (std::lower_bound(changes[r].begin(), changes[r].end(), x) - changes[r].begin()) %
                   2 ==
               1;
    };
    // Cubes of nodes that are all far from the surface are filled from their middles: outside with
    // what is surely free, inside in a straight line.
    constexpr int Side = 8;
    const Int3 cubes{(f.nodes.x + Side - 1) / Side, (f.nodes.y + Side - 1) / Side,
                     (f.nodes.z + Side - 1) / Side};
    const double reach = 0.5 * std::sqrt(3.0) * (Side - 1) * spacing, near = 6 * spacing;
#pragma omp parallel for schedule(dynamic, 1)
    for (int cube = 0; cube < cubes.x * cubes.y * cubes.z; ++cube) {
        const int x = cube % cubes.x * Side, y = cube / cubes.x % cubes.y * Side,
                  z = cube / (cubes.x * cubes.y) * Side;
        auto at = [&](double i, double j, double k) {
            return middle + f.low + spacing * Vec3d{x + i, y + j, z + k};
        };
        constexpr double half = 0.5 * (Side - 1);
        const Vec3d center = at(half, half, half);
        int facet = -1;
        const Nearest whole = nearest(center, facet);
        for (int k = 0; k < Side && z + k < f.nodes.z; ++k)
            for (int j = 0; j < Side && y + j < f.nodes.y; ++j)
                for (int i = 0; i < Side && x + i < f.nodes.x; ++i) {
                    const Vec3d p = at(i, j, k), from = p - center;
                    const size_t r = size_t(z + k) * size_t(f.nodes.y) + size_t(y + j);
                    const double far = whole.distance > reach + near ? whole.distance - length(from)
                                       : whole.distance < -reach - near
                                           ? whole.distance + dot(from, whole.normal)
                                           : distance(p, facet) * (isInside(p.x, r) ? -1 : 1);
                    f.distances[r * row + size_t(x + i)] = float(far);
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
    for (const Facet& f : surface_) {
        const Vec3d a = f.corner[0] - middle, b = f.corner[1] - middle, c = f.corner[2] - middle,
                    sum = a + b + c;
        const double six = dot(a, cross(b, c));
        w.volume += six / 6;
        first = first + (six / 24) * sum;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                second[i][j] +=
                    six / 120 * (sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
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

}  // namespace spindrift
