#include "scene/sample_solid.h"

#include "scene/convex.h"
#include "scene/lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

using std::numbers::pi;
struct Point2 {
    double x, y;
};

// Cell centres of n equal pieces of [-half, half].
std::vector<double> centres(double half, double dx) {
    const int n = std::max(1, int(std::round(2 * half / dx)));
    std::vector<double> at;
    for (int i = 0; i < n; ++i) at.push_back(half * ((2 * i + 1.0) / n - 1));
    return at;
}

// How many layers deep the i-th of n cells lies, from the nearer end.
int depthOf(size_t i, size_t n) { return int(std::min(i, n - 1 - i)); }

// Points on a ring in the plane, `depth` metres inside the outline.
std::vector<Point2> circle(double radius, double dx) {
    if (radius < 0.3 * dx) return {{0, 0}};
    const int n = std::max(3, int(std::round(2 * pi * radius / dx)));
    std::vector<Point2> ring;
    for (int i = 0; i < n; ++i)
        ring.push_back({radius * std::cos(2 * pi * i / n), radius * std::sin(2 * pi * i / n)});
    return ring;
}

// The triangle (-b, -h), (b, -h), (0, h), its sides moved inside; nothing where little is left.
std::vector<Point2> triangle(double b, double h, double depth, double dx) {
    const double side = std::hypot(b, 2 * h), inRadius = 2 * b * h / (b + side);
    if (depth > inRadius - 0.2 * dx) return {};
    // All sides move as the triangle shrinks towards the centre of its inscribed circle.
    const double scale = 1 - depth / inRadius, centreY = -h + inRadius;
    auto corner = [&](double x, double y) {
        return Point2{scale * x, centreY + scale * (y - centreY)};
    };
    const Point2 corners[] = {corner(-b, -h), corner(b, -h), corner(0, h), corner(-b, -h)};
    std::vector<Point2> ring;
    for (int k = 0; k < 3; ++k) {
        const Point2 from = corners[k], to = corners[k + 1];
        const int n = std::max(1, int(std::round(std::hypot(to.x - from.x, to.y - from.y) / dx)));
        for (int i = 0; i < n; ++i)
            ring.push_back({from.x + (to.x - from.x) * i / n, from.y + (to.y - from.y) * i / n});
    }
    return ring;
}

// Relative to the solid's middle; volumes in units of spacing^dimensions.
struct Points {
    std::vector<Vec3d> at;
    std::vector<double> volumes;
    void add(Vec3d p, double volume) { at.push_back(p), volumes.push_back(volume); }
};

// Evenly on a sphere along a spiral (Fibonacci lattice, Swinbank & Purser 2006).
void addSphere(double radius, double dx, Points& out) {
    const double area = 4 * pi * radius * radius / (dx * dx), golden = pi * (3 - std::sqrt(5.0));
    const int n = std::max(1, int(std::round(area)));
    for (int i = 0; i < n; ++i) {
        const double y = 1 - (2 * i + 1.0) / n, across = std::sqrt(1 - y * y);
        out.add(radius * Vec3d{across * std::cos(golden * i), y, across * std::sin(golden * i)},
                (area + pi / 3) / n);
    }
}

// A lattice that fits the block, without its inside.
void addBlock(const Scene& scene, Vec3d half, int layers, Points& out) {
    const double dx = scene.simulation.spacing;
    const bool flat = scene.simulation.dimensions == 2;
    const std::vector<double> x = centres(half.x, dx), y = centres(half.y, dx),
                              z = flat ? std::vector<double>{0} : centres(half.z, dx);
    auto step = [&](double halfSide, size_t n) { return 2 * halfSide / (double(n) * dx); };
    const double volume =
        step(half.x, x.size()) * step(half.y, y.size()) * (flat ? 1 : step(half.z, z.size()));
    for (size_t k = 0; k < z.size(); ++k)
        for (size_t j = 0; j < y.size(); ++j)
            for (size_t i = 0; i < x.size(); ++i)
                if (std::min({depthOf(i, x.size()), depthOf(j, y.size()),
                              flat ? layers : depthOf(k, z.size())}) < layers)
                    out.add({x[i], y[j], z[k]}, volume);
}

double lengthOf(const std::vector<Point2>& ring) {
    double sum = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
        const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
        sum += std::hypot(b.x - a.x, b.y - a.y);
    }
    return sum;
}

// Rings in planes along an axis; planes near the ends are filled.
void addPrism(const Scene& scene, const Solid& solid, int layers, Points& out) {
    const double dx = scene.simulation.spacing;
    const Vec3d half = halfExtent(solid);
    const bool flat = scene.simulation.dimensions == 2, round = solid.shape != Shape::Wedge;
    const int axis = flat || !round ? 2 : int(solid.axis);
    const std::vector<double> planes = flat ? std::vector<double>{0} : centres(half[axis], dx);
    const double thickness = flat ? 1 : 2 * half[axis] / (double(planes.size()) * dx);
    for (size_t k = 0; k < planes.size(); ++k) {
        const bool filled = !flat && depthOf(k, planes.size()) < layers;
        for (int layer = 0; filled || layer < layers; ++layer) {
            const double depth = (layer + 0.5) * dx, radius = solid.radius - depth;
            if (round && radius < 0) break;
            const std::vector<Point2> ring =
                round ? circle(radius, dx) : triangle(half.x, half.y, depth, dx);
            if (ring.empty()) break;
            const double around = round ? std::max(2 * pi * radius, dx) : lengthOf(ring);
            for (const Point2& p : ring) {
                Vec3d at;
                at[axis] = planes[k], at[(axis + 1) % 3] = p.x, at[(axis + 2) % 3] = p.y;
                out.add(at, thickness * around / (dx * double(ring.size())));
            }
        }
    }
}

// Along one axis: where particles can be seen, and how far they are apart, which along an axis of
// the domain fits it as its walls' lattice does.
struct Stretch {
    double low, high, step;
};
Stretch stretchAlong(const Scene& scene, Vec3d direction) {
    const double dx = scene.simulation.spacing, R = supportRadius(scene);
    const Vec3d size = scene.domain.size();
    Stretch s{0, 0, dx};
    for (int k = 0; k < 3; ++k) {
        const double beyond = scene.domain.periodic(k) ? 0 : R;
        s.low += std::min(-beyond * direction[k], (size[k] + beyond) * direction[k]),
            s.high += std::max(-beyond * direction[k], (size[k] + beyond) * direction[k]);
        if (direction[k] == 1) s.step = wallStep(scene)[k];
    }
    return s;
}

// Layers of a lattice of squares; relative to domain.min. In two dimensions rows.
void addPlane(const Scene& scene, const Solid& solid, int layers, Points& out) {
    const double dx = scene.simulation.spacing;
    const bool flat = scene.simulation.dimensions == 2;
    const Vec3d normal = normalized(toDouble(solid.normal)), size = scene.domain.size();
    // Across: the axis of the domain that is least along the normal, in its projection, and what is
    // across both.
    int least = flat ? 2 : 0;
    for (int k = 1; k < 3 && !flat; ++k)
        if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
    Vec3d axis{0, 0, 0};
    axis[least] = 1;
    const Vec3d first = normalized(axis - normal[least] * normal);
    Vec3d second = cross(normal, first);
    if (second.x + second.y + second.z < 0) second = -1.0 * second;
    const Stretch a = flat ? Stretch{0, dx, dx} : stretchAlong(scene, first),
                  b = stretchAlong(scene, second);
    const double height = dot(normal, toDouble(solid.center) - toDouble(scene.domain.min));
    const double volume = flat ? b.step / dx : a.step * b.step / (dx * dx);
    auto inside = [&](Vec3d p) {
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            const double beyond = scene.domain.periodic(k) ? 0 : double(supportRadius(scene));
            if (p[k] < -beyond || p[k] >= size[k] + beyond) return false;
        }
        return true;
    };
    const double middle = flat ? 0.5 * size.z : 0;
    for (int layer = 0; layer < layers; ++layer)
        for (double i = std::floor(a.low / a.step); i * a.step < a.high; ++i)
            for (double j = std::floor(b.low / b.step); j * b.step < b.high; ++j) {
                Vec3d p = (height - (layer + 0.5) * dx) * normal + ((j + 0.5) * b.step) * second;
                if (flat)
                    p.z = middle;
                else
                    p = p + ((i + 0.5) * a.step) * first;
                if (inside(p)) out.add(p, volume);
            }
}

// What is inside of the cells of a lattice that fits the mesh's box: a particle where its middle
// is, with its volume. Cells are looked at in boxes, of which most are too far inside or outside.
class MeshSampler {
public:
    MeshSampler(const Convex& shape, double dx, int layers, Points& out)
        : shape_(shape), deepest_(layers * dx), out_(out) {
        const double half[3] = {shape.offset[0], shape.offset[2], shape.offset[4]};
        int end[3];
        for (int k = 0; k < 3; ++k) {
            end[k] = std::max(1, int(std::round(2 * half[k] / dx)));
            cell_[k] = 2 * half[k] / end[k], low_[k] = -half[k];
        }
        volume_ = cell_.x * cell_.y * cell_.z / (dx * dx * dx);
        const int first[3] = {0, 0, 0};
        divide(first, end);
    }

private:
    void divide(const int (&first)[3], const int (&end)[3]) {
        Vec3d half, middle;
        int longest = 0;
        for (int k = 0; k < 3; ++k) {
            half[k] = 0.5 * (end[k] - first[k]) * cell_[k],
            middle[k] = low_[k] + first[k] * cell_[k] + half[k];
            if (end[k] - first[k] > end[longest] - first[longest]) longest = k;
        }
        const double distance = shape_.nearestOfMesh(middle, triangle_).distance,
                     reach = length(half);
        if (distance > reach || distance < -deepest_ - reach) return;
        if (end[longest] - first[longest] == 1) return addCell(middle, distance < -reach);
        for (int side : {0, 1}) {
            int from[3] = {first[0], first[1], first[2]}, to[3] = {end[0], end[1], end[2]};
            (side ? from : to)[longest] = (first[longest] + end[longest]) / 2;
            divide(from, to);
        }
    }
    void addCell(Vec3d middle, bool whole) {
        double share = whole ? 1 : 0;
        Vec3d at = whole ? middle : Vec3d{};
        constexpr int N = 4;  // parts a side
        for (int i = 0; i < N * N * N && !whole; ++i) {
            const Vec3d p = middle + Vec3d{((i % N + 0.5) / N - 0.5) * cell_.x,
                                           ((i / N % N + 0.5) / N - 0.5) * cell_.y,
                                           ((i / (N * N) + 0.5) / N - 0.5) * cell_.z};
            const double part =
                std::clamp(0.5 - shape_.nearestOfMesh(p, triangle_).distance * N / cell_.x, 0.0,
                           1.0) /
                (N * N * N);
            share += part, at = at + part * p;
        }
        if (share < 0.02) return;
        if (!whole) at = (1 / share) * at;
        if (-shape_.nearestOfMesh(at, triangle_).distance < deepest_) out_.add(at, share * volume_);
    }

    const Convex& shape_;
    double deepest_, volume_;
    Vec3d low_, cell_;
    int triangle_ = -1;
    Points& out_;
};

}  // namespace

int boundaryLayers(const Scene& scene) {
    return std::max(1, int(std::ceil(scene.simulation.support)) - 1);
}

SolidSample sampleSolid(const Scene& scene, const Solid& solid) {
    const int layers = boundaryLayers(scene);
    const double dx = scene.simulation.spacing;
    const bool flat = scene.simulation.dimensions == 2;
    Points points;
    if (isBlock(solid))
        addBlock(scene, halfExtent(solid), layers, points);
    else if (solid.shape == Shape::Sphere && !flat)
        for (int k = 0; k < layers && (k + 0.5) * dx < double(solid.radius); ++k)
            addSphere(solid.radius - (k + 0.5) * dx, dx, points);
    else if (solid.shape == Shape::Plane)
        addPlane(scene, solid, layers, points);
    else if (solid.shape == Shape::Mesh)
        MeshSampler(convexOf(solid, 3), dx, layers, points);
    else
        addPrism(scene, solid, layers, points);
    Vec3d middle = solid.shape == Shape::Plane
                       ? Vec3d{}
                       : convexOf(solid, 3).middle - toDouble(scene.domain.min);
    if (flat && solid.shape != Shape::Plane)
        middle.z = 0.5 * (toDouble(scene.domain.max) - toDouble(scene.domain.min)).z;
    const Vec3d size = toDouble(scene.domain.max) - toDouble(scene.domain.min);
    auto seen = [&](Vec3d p) {  // by any fluid, ever
        for (int k = 0; k < scene.simulation.dimensions; ++k)
            if (std::max(-p[k], p[k] - size[k]) > double(supportRadius(scene)))
                return !solid.isAsDrawn();
        return true;
    };
    SolidSample out;
    for (size_t i = 0; i < points.at.size(); ++i)
        if (const Vec3d p = middle + points.at[i]; seen(p))
            out.positions.push_back(toFloat(p)), out.volumes.push_back(float(points.volumes[i]));
    return out;
}

double mostOfPlane(const Scene& scene) {
    Vec3d most = scene.domain.size();
    for (int k = 0; k < 3; ++k) most[k] += 2 * double(supportRadius(scene));
    const double across =
        (length(most) + 2 * scene.simulation.spacing) / (0.6 * double(scene.simulation.spacing));
    return boundaryLayers(scene) * (scene.simulation.dimensions == 2 ? across : across * across);
}

}  // namespace spindrift
