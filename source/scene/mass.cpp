#include "scene/mass.h"

#include "scene/convex.h"

#include <numbers>

namespace spindrift {

Mass massOf(const Scene& scene, const Solid& solid) {
    const bool flat = scene.simulation.dimensions == 2;
    Vec3d half = halfExtent(solid);
    if (flat) half.z = 0.5 * double(scene.simulation.spacing);
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
    return {mass, centre, mass * Vec3d{squares.y + squares.z, squares.z + squares.x, squares.x + squares.y}};
}

}  // namespace spindrift
