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

// Counts beyond this stay here, so that a product of three fits in 64 bits.
constexpr double MaxPlanes = 2e6;

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

// The lattice whose outer layers are boundary particles. Default: it continues the fluid's lattice,
// the first layer half a spacing outside each face. Classic: 2G points an edge at 0.999 i L/(2G-1),
// G = ceil(L/R) rounded as the original's floats do.
Lattice wallLattice(const Scene& scene) {
    Lattice lattice{};
    const Vec3d size = scene.domain.size(), step = wallStep(scene);
    const float R = supportRadius(scene);
    for (int k = 0; k < 3; ++k) {
        if (factsOf(scene).isHistorical) {
            const float side = scene.domain.max[k] - scene.domain.min[k];
            lattice.n[k] = std::max<int64_t>(2, planes(2 * double(std::ceil(side / R))));
            lattice.step[k] = 0.999 * size[k] / double(lattice.n[k] - 1);
        } else {
            const int64_t inside =
                flat(scene, k) ? 1 : std::max<int64_t>(1, planes(std::round(size[k] / step[k])));
            lattice.step[k] = flat(scene, k) ? size[k] : step[k];
            lattice.n[k] = inside + 2 * wallLayers(scene, k);
            lattice.first[k] = (0.5 - double(wallLayers(scene, k))) * lattice.step[k];
        }
    }
    return lattice;
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
        all *= lattice.n[k];
        inner *= std::max<int64_t>(0, lattice.n[k] - 2 * layers[k]);
    }
    return all - inner;
}

Shell wallShell(const Scene& scene) {
    return {wallLattice(scene), {wallLayers(scene, 0), wallLayers(scene, 1), wallLayers(scene, 2)}};
}

void placeShell(const Shell& shell, std::vector<Vec3>& out) {
    const Lattice& l = shell.lattice;
    out.reserve(size_t(shell.count()));
    for (int64_t k = 0; k < l.n[2]; ++k)
        for (int64_t j = 0; j < l.n[1]; ++j)
            for (int64_t i = 0; i < l.n[0]; ++i) {
                if (shell.contains(i, 0) || shell.contains(j, 1) || shell.contains(k, 2))
                    out.push_back(toFloat(l.at(i, j, k)));
                else
                    i = l.n[0] - shell.layers[0] - 1;  // on to the far face
            }
}

}  // namespace spindrift
