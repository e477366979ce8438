#include "scene/particles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

// Counts beyond this stay here, so that a product of three fits in 64 bits.
constexpr double MaxPlanes = 2e6;

// A lattice in doubles: point (i, j, k) is at first + i * step, per axis.
struct Lattice {
    int64_t n[3];
    Vec3d first, step;
    Vec3d at(int64_t i, int64_t j, int64_t k) const {
        return {first.x + i * step.x, first.y + j * step.y, first.z + k * step.z};
    }
};

int64_t planes(double ratio) {
    return std::isfinite(ratio) ? int64_t(std::clamp(ratio, 0.0, MaxPlanes)) : int64_t(MaxPlanes);
}

Vec3d domainSize(const Scene& scene) {
    return toDouble(scene.domain.max) - toDouble(scene.domain.min);
}

// In two dimensions z has one layer.
bool flat(const Scene& scene, int axis) { return scene.simulation.dimensions == 2 && axis == 2; }

// Half the body's extent along each axis, m.
Vec3d halfExtent(const Body& body) {
    if (body.shape == Shape::Block) return 0.5 * (toDouble(body.max) - toDouble(body.min));
    Vec3d half{body.radius, body.radius, body.radius};
    if (body.shape == Shape::Cylinder) half[int(body.axis)] = 0.5 * double(body.height);
    return half;
}

// The body's cell-centred lattice relative to domain.min: a block's begins half a spacing inside
// its lower corner, a round body's is symmetric about its centre.
Lattice bodyLattice(const Scene& scene, const Body& body) {
    const double dx = scene.simulation.spacing;
    Lattice lattice{{}, {}, {dx, dx, flat(scene, 2) ? 0 : dx}};
    const Vec3d origin = toDouble(scene.domain.min);
    for (int k = 0; k < 3; ++k) {
        lattice.n[k] = latticePlanes(scene, body, k);
        if (flat(scene, k)) {
            lattice.first[k] = 0.5 * domainSize(scene)[k];
            continue;
        }
        lattice.first[k] = body.shape == Shape::Block ? double(body.min[k]) - origin[k] + 0.5 * dx
                                                      : double(body.center[k]) - origin[k] -
                                                            0.5 * dx * double(lattice.n[k] - 1);
    }
    return lattice;
}

// Whether p, relative to domain.min, lies in the body or nearer than `margin` metres to its round
// side. Flat sides are taken where the lattice ends, half a spacing beyond its last plane.
bool contains(const Body& body, const Lattice& lattice, Vec3d origin, Vec3d p, double margin) {
    for (int k = 0; k < 3; ++k) {
        const bool plane =
            body.shape == Shape::Block || (body.shape == Shape::Cylinder && k == int(body.axis));
        if (!plane) continue;
        const double low = lattice.first[k] - 0.5 * lattice.step[k];
        if (p[k] < low || p[k] > low + double(lattice.n[k]) * lattice.step[k]) return false;
    }
    if (body.shape == Shape::Block) return true;
    Vec3d d = p - (toDouble(body.center) - origin);
    if (lattice.step.z == 0) d.z = 0;   // two dimensions
    if (body.shape == Shape::Cylinder) d[int(body.axis)] = 0;
    // The tolerance keeps lattice points on the surface on both sides of the centre alike.
    return length(d) <= double(body.radius) + margin + 1e-6 * lattice.step.x;
}

// Layers of boundary particles on each face of an axis, none where it has none: all that fluid half a spacing from the face can see. Classic: one.
int64_t wallLayers(const Scene& scene, int axis) {
    if (scene.domain.periodic(axis) || flat(scene, axis)) return 0;
    if (scene.simulation.formulation == Formulation::Classic) return 1;
    return std::max<int64_t>(1, int64_t(std::ceil(scene.simulation.support)) - 1);
}

// The lattice whose outer layers are boundary particles. Default: it continues the fluid's lattice, the first layer half
// a spacing outside each face. Classic: 2G points an edge at 0.999 i L/(2G-1), G = ceil(L/R) rounded as the
// original's floats do.
Lattice wallLattice(const Scene& scene) {
    Lattice lattice{};
    const Vec3d size = domainSize(scene);
    const double dx = scene.simulation.spacing;
    const float R = supportRadius(scene);
    for (int k = 0; k < 3; ++k) {
        if (scene.simulation.formulation == Formulation::Classic) {
            const float side = scene.domain.max[k] - scene.domain.min[k];
            lattice.n[k] = std::max<int64_t>(2, planes(2 * double(std::ceil(side / R))));
            lattice.step[k] = 0.999 * size[k] / double(lattice.n[k] - 1);
        } else {
            const int64_t inside = flat(scene, k) ? 1 : std::max<int64_t>(1, planes(std::round(size[k] / dx)));
            lattice.step[k] = size[k] / double(inside);
            lattice.n[k] = inside + 2 * wallLayers(scene, k);
            lattice.first[k] = (0.5 - double(wallLayers(scene, k))) * lattice.step[k];
        }
    }
    return lattice;
}

// The points of a lattice that are not in its inside.
struct Shell {
    Lattice lattice;
    int64_t layers[3];
    int64_t count() const {
        int64_t all = 1, inner = 1;
        for (int k = 0; k < 3; ++k) {
            all *= lattice.n[k];
            inner *= std::max<int64_t>(0, lattice.n[k] - 2 * layers[k]);
        }
        return all - inner;
    }
    bool contains(int64_t i, int axis) const { return i < layers[axis] || i >= lattice.n[axis] - layers[axis]; }
};

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

// At p, relative to domain.min. Taylor and Green 1937, one wave length along each side of the domain.
Vec3 startVelocity(const Scene& scene, const Body& body, Vec3d p) {
    if (body.field == Field::Uniform) return body.velocity;
    const Vec3d size = domainSize(scene);
    const double amplitude = length(toDouble(body.velocity)), turn = 2 * std::numbers::pi;
    const double x = turn * p.x / size.x, y = turn * p.y / size.y;
    return toFloat(amplitude * Vec3d{-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y), 0});
}

// Appends the points of body `b` that are not in an earlier body.
void placeBody(const Scene& scene, const std::vector<Lattice>& lattices, size_t b, Placement& out) {
    const std::vector<Body>& bodies = scene.fluid.bodies;
    const Vec3d origin = toDouble(scene.domain.min);
    const double halfSpacing = 0.5 * double(scene.simulation.spacing);
    const Lattice& l = lattices[b];
    for (int64_t k = 0; k < l.n[2]; ++k)
        for (int64_t j = 0; j < l.n[1]; ++j)
            for (int64_t i = 0; i < l.n[0]; ++i) {
                const Vec3d p = l.at(i, j, k);
                bool free = contains(bodies[b], l, origin, p, 0);
                for (size_t e = 0; e < b && free; ++e)
                    free = !contains(bodies[e], lattices[e], origin, p, halfSpacing);
                if (!free) continue;
                out.positions.push_back(toFloat(p));
                out.velocities.push_back(startVelocity(scene, bodies[b], p));
            }
}

}  // namespace

float supportRadius(const Scene& scene) {
    return scene.simulation.support * scene.simulation.spacing;
}

float particleMass(const Scene& scene) {
    if (scene.fluid.particleMass > 0) return scene.fluid.particleMass;
    const float dx = scene.simulation.spacing;
    return scene.fluid.restDensity * dx * dx * dx;
}

int64_t latticePlanes(const Scene& scene, const Body& body, int axis) {
    if (flat(scene, axis)) return 1;
    const double dx = scene.simulation.spacing;
    const double extent = 2 * halfExtent(body)[axis];
    int64_t n = planes(std::round(extent / dx));
    if (body.shape != Shape::Block) return n;
    // A block that ends at the wall must not round up into it.
    const double room = double(scene.domain.max[axis]) - double(body.min[axis]);
    return n > 0 && double(n) * dx > room + 0.25 * dx ? n - 1 : n;
}

Placement placeParticles(const Scene& scene) {
    Placement out;
    std::vector<Lattice> lattices;
    for (const Body& body : scene.fluid.bodies) lattices.push_back(bodyLattice(scene, body));
    const size_t expected = size_t(countParticles(scene).fluid);
    out.positions.reserve(expected);
    out.velocities.reserve(expected);
    for (size_t b = 0; b < lattices.size(); ++b) placeBody(scene, lattices, b, out);
    if (scene.walls.kind == WallKind::Particles) placeShell(wallShell(scene), out.walls);
    return out;
}

ParticleCount countParticles(const Scene& scene) {
    ParticleCount count;
    const double dx = scene.simulation.spacing;
    double fluid = 0;
    for (const Body& body : scene.fluid.bodies) {
        const Lattice l = bodyLattice(scene, body);
        double points = double(l.n[0]) * double(l.n[1]) * double(l.n[2]);
        if (scene.simulation.dimensions == 2) {
            fluid += points;
            continue;
        }
        // Every kept point's cell lies in the round body grown by half a cell's diagonal.
        const double r = double(body.radius) / dx + 0.5 * std::numbers::sqrt3;
        if (body.shape == Shape::Sphere)
            points = std::min(points, 4.0 / 3 * std::numbers::pi * r * r * r);
        if (body.shape == Shape::Cylinder)
            points = std::min(points, std::numbers::pi * r * r * double(l.n[int(body.axis)]));
        fluid += points;
    }
    count.fluid = int64_t(std::min(fluid, 9e18));
    if (scene.walls.kind == WallKind::Particles) count.walls = wallShell(scene).count();
    return count;
}

}  // namespace spindrift
