#include "scene/body_lattice.h"

#include "scene/body_parts.h"
#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/lattice.h"
#include "scene/sample_solid.h"

#include <algorithm>
#include <cmath>

namespace spindrift {

bool flat(const Scene& scene, int axis) { return scene.simulation.dimensions == 2 && axis == 2; }

double leastStep(const Lattice& l) {
    return std::min({l.step.x, l.step.y, l.step.z > 0 ? l.step.z : l.step.x});
}

namespace {

int64_t planes(double ratio) {
    return std::isfinite(ratio) ? int64_t(std::clamp(ratio, 0.0, MaxPlanes)) : int64_t(MaxPlanes);
}

// The planes of a body along an axis, m from the domain's lower corner: a cornered one's begin half
// a step inside its lower corner, a round body's are symmetric about its centre.
struct Planes {
    int64_t count;
    double first, step;
};
Planes planesOf(const Scene& scene, const Body& body, int axis, double step) {
    if (flat(scene, axis)) return {1, 0.5 * scene.domain.size()[axis], 0};
    const double origin = scene.domain.min[axis];
    if (!isBox(body)) {
        const int64_t n = planes(std::round(2 * halfExtent(body)[axis] / step));
        return {n, convexOf(body, 3).middle[axis] - 0.5 * step * double(n - 1) - origin, step};
    }
    const auto [low, count, s] = layersOf(scene, body, axis, step);
    // A body that ends at the wall must not round up into it.
    const double room = double(scene.domain.max[axis]) - low;
    const int64_t n = count > 0 && double(count) * s > room + 0.25 * s ? count - 1 : count;
    return {n, low + 0.5 * s - origin, s};
}

// Layers of boundary particles on each face of an axis, none where it has none: all that fluid half
// a spacing from the face can see. Classic: one.
int64_t wallLayers(const Scene& scene, int axis) {
    if (scene.domain.periodic(axis) || flat(scene, axis)) return 0;
    if (factsOf(scene).isHistorical) return 1;
    return boundaryLayers(scene);
}

// Across an axis, of which the outer ones hold boundary particles. Default: they continue the
// fluid's lattice, the first layer half a spacing outside each face. Classic: 2G points an edge at
// 0.999 i L/(2G-1), G = ceil(L/R) rounded as the original's floats do.
std::vector<double> wallPlanes(const Scene& scene, int axis) {
    const double size = scene.domain.size()[axis];
    if (flat(scene, axis)) return {0.5 * size};
    std::vector<double> at;
    auto add = [&](double first, int64_t count, double step) {
        for (int64_t i = 0; i < count; ++i) at.push_back(first + double(i) * step);
    };
    if (factsOf(scene).isHistorical) {
        const float side = scene.domain.max[axis] - scene.domain.min[axis];
        const int64_t n =
            std::max<int64_t>(2, planes(2 * double(std::ceil(side / supportRadius(scene)))));
        add(0, n, 0.999 * size / double(n - 1));
        return at;
    }
    const std::vector<WallCells> cells = wallCells(scene, axis);
    const int64_t layers = wallLayers(scene, axis);
    const double outside = wallStep(scene)[axis];
    if (cells.size() == 1 && cells[0].low == 0) {
        add((0.5 - double(layers)) * cells[0].step, cells[0].count + 2 * layers, cells[0].step);
        return at;
    }
    add((0.5 - double(layers)) * outside, layers, outside);
    for (const WallCells& some : cells) add(some.low + 0.5 * some.step, some.count, some.step);
    add(size + 0.5 * outside, layers, outside);
    return at;
}

}  // namespace

Lattice bodyLattice(const Scene& scene, const Body& body) {
    const Vec3d step = latticeStep(scene);
    Lattice lattice{{}, {}, step};
    if (flat(scene, 2)) lattice.step.z = 0;
    if (body.shape == Shape::File) return lattice;  // no point
    for (int k = 0; k < 3; ++k) {
        const Planes p = planesOf(scene, body, k, step[k]);
        lattice.n[k] = p.count, lattice.first[k] = p.first, lattice.step[k] = p.step;
    }
    return lattice;
}

std::vector<Lattice> latticesOf(const Scene& scene) {
    std::vector<Lattice> lattices;
    for (const Body& body : scene.fluid.bodies) lattices.push_back(bodyLattice(scene, body));
    return lattices;
}

int64_t latticePlanes(const Scene& scene, const Body& body, int axis) {
    return planesOf(scene, body, axis, latticeStep(scene)[axis]).count;
}

bool contains(const Body& body, const Lattice& lattice, Vec3d origin, Vec3d p) {
    if (body.shape == Shape::File) return false;
    for (int k = 0; k < 3; ++k) {
        if (!hasFlatEnds(body, k)) continue;
        const double low = lattice.first[k] - 0.5 * lattice.step[k];
        if (p[k] < low || p[k] > low + double(lattice.n[k]) * lattice.step[k]) return false;
    }
    if (body.shape == Shape::Block) return true;
    if (body.shape == Shape::Wedge) {
        const Convex wedge = convexOf(body, 2);
        return wedge.nearest(p + origin - wedge.middle).distance <= 1e-6 * lattice.step.x;
    }
    if (body.shape == Shape::Mesh) {  // files round coordinates
        const Convex mesh = convexOf(body, 3);
        return mesh.nearest(p + origin - mesh.middle).distance <= 1e-4 * lattice.step.x;
    }
    Vec3d d = p - (toDouble(body.center) - origin);
    if (lattice.step.z == 0) d.z = 0;  // two dimensions
    if (body.shape == Shape::Cylinder) d[int(body.axis)] = 0;
    // The tolerance keeps lattice points on the surface on both sides of the centre alike.
    return length(d) <= double(body.radius) + 1e-6 * lattice.step.x;
}

bool crowds(const Body& body, const Lattice& l, Vec3d origin, Vec3d p) {
    const double least = 0.98 * leastStep(l);
    int64_t low[3];
    for (int k = 0; k < 3; ++k)
        low[k] = l.step[k] > 0 ? int64_t(std::floor((p[k] - l.first[k]) / l.step[k])) : 0;
    for (int corner = 0; corner < 8; ++corner) {
        int64_t at[3];
        bool inside = true;
        for (int k = 0; k < 3; ++k)
            at[k] = low[k] + (corner >> k & 1), inside = inside && at[k] >= 0 && at[k] < l.n[k];
        const Vec3d q = l.at(at[0], at[1], at[2]);
        if (inside && length(p - q) < least && contains(body, l, origin, q)) return true;
    }
    return false;
}

int64_t Shell::count() const {
    int64_t all = 1, inner = 1;
    for (int k = 0; k < 3; ++k) {
        all *= size(k);
        inner *= std::max<int64_t>(0, size(k) - 2 * layers[k]);
    }
    return all - inner;
}

Shell wallShell(const Scene& scene) {
    return {{wallPlanes(scene, 0), wallPlanes(scene, 1), wallPlanes(scene, 2)},
            {wallLayers(scene, 0), wallLayers(scene, 1), wallLayers(scene, 2)}};
}

void placeShell(const Shell& shell, std::vector<Vec3>& out) {
    out.reserve(size_t(shell.count()));
    for (int64_t k = 0; k < shell.size(2); ++k)
        for (int64_t j = 0; j < shell.size(1); ++j)
            for (int64_t i = 0; i < shell.size(0); ++i) {
                if (shell.contains(i, 0) || shell.contains(j, 1) || shell.contains(k, 2))
                    out.push_back(
                        toFloat(Vec3d{shell.planes[0][size_t(i)], shell.planes[1][size_t(j)],
                                      shell.planes[2][size_t(k)]}));
                else
                    i = shell.size(0) - shell.layers[0] - 1;  // on to the far face
            }
}

}  // namespace spindrift
