#include "scene/sample_object.h"

#include "scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace spindrift {
namespace {

// Nodes of a lattice along three directions of an object's own, the first of which may be closed to
// a ring. A direction with one node has no extent.
struct Nodes {
    int64_t n[3] = {1, 1, 1};
    bool ring = false;
    int dimensions = 3;
    int64_t cells(int k) const { return ring && k == 0 ? n[0] : std::max<int64_t>(n[k] - 1, 1); }
    bool extends(int k) const { return n[k] > 1; }
    int index(int64_t i, int64_t j, int64_t k) const {
        return int(((k % n[2]) * n[1] + j % n[1]) * n[0] + (ring ? i % n[0] : i));
    }
    bool atSurface(int64_t i, int64_t j, int64_t k) const {
        const int64_t at[3] = {i, j, k};
        int extents = 0;
        bool end = false;
        for (int d = 0; d < 3; ++d) {
            extents += extends(d);
            if (extends(d) && !(ring && d == 0)) end |= at[d] == 0 || at[d] == n[d] - 1;
        }
        return extents < dimensions || end;
    }
};

int64_t nodesAlong(double extent, double spacing) {
    return std::max<int64_t>(2, int64_t(std::llround(extent / spacing)) + 1);
}

Nodes nodesOf(const Scene& scene, const Object& o) {
    const double a = spacingOf(scene, o);
    const bool flat = scene.simulation.dimensions == 2;
    // A wall of one layer, or of as many as it is thick.
    const int64_t layers = o.thickness < 0.75 * a ? 1 : nodesAlong(o.thickness, a);
    Nodes nodes;
    nodes.dimensions = scene.simulation.dimensions;
    if (o.shape == ObjectShape::Tube) {
        nodes.ring = true;
        nodes.n[0] = std::max<int64_t>(6, std::llround(2 * std::numbers::pi * o.radius / a));
        nodes.n[1] = flat ? 1 : nodesAlong(o.height, a);
        nodes.n[2] = layers;
        return nodes;
    }
    for (int k = 0; k < (flat ? 2 : 3); ++k) {
        const double extent = double(o.max[k]) - o.min[k];
        nodes.n[k] = extent > 0 ? nodesAlong(extent, a) : layers;
    }
    return nodes;
}

// Where node (i, j, k) lies, m, world coordinates.
Vec3d placeOf(const Scene& scene, const Object& o, const Nodes& nodes, int64_t i, int64_t j,
              int64_t k) {
    const double middle = 0.5 * (double(scene.domain.min.z) + scene.domain.max.z);
    auto share = [](int64_t at, int64_t n) {
        return n > 1 ? double(at) / double(n - 1) - 0.5 : 0.0;
    };
    Vec3d x;
    if (o.shape == ObjectShape::Tube) {
        const bool flat = scene.simulation.dimensions == 2;
        const int axis = flat ? 2 : int(o.axis);
        const double angle = 2 * std::numbers::pi * double(i) / double(nodes.n[0]),
                     r = o.radius + o.thickness * share(k, nodes.n[2]);
        x = toDouble(o.center);
        x[(axis + 1) % 3] += r * std::cos(angle), x[(axis + 2) % 3] += r * std::sin(angle);
        x[axis] += flat ? middle - x[axis] : o.height * share(j, nodes.n[1]);
        return x;
    }
    const int64_t at[3] = {i, j, k};
    for (int d = 0; d < 3; ++d) {
        const double extent = double(o.max[d]) - o.min[d];
        x[d] = 0.5 * (double(o.min[d]) + o.max[d]) +
               (extent > 0 ? extent : double(o.thickness)) * share(at[d], nodes.n[d]);
    }
    if (scene.simulation.dimensions == 2) x.z = middle;
    return x;
}

// An object under way: springs between its particles, those of the same pair added up.
struct Springs {
    ObjectSample& out;
    int first;  // of its particles
    std::map<std::pair<int, int>, double> stiffness{};

    Vec3d at(int node) const { return toDouble(out.positions[size_t(first + node)]); }
    void join(int a, int b, double k) { stiffness[{std::min(a, b), std::max(a, b)}] += k; }
    void addMass(int node, double mass) { out.masses[size_t(first + node)] += float(mass); }
    void bond() {
        for (const auto& [pair, k] : stiffness)
            out.bonds.push_back({first + pair.first, first + pair.second,
                                 float(length(at(pair.first) - at(pair.second))), float(k)});
    }
};

// Adds up the springs of cells and the mass at their corners.
struct Cells {
    const Scene& scene;
    const Object& object;
    const Nodes& nodes;
    Springs& springs;

    void add(int64_t i, int64_t j, int64_t k) {
        std::vector<int> directions;
        for (int d = 0; d < 3; ++d)
            if (nodes.extends(d)) directions.push_back(d);
        const int extents = int(directions.size()), corners = 1 << extents;
        auto corner = [&](int bits) {
            int64_t c[3] = {i, j, k};
            for (int e = 0; e < extents; ++e) c[directions[size_t(e)]] += bits >> e & 1;
            return nodes.index(c[0], c[1], c[2]);
        };
        double volume = 1;
        for (int e = 0; e < extents; ++e)
            volume *= length(springs.at(corner(1 << e)) - springs.at(corner(0)));
        // What is not a direction of the lattice is as thick as the wall, in 2D a metre deep.
        const bool flat = scene.simulation.dimensions == 2;
        const double rest = flat && extents == 2 ? 1.0 : object.thickness;
        const double full = extents == 3 ? volume : volume * rest,
                     a = std::pow(volume, 1.0 / extents);
        for (int c = 0; c < corners; ++c)
            springs.addMass(corner(c), object.density * full / corners);
        const double E = object.youngsModulus;
        const double edge = extents == 3   ? 0.1 * E * a
                            : extents == 2 ? 0.375 * E * rest
                                           : E * rest / a;
        const double diagonal = extents == 3 ? 0.2 * E * a : 0.375 * E * rest;
        for (int c = 0; c < corners; ++c)
            for (int d = c + 1; d < corners; ++d) {
                const int apart = __builtin_popcount(unsigned(c ^ d));
                if (apart <= 2) springs.join(corner(c), corner(d), apart == 1 ? edge : diagonal);
            }
    }
};

// x in world coordinates.
void addParticle(const Scene& scene, int number, Vec3d x, bool atSurface, ObjectSample& out) {
    const auto holds = [&](const Grip& g) {
        for (int d = 0; d < scene.simulation.dimensions; ++d)
            if (x[d] < double(g.min[d]) || x[d] > double(g.max[d])) return false;
        return true;
    };
    const auto grip = std::find_if(scene.grips.begin(), scene.grips.end(), holds);
    out.positions.push_back(toFloat(x - toDouble(scene.domain.min)));
    out.grips.push_back(grip == scene.grips.end() ? -1 : int(grip - scene.grips.begin()));
    out.atSurface.push_back(atSurface);
    out.masses.push_back(0);
    out.radii.push_back(0.5f * spacingOf(scene, scene.objects[size_t(number)]));
    out.objects.push_back(number);
}

void sampleLattice(const Scene& scene, int number, ObjectSample& out) {
    const Object& o = scene.objects[size_t(number)];
    const Nodes nodes = nodesOf(scene, o);
    Springs springs{out, int(out.size())};
    for (int64_t k = 0; k < nodes.n[2]; ++k)
        for (int64_t j = 0; j < nodes.n[1]; ++j)
            for (int64_t i = 0; i < nodes.n[0]; ++i)
                addParticle(scene, number, placeOf(scene, o, nodes, i, j, k),
                            nodes.atSurface(i, j, k), out);
    Cells cells{scene, o, nodes, springs};
    for (int64_t k = 0; k < nodes.cells(2); ++k)
        for (int64_t j = 0; j < nodes.cells(1); ++j)
            for (int64_t i = 0; i < nodes.cells(0); ++i) cells.add(i, j, k);
    springs.bond();
}

// How often each triangle of a shell is cut into four, until no edge is longer than one and a half
// spacings.
int divisionsOf(const Scene& scene, const Object& o, const Mesh& mesh) {
    double longest = 0;
    for (const Mesh::Triangle& t : mesh.triangles())
        for (size_t k = 0; k < 3; ++k)
            longest = std::max(longest, length(mesh.vertices()[size_t(t[k])] -
                                               mesh.vertices()[size_t(t[(k + 1) % 3])]));
    return std::max(0, int(std::ceil(std::log2(longest * o.scale / (1.5 * spacingOf(scene, o))))));
}

void divide(std::vector<Vec3d>& vertices, std::vector<Mesh::Triangle>& triangles) {
    std::map<std::pair<int, int>, int> middles;
    auto middle = [&](int a, int b) {
        const auto [found, isNew] =
            middles.insert({{std::min(a, b), std::max(a, b)}, int(vertices.size())});
        if (isNew) vertices.push_back(0.5 * (vertices[size_t(a)] + vertices[size_t(b)]));
        return found->second;
    };
    std::vector<Mesh::Triangle> parts;
    for (const auto [a, b, c] : triangles) {
        const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        parts.insert(parts.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(parts);
}

// Corners are particles, edges bonds: of a net of equal triangles those of a plane layer, with
// Poisson's ratio 1/3.
void sampleShell(const Scene& scene, int number, ObjectSample& out) {
    const Object& o = scene.objects[size_t(number)];
    const auto mesh = readMesh(o.path);
    std::vector<Vec3d> vertices = mesh->vertices();
    std::vector<Mesh::Triangle> triangles = mesh->triangles();
    for (int k = divisionsOf(scene, o, *mesh); k > 0; --k) divide(vertices, triangles);
    Springs springs{out, int(out.size())};
    for (const Vec3d& x : vertices)
        addParticle(scene, number, o.offset + double(o.scale) * x, true, out);
    const double k = std::numbers::sqrt3 / 4 * double(o.youngsModulus) * o.thickness;
    for (const Mesh::Triangle& t : triangles) {
        const Vec3d a = springs.at(t[0]), b = springs.at(t[1]), c = springs.at(t[2]);
        for (const int corner : t)
            springs.addMass(corner,
                            double(o.density) * o.thickness * length(cross(b - a, c - a)) / 6);
        springs.join(t[0], t[1], k), springs.join(t[1], t[2], k), springs.join(t[2], t[0], k);
    }
    springs.bond();
}

}  // namespace

float spacingOf(const Scene& scene, const Object& o) {
    return o.spacing > 0 ? o.spacing : scene.simulation.spacing;
}

ObjectSample sampleObjects(const Scene& scene) {
    ObjectSample out;
    for (size_t i = 0; i < scene.objects.size(); ++i)
        scene.objects[i].shape == ObjectShape::Shell ? sampleShell(scene, int(i), out)
                                                     : sampleLattice(scene, int(i), out);
    return out;
}

double countObjectParticles(const Scene& scene) {
    double all = 0;
    for (const Object& o : scene.objects) {
        if (o.shape == ObjectShape::Shell) {
            const auto mesh = readMesh(o.path);
            all += double(mesh->vertices().size()) * std::pow(4.0, divisionsOf(scene, o, *mesh));
            continue;
        }
        const Nodes nodes = nodesOf(scene, o);
        all += double(nodes.n[0]) * double(nodes.n[1]) * double(nodes.n[2]);
    }
    return all;
}

Vec3d middleOf(const Object& o) {
    if (o.shape == ObjectShape::Tube) return toDouble(o.center);
    return o.shape == ObjectShape::Shell ? o.offset : 0.5 * (toDouble(o.min) + toDouble(o.max));
}

ObjectRoom::ObjectRoom(const Scene& scene)
    : sample_(sampleObjects(scene)),
      fluidRadius_(0.5 * double(scene.simulation.spacing)),
      influence_(scene.contact.influence) {
    for (const float r : sample_.radii)
        cell_ = std::max(cell_, influence_ * (fluidRadius_ + double(r)));
    for (size_t i = 0; i < sample_.size(); ++i)
        cells_[cellOf(toDouble(sample_.positions[i]))].push_back(int(i));
}

ObjectRoom::Cell ObjectRoom::cellOf(Vec3d p) const {
    return {int64_t(std::floor(p.x / cell_)), int64_t(std::floor(p.y / cell_)),
            int64_t(std::floor(p.z / cell_))};
}

bool ObjectRoom::takes(Vec3d p) const {
    const auto near = [&](int n) {
        return length(toDouble(sample_.positions[size_t(n)]) - p) <
               0.98 * influence_ * (fluidRadius_ + double(sample_.radii[size_t(n)]));
    };
    const auto [x, y, z] = cellOf(p);
    for (int64_t k = z - 1; k <= z + 1; ++k)
        for (int64_t j = y - 1; j <= y + 1; ++j)
            for (int64_t i = x - 1; i <= x + 1; ++i)
                if (const auto found = cells_.find({i, j, k});
                    found != cells_.end() &&
                    std::any_of(found->second.begin(), found->second.end(), near))
                    return true;
    return false;
}

}  // namespace spindrift
