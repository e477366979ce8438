#include "scene/mass.h"

#include "scene/convex.h"

#include <numbers>

namespace spindrift {

static Mass massOfMesh(const Solid& solid) {
    const Convex shape = convexOf(solid, 3);
    const Mesh::Weight w = shape.mesh->weigh();
    const double s = shape.scale, volume = s * s * s, rho = solid.density;
    Mass m{rho * volume * w.volume, s * (w.centroid - 0.5 * (shape.mesh->low() + shape.mesh->high())), {}};
    for (int k = 0; k < 3; ++k) m.inertia[k] = (rho * volume * s * s) * Vec3d{w.inertia[k][0], w.inertia[k][1], w.inertia[k][2]};
    return m;
}

Mass massOf(const Scene& scene, const Solid& solid) {
    if (solid.shape == Shape::Mesh) return massOfMesh(solid);
    const bool flat = scene.simulation.dimensions == 2;
    Vec3d half = halfExtent(solid);
    if (flat) half.z = 0.5;   // of a metre of depth
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
    } else if (solid.shape != Shape::Block) {
        const int axis = flat ? 2 : int(solid.axis);
        volume = 2 * half[axis] * pi * r * r;
        for (int k = 0; k < 3; ++k)
            if (k != axis) squares[k] = r * r / 4;
    }
    const double mass = solid.density * volume;
    return {mass, centre, {{mass * (squares.y + squares.z), 0, 0}, {0, mass * (squares.z + squares.x), 0}, {0, 0, mass * (squares.x + squares.y)}}};
}

}  // namespace spindrift
