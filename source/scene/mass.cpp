#include "scene/mass.h"

#include "scene/convex.h"

#include <cmath>
#include <numbers>

namespace spindrift {

static Mass massOfMesh(const Solid& solid) {
    const Convex shape = convexOf(solid, 3);
    const Mesh::Weight w = shape.mesh->weigh();
    const double s = shape.scale, volume = s * s * s, rho = solid.density;
    Mass m{rho * volume * w.volume,
           s * (w.centroid - 0.5 * (shape.mesh->low() + shape.mesh->high())),
           {}};
    for (int k = 0; k < 3; ++k)
        m.inertia[k] =
            (rho * volume * s * s) * Vec3d{w.inertia[k][0], w.inertia[k][1], w.inertia[k][2]};
    return m;
}

Mass massOf(const Scene& scene, const Solid& solid) {
    if (solid.shape == Shape::Mesh && !isBlock(solid)) return massOfMesh(solid);
    const bool flat = scene.simulation.dimensions == 2;
    Vec3d half = halfExtent(solid);
    if (flat) half.z = 0.5;  // of a metre of depth
    const double pi = std::numbers::pi, r = solid.radius;
    // Volume, and the mean squares of the distances from the centre along each axis.
    double volume = 8 * half.x * half.y * half.z;
    Vec3d squares{half.x * half.x / 3, half.y * half.y / 3, half.z * half.z / 3}, centre{0, 0, 0};
    if (solid.shape == Shape::Wedge) {
        volume /= 2;
        centre.y = -half.y / 3;
        squares.x = half.x * half.x / 6, squares.y = 2 * half.y * half.y / 9;
    } else if (solid.shape == Shape::Sphere && !flat) {
        volume = 4 * pi / 3 * r * r * r;
        squares = {r * r / 5, r * r / 5, r * r / 5};
    } else if (!isBlock(solid)) {
        const int axis = flat ? 2 : int(solid.axis);
        volume = 2 * half[axis] * pi * r * r;
        for (int k = 0; k < 3; ++k)
            if (k != axis) squares[k] = r * r / 4;
    }
    const double mass = solid.density * volume;
    return {mass,
            centre,
            {{mass * (squares.y + squares.z), 0, 0},
             {0, mass * (squares.z + squares.x), 0},
             {0, 0, mass * (squares.x + squares.y)}}};
}

void invertTransposed(const Vec3d (&m)[3], Vec3d (&inverse)[3]) {
    const Vec3d x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
    const double perDeterminant = 1 / dot(m[0], x);
    inverse[0] = perDeterminant * x, inverse[1] = perDeterminant * y,
    inverse[2] = perDeterminant * z;
}

// The sum of the outward normals of all faces that p is near to: at edges there are several.
static Vec3d normalsNear(const Convex& shape, Vec3d p, double near) {
    if (shape.mesh) {
        const auto nearest = shape.nearest(p);
        return -nearest.distance <= near ? nearest.normal : Vec3d{};
    }
    Vec3d sum{0, 0, 0};
    for (int k = 0; k < shape.planes; ++k)
        if (shape.offset[k] - dot(shape.normal[k], p) <= near) sum = sum + shape.normal[k];
    const Vec3d d{shape.across.x * p.x, shape.across.y * p.y, shape.across.z * p.z};
    if (shape.radius > 0 && length(d) > 0 && shape.radius - length(d) <= near)
        sum = sum + (1 / length(d)) * d;
    return sum;
}

// The same of a particle that belongs to one face of a thin solid, whichever else is near.
static Vec3d normalsNear(const Convex& shape, Vec3d p, double near, Vec3d face) {
    if (length(face) > near) return {};
    const Vec3d own = -1.0 * normalized(face);
    Vec3d sum = own;
    for (int k = 0; k < shape.planes && !shape.mesh; ++k)
        if (shape.offset[k] - dot(shape.normal[k], p) <= near &&
            std::abs(dot(shape.normal[k], own)) < 0.9)
            sum = sum + shape.normal[k];
    return sum;
}

// With a = w (n - mean of n) the areas close. With G = sum x (x) a they make the force -G^T g of a
// pressure g.x: multiplied by V G^-T it is -V g.
std::vector<Vec3d> surfaceAreas(const Scene& scene, const Solid& solid, const SolidSample& sample) {
    const Convex shape = convexOf(solid, scene.simulation.dimensions);
    const double outermost = 0.75 * double(scene.simulation.spacing);
    std::vector<Vec3d> areas(sample.positions.size());
    std::vector<double> weights(areas.size());
    Vec3d slant{0, 0, 0};
    double all = 1e-30;
    auto armOf = [&](size_t i) {
        return toDouble(sample.positions[i] + scene.domain.min) - shape.middle;
    };
    for (size_t i = 0; i < areas.size(); ++i) {
        if (!sample.beyond.empty() && sample.beyond[i]) continue;
        const Vec3d normal = sample.faces.empty() ? normalsNear(shape, armOf(i), outermost)
                                                  : normalsNear(shape, armOf(i), outermost,
                                                                toDouble(sample.faces[i]));
        if (normal == Vec3d{}) continue;
        weights[i] = sample.volumes[i];
        areas[i] = weights[i] * normal;
        slant = slant + areas[i], all += weights[i];
    }
    Vec3d moments[3] = {};
    for (size_t i = 0; i < areas.size(); ++i) {
        areas[i] = areas[i] - (weights[i] / all) * slant;
        for (int k = 0; k < 3; ++k) moments[k] = moments[k] + armOf(i)[k] * areas[i];
    }
    if (scene.simulation.dimensions == 2) moments[2] = {0, 0, moments[0].x + moments[1].y};
    const double size = (moments[0].x + moments[1].y + moments[2].z) / 3;
    const double determinant = dot(moments[0], cross(moments[1], moments[2]));
    if (!(determinant > 1e-3 * size * size * size)) return std::vector<Vec3d>(areas.size());
    Vec3d toVolume[3];
    invertTransposed(moments, toVolume);
    const double volume = massOf(scene, solid).mass / double(solid.density);
    for (Vec3d& a : areas)
        a = volume * Vec3d{dot(toVolume[0], a), dot(toVolume[1], a), dot(toVolume[2], a)};
    return areas;
}

}  // namespace spindrift
