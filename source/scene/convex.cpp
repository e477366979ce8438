#include "scene/convex.h"

#include "core/error.h"

#include <cmath>
#include <numbers>

namespace spindrift {

Vec3d halfExtent(const Form& form) {
    if (form.shape == Shape::Plane) return {};
    if (form.shape == Shape::Mesh) {
        const auto mesh = readMesh(form.path);
        return 0.5 * double(form.scale) * (mesh->high() - mesh->low());
    }
    if (form.shape == Shape::Block || form.shape == Shape::Wedge)
        return 0.5 * (toDouble(form.max) - toDouble(form.min));
    Vec3d half{form.radius, form.radius, form.radius};
    if (form.shape == Shape::Cylinder) half[int(form.axis)] = 0.5 * double(form.height);
    return half;
}

Vec3d middleOf(const Form& form) {
    if (form.shape == Shape::Mesh) {
        const auto mesh = readMesh(form.path);
        return form.offset + 0.5 * double(form.scale) * (mesh->low() + mesh->high());
    }
    const bool cornered = form.shape == Shape::Block || form.shape == Shape::Wedge;
    return cornered ? 0.5 * (toDouble(form.min) + toDouble(form.max)) : toDouble(form.center);
}

bool isBlock(const Form& form) {
    if (form.shape != Shape::Mesh) return form.shape == Shape::Block;
    try {
        return readMesh(form.path)->isBox();
    } catch (const Error&) {
        return false;  // checkMeshes says what is wrong, and whose mesh it is
    }
}

double reachOf(const Form& form) {
    return form.shape == Shape::Sphere ? double(form.radius) : length(halfExtent(form));
}

void Convex::add(Vec3d direction, Vec3d through) {
    normal[planes] = normalized(direction);
    offset[planes] = dot(normal[planes], through);
    ++planes;
}

Convex convexOf(const Form& form, int dimensions) {
    const Vec3d half = halfExtent(form);
    const bool cornered = isBlock(form) || form.shape == Shape::Wedge;
    Convex c;
    if (form.shape == Shape::Plane) {
        c.middle = toDouble(form.center);
        c.add(toDouble(form.normal), {});
        return c;
    }
    if (form.shape == Shape::Mesh && !cornered) {
        c.mesh = readMesh(form.path), c.scale = form.scale;
        c.middle = middleOf(form);
        for (int k = 0; k < 3; ++k) {
            Vec3d up{0, 0, 0};
            up[k] = 1;
            c.add(up, half), c.add(-1.0 * up, -1.0 * half);
        }
        return c;
    }
    c.middle = middleOf(form);
    for (int k = 0; k < dimensions; ++k) {
        const bool flat = isBlock(form) || (form.shape == Shape::Wedge && k == 2) ||
                          (form.shape == Shape::Cylinder && k == int(form.axis));
        Vec3d up{0, 0, 0};
        up[k] = 1;
        if (flat) c.add(up, half), c.add(-1.0 * up, -1.0 * half);
        if (!cornered && !flat) c.across[k] = 1;
    }
    if (!cornered) c.radius = form.radius;
    if (form.shape == Shape::Wedge) {
        const Vec3d ridge{0, half.y, 0};
        c.add({0, -1, 0}, -1.0 * half);
        c.add({2 * half.y, half.x, 0}, ridge);
        c.add({-2 * half.y, half.x, 0}, ridge);
    }
    return c;
}

Convex convexOf(const Solid& solid, int dimensions) {
    Convex c = convexOf(static_cast<const Form&>(solid), dimensions);
    const int k = int(solid.spinAxis), y = (k + 1) % 3, z = (k + 2) % 3;
    const double angle = double(solid.turn) * std::numbers::pi / 180;
    c.axis[y][y] = c.axis[z][z] = std::cos(angle);
    c.axis[y][z] = std::sin(angle), c.axis[z][y] = -c.axis[y][z];
    return c;
}

Vec3d halfSpan(const Solid& solid) {
    const Convex shape = convexOf(solid, 3);
    const Vec3d half = halfExtent(solid);
    const bool isRound = solid.shape == Shape::Sphere ||
                         (solid.shape == Shape::Cylinder && solid.axis == solid.spinAxis);
    if (isRound) return half;  // turned it is where it was
    Vec3d span;
    for (int k = 0; k < 3; ++k)
        for (int own = 0; own < 3; ++own) span[k] += std::abs(shape.axis[own][k]) * half[own];
    return span;
}

Convex::Nearest Convex::nearestInSpace(Vec3d point) const {
    const Nearest own = nearest(into(point - middle));
    return {own.distance, out(own.normal)};
}

Convex::Nearest Convex::nearest(Vec3d p) const {
    Nearest best{-1e300, {0, 0, 0}};
    for (int k = 0; k < planes; ++k)
        if (const double d = dot(normal[k], p) - offset[k]; d > best.distance)
            best = {d, normal[k]};
    if (radius > 0) {
        const Vec3d d{across.x * p.x, across.y * p.y, across.z * p.z};
        const double far = length(d);
        const Vec3d away = far > 0 ? (1 / far) * d : across.x > 0 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
        if (far - radius > best.distance) best = {far - radius, away};
    }
    if (!mesh) return best;
    int triangle = -1;
    return nearestOfMesh(p, triangle);
}

Convex::Nearest Convex::nearestOfMesh(Vec3d p, int& triangle) const {
    const Mesh::Nearest n =
        mesh->nearest((1 / scale) * p + 0.5 * (mesh->low() + mesh->high()), triangle);
    return {scale * n.distance, n.normal};
}

}  // namespace spindrift
