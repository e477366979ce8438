// Solids of a scene as passes see them, where they are at the beginning.
#pragma once

#include "scene/convex.h"
#include "scene/lattice.h"
#include "scene/motion.h"
#include "scene/thin_solid.h"
#include "sim/physics/model.h"

#include <algorithm>
#include <vector>

namespace spindrift::LANES {

inline Vector<real> toReal(Vec3d a) { return {real(a.x), real(a.y), real(a.z)}; }
inline Vec3d toVec3d(Vector<real> a) { return {double(a.x), double(a.y), double(a.z)}; }

// A solid at its place in the scene, before it has moved.
inline SolidState solidAtHome(const Scene& scene, const Solid& solid) {
    const Convex shape = convexOf(solid, scene.simulation.dimensions);
    Vec3d middle = shape.middle - toDouble(scene.domain.min);
    if (scene.simulation.dimensions == 2)
        middle.z = 0.5 * double(scene.domain.max.z - scene.domain.min.z);
    SolidState s{};
    s.grace = real(std::min(thinness(scene, solid) / 8, 0.05 * double(scene.simulation.spacing)));
    s.hides = needsScreen(scene, solid), s.plate = faceOfPlate(scene, solid);
    s.home = s.middle = s.middleBefore = toReal(middle);
    for (int k = 0; k < 3; ++k) s.axis[k] = s.axisBefore[k] = toReal(shape.axis[k]);
    s.spinAxis = int(solid.spinAxis);
    s.planes = shape.planes;
    for (int k = 0; k < shape.planes; ++k)
        s.normal[k] = toReal(shape.normal[k]), s.offset[k] = real(shape.offset[k]);
    s.slip = slipLength(solid.slip);
    s.radius = real(shape.radius), s.across = toReal(shape.across);
    s.reach = solid.shape == Shape::Plane ? real(1e9) : real(reachOf(solid));
    return s;
}

// Whether it moves and turns in planes across this axis only.
inline bool staysAlong(const Solid& solid, int axis) {
    bool turns = solid.spin != 0 || solid.turn != 0, leaves = solid.velocity[axis] != 0;
    for (const Keyframe& key : solid.keyframes)
        turns = turns || key.turn != 0 || key.spin != 0,
        leaves = leaves || key.offset[axis] != 0 || key.velocity[axis] != 0;
    return !solid.floats() && !leaves && (!turns || int(solid.spinAxis) == axis);
}

// A mesh that ends at a side of the domain goes on beyond it as it is a spacing before: what fluid
// reaches there is its flank. The edge between the two is round in the field, and in the corner
// that this left fluid crept into the mesh, whose nearest way out led through its end.
inline void goOnBeyondWalls(const Scene& scene, const Solid& solid, const Convex& shape,
                            DistanceField& field) {
    const double dx = scene.simulation.spacing, near = 0.25 * dx;
    const size_t stride[3] = {1, size_t(field.nodes.x),
                              size_t(field.nodes.x) * size_t(field.nodes.y)};
    const int count[3] = {field.nodes.x, field.nodes.y, field.nodes.z};
    const Vec3d half = halfExtent(solid), low = shape.middle - half - toDouble(scene.domain.min),
                high = shape.middle + half - toDouble(scene.domain.min);
    for (int k = 0; k < 3; ++k) {
        const bool starts = low[k] < near && low[k] > -dx,
                   ends = std::abs(high[k] - scene.domain.size()[k]) < dx &&
                          high[k] > scene.domain.size()[k] - near;
        if (!(starts || ends) || !staysAlong(solid, k)) continue;
        if (scene.domain.periodic(k) && !(starts && ends)) continue;
        const double depth = std::min(dx, 0.5 * half[k]),
                     inside = (half[k] - depth) / (shape.scale * field.spacing),
                     middle = 0.5 * (count[k] - 1);
        const int first = int(std::ceil(middle - inside)), last = int(std::floor(middle + inside));
        for (size_t node = 0; node < field.distances.size(); ++node) {
            const int at = int(node / stride[k]) % count[k],
                      above = starts ? std::max(at, first) : at,
                      to = ends ? std::min(above, last) : above;
            field.distances[node] =
                field.distances[node + size_t(to) * stride[k] - size_t(at) * stride[k]];
        }
    }
}

// Of all meshes, one after the other, the distances from their surfaces.
inline std::vector<real> fieldsOf(const Scene& scene, std::vector<SolidState>& states) {
    std::vector<real> all;
    for (size_t k = 0; k < states.size(); ++k) {
        const Convex shape = convexOf(scene.solids[k], scene.simulation.dimensions);
        if (!shape.mesh) continue;
        DistanceField field =
            shape.mesh->field(shape.mesh->fieldSpacing(scene.simulation.spacing / shape.scale));
        goOnBeyondWalls(scene, scene.solids[k], shape, field);
        for (float distance : field.distances) all.push_back(real(shape.scale * double(distance)));
        states[k].nodes = field.nodes;
        states[k].fieldLow = toReal(shape.scale * field.low),
        states[k].nodesPerMetre = real(1 / (shape.scale * field.spacing));
    }
    return all;
}
inline void pointToFields(std::vector<SolidState>& states, const real* fields) {
    for (SolidState& s : states) {
        if (s.nodes.x == 0) continue;
        s.field = fields;
        fields += size_t(s.nodes.x) * size_t(s.nodes.y) * size_t(s.nodes.z);
    }
}

}  // namespace spindrift::LANES
