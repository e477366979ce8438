#include "app/solid_shapes.h"

#include "scene/convex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace spindrift {

namespace {

using Polygon = std::vector<Vec3d>;

struct HalfSpace {
    Vec3d normal;
    double offset;  // inside where normal.x < offset
};

Polygon cut(const Polygon& polygon, const HalfSpace& half) {
    Polygon inside;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = dot(half.normal, a) - half.offset, db = dot(half.normal, b) - half.offset;
        if (da <= 0) inside.push_back(a);
        if ((da < 0) != (db < 0) && da != db) inside.push_back(a + (da / (da - db)) * (b - a));
    }
    return inside;
}

// A square in the plane of `half`, with sides of twice `reach`.
Polygon faceOf(const HalfSpace& half, double reach) {
    const Vec3d n = half.normal, other = std::abs(n.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d u = cross(n, other);
    u = (reach / length(u)) * u;
    const Vec3d v = cross(n, u), middle = half.offset * n;
    return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
}

void addTriangle(SolidShape& shape, Vec3d a, Vec3d b, Vec3d c, Vec3d na, Vec3d nb, Vec3d nc) {
    for (const auto& [x, n] : {std::pair{a, na}, {b, nb}, {c, nc}})
        shape.corners.push_back({toFloat(x), toFloat(n)});
}

void addPolygon(SolidShape& shape, const Polygon& p, Vec3d normal) {
    for (size_t i = 2; i < p.size(); ++i)
        addTriangle(shape, p[0], p[i - 1], p[i], normal, normal, normal);
    for (size_t i = 0; i < p.size() && p.size() > 2; ++i)
        shape.edges.push_back({toFloat(p[i]), toFloat(p[(i + 1) % p.size()])});
}

bool isWithin(const Polygon& polygon, const HalfSpace& plane, double slack) {
    return std::all_of(polygon.begin(), polygon.end(), [&](Vec3d p) {
        return std::abs(dot(plane.normal, p) - plane.offset) < slack;
    });
}

// The faces of what some planes bound. Of two in the same place, where nothing is between them, one
// is enough: both would flicker.
void addFaces(SolidShape& shape, const std::vector<HalfSpace>& planes, double reach) {
    for (size_t f = 0; f < planes.size(); ++f) {
        Polygon face = faceOf(planes[f], reach);
        for (size_t k = 0; k < planes.size(); ++k)
            if (k != f) face = cut(face, planes[k]);
        const bool isTwin = std::any_of(planes.begin(), planes.begin() + long(f), [&](auto& plane) {
            return isWithin(face, plane, 1e-7 * reach);
        });
        if (!isTwin) addPolygon(shape, face, planes[f].normal);
    }
}

// Around `axis`, from -half to half along it: the side, and flat ends.
void addCylinder(SolidShape& shape, int axis, double radius, double half) {
    constexpr int corners = 64;
    Polygon top, bottom;
    const auto at = [&](int i, double along) {
        const double angle = 2 * std::numbers::pi * i / corners;
        Vec3d p;
        p[axis] = along, p[(axis + 1) % 3] = radius * std::cos(angle),
        p[(axis + 2) % 3] = radius * std::sin(angle);
        return p;
    };
    for (int i = 0; i < corners; ++i) {
        const Vec3d a = at(i, -half), b = at(i + 1, -half), c = at(i + 1, half), d = at(i, half);
        const Vec3d na = (1 / radius) * at(i, 0), nb = (1 / radius) * at(i + 1, 0);
        addTriangle(shape, a, b, c, na, nb, nb), addTriangle(shape, a, c, d, na, nb, na);
        top.push_back(d), bottom.push_back(a);
    }
    Vec3d up{0, 0, 0};
    up[axis] = 1;
    addPolygon(shape, top, up), addPolygon(shape, bottom, -1.0 * up);
}

void addSphere(SolidShape& shape, double radius) {
    constexpr int rings = 32, sectors = 64;
    const auto at = [](int i, int j) {
        const double polar = std::numbers::pi * i / rings,
                     turn = 2 * std::numbers::pi * j / sectors;
        return Vec3d{std::sin(polar) * std::cos(turn), std::cos(polar),
                     std::sin(polar) * std::sin(turn)};
    };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            const Vec3d a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
            addTriangle(shape, radius * a, radius * b, radius * c, a, b, c),
                addTriangle(shape, radius * a, radius * c, radius * d, a, c, d);
        }
}

// Flat triangles, and the edges where the surface turns by more than 25 degrees.
void addMesh(SolidShape& shape, const Mesh& mesh, double scale) {
    const Vec3d middle = 0.5 * (mesh.low() + mesh.high());
    std::map<std::pair<int, int>, Vec3d> normals;  // of the triangle on one side of an edge
    for (const Mesh::Triangle& t : mesh.triangles()) {
        Vec3d p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = scale * (mesh.vertices()[size_t(t[k])] - middle);
        Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
        n = (1 / std::max(length(n), 1e-300)) * n;
        addTriangle(shape, p[0], p[1], p[2], n, n, n);
        for (size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            const auto [other, isFirst] = normals.try_emplace({a, b}, n);
            if (!isFirst && dot(other->second, n) < 0.906)
                shape.edges.push_back({toFloat(p[k]), toFloat(p[(k + 1) % 3])});
        }
    }
}

}  // namespace

SolidShape shapeOf(const Scene& scene, const Solid& solid) {
    SolidShape shape;
    const Convex convex = convexOf(solid, scene.simulation.dimensions);
    const Vec3d low = toDouble(scene.domain.min) - convex.middle,
                high = toDouble(scene.domain.max) - convex.middle;
    const bool flat = scene.simulation.dimensions == 2;
    const double depth = 0.5 * double(scene.domain.max.z - scene.domain.min.z);
    if (convex.mesh)
        addMesh(shape, *convex.mesh, convex.scale);
    else if (solid.shape == Shape::Sphere && !flat)
        addSphere(shape, solid.radius);
    else if (solid.shape == Shape::Sphere)
        addCylinder(shape, 2, solid.radius, depth);
    else if (solid.shape == Shape::Cylinder)
        addCylinder(shape, int(solid.axis), solid.radius,
                    flat && solid.axis == Axis::Z ? depth : 0.5 * double(solid.height));
    else {
        std::vector<HalfSpace> planes;
        for (int k = 0; k < convex.planes; ++k)
            planes.push_back({convex.normal[k], convex.offset[k]});
        for (int k = 0; k < 3; ++k) {
            if (solid.shape != Shape::Plane && !(flat && k == 2)) continue;
            Vec3d along{0, 0, 0};
            along[k] = 1;
            planes.push_back({along, high[k]}), planes.push_back({-1.0 * along, -low[k]});
        }
        addFaces(shape, planes, 4 * (length(high - low) + double(reachOf(solid)) + length(low)));
    }
    return shape;
}

}  // namespace spindrift
