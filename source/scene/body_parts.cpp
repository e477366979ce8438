#include "scene/body_parts.h"

#include "scene/convex.h"
#include "scene/formulation.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Layers that a length may be short of a whole number of them, and is taken for one.
constexpr double Whole = 1e-3, Squeeze = 0.02;

double halfSpacing(const Scene& scene) { return 0.5 * double(scene.simulation.spacing); }

// Whether a block stands between two bodies that meet, across all of where they do.
bool isParted(const Scene& scene, const Body& a, const Body& b) {
    const double near = halfSpacing(scene);
    return std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
        if (!isFace(solid) || !meet(scene, solid, a) || !meet(scene, solid, b)) return false;
        int open = 0;  // axes along which they meet beside it
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            const Interval s = extentAlong(scene, solid, k), i = extentAlong(scene, a, k),
                           j = extentAlong(scene, b, k);
            open +=
                s.low > std::max(i.low, j.low) + near || s.high < std::min(i.high, j.high) - near;
        }
        return open == 0;
    });
}

// The bodies whose lattice goes on in this one's: those that it touches, and those that they do.
std::vector<const Body*> groupOf(const Scene& scene, const Body& body) {
    std::vector<const Body*> group = {&body};
    for (size_t i = 0; i < group.size(); ++i)
        for (const Body& b : scene.fluid.bodies) {
            const Body& a = *group[i];
            if (isBox(a) && isBox(b) && meet(scene, a, b) && !isParted(scene, a, b) &&
                std::find(group.begin(), group.end(), &b) == group.end())
                group.push_back(&b);
        }
    return group;
}

// Whether a wall or a solid across all of a body is at its far end.
bool isBounded(const Scene& scene, const Body& body, int axis) {
    const double near = halfSpacing(scene);
    const double end = extentAlong(scene, body, axis).high;
    if (end > scene.domain.size()[axis] - near) return true;
    return std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
        return isFace(solid) && coversAcross(scene, solid, body, axis) &&
               std::abs(extentAlong(scene, solid, axis).low - end) < near;
    });
}

// Layers that the common step doesn't fit: rather some too few, which sink, than too many, which
// burst, and as far apart as they have room.
Layers loosened(Layers layers, double length) {
    const double n = length / layers.step;
    if (isWhole(n)) return layers;
    layers.count = std::max<int64_t>(1, int64_t(std::floor(std::min(n + Squeeze, 2e6))));
    layers.step = length / double(layers.count);
    return layers;
}

// Appends what a solid that spans the body's whole cross-section leaves of it along an axis; the
// body itself where layers of a spacing go on beyond the solid as if it were not there.
void cutBy(const Scene& scene, const Solid& solid, const Body& body, int axis,
           std::vector<Body>& out) {
    const double dx = scene.simulation.spacing;
    if (!isFace(solid) || body.shape != Shape::Block || !coversAcross(scene, solid, body, axis))
        return out.push_back(body);
    const double low = body.min[axis], high = body.max[axis], near = 0.5 * dx;
    const Interval taken = extentAlong(scene, solid, axis);
    const double from = scene.domain.min[axis] + taken.low,
                 to = scene.domain.min[axis] + taken.high;
    const bool below = from - low > near, above = high - to > near,
               apart = from >= high || to <= low;
    const bool whole = (!below || isWhole((from - low) / dx)) &&
                       (!above || (isWhole((high - to) / dx) && isWhole((high - low) / dx)));
    if (apart || whole || !(below || above)) return out.push_back(body);
    if (below) out.push_back(body), out.back().max[axis] = float(from);
    if (above) out.push_back(body), out.back().min[axis] = float(to);
}

}  // namespace

Interval extentAlong(const Scene& scene, const Form& form, int axis) {
    const double origin = scene.domain.min[axis], half = halfExtent(form)[axis];
    if (form.shape == Shape::Block || form.shape == Shape::Wedge)
        return {form.min[axis] - origin, form.max[axis] - origin};
    const double middle = middleOf(form)[axis] - origin;
    return {middle - half, middle + half};
}

bool isFace(const Solid& solid) { return solid.isAsDrawn() && isBlock(solid); }

bool isBox(const Form& form) { return form.shape == Shape::Block || form.shape == Shape::Wedge; }

bool hasFlatEnds(const Form& form, int axis) {
    return isBox(form) || (form.shape == Shape::Cylinder && axis == int(form.axis));
}

bool isWhole(double layers) { return std::abs(layers - std::round(layers)) < Whole; }

double overFull(double layers) { return layers - std::max(1.0, std::floor(layers + Squeeze)); }

bool meet(const Scene& scene, const Form& a, const Form& b, int except) {
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        if (k == except) continue;
        const Interval i = extentAlong(scene, a, k), j = extentAlong(scene, b, k);
        const double gap = std::max(i.low, j.low) - std::min(i.high, j.high);
        if (gap > halfSpacing(scene)) return false;
    }
    return true;
}

bool coversAcross(const Scene& scene, const Form& solid, const Form& body, int axis) {
    const double near = halfSpacing(scene);
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        if (k == axis) continue;
        const Interval s = extentAlong(scene, solid, k), b = extentAlong(scene, body, k);
        if (s.low > b.low + near || s.high < b.high - near) return false;
    }
    return true;
}

bool isFitted(const Scene& scene) {
    return !factsOf(scene).isHistorical && scene.fluid.particleMass <= 0;
}

std::vector<BodyPart> partsOf(const Scene& scene) {
    std::vector<BodyPart> all;
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        std::vector<Body> parts = {scene.fluid.bodies[b]};
        for (int k = 0; k < scene.simulation.dimensions && isFitted(scene); ++k)
            for (const Solid& solid : scene.solids) {
                std::vector<Body> cut;
                for (const Body& part : parts) cutBy(scene, solid, part, k, cut);
                parts = cut;
            }
        for (const Body& part : parts) all.push_back({part, b});
    }
    return all;
}

Layers layersOf(const Scene& scene, const Body& body, int axis, double s) {
    const double dx = scene.simulation.spacing;
    const Interval at = extentAlong(scene, body, axis);
    auto counted = [](double n) { return int64_t(std::clamp(n, 0.0, 2e6)); };
    const Layers own{body.min[axis], counted(std::round(at.length() / s)), s};
    if (!isFitted(scene)) return own;
    const std::vector<const Body*> group = groupOf(scene, body);
    if (group.size() == 1) return isBounded(scene, body, axis) ? loosened(own, at.length()) : own;
    // Whole multiples lie where they are written.
    double origin = 1e300;
    bool whole = true;
    for (const Body* b : group) {
        const Interval i = extentAlong(scene, *b, axis);
        origin = std::min(origin, i.low), whole = whole && isWhole(i.length() / dx);
    }
    if (whole) return own;
    const double first = std::round((at.low - origin) / s),
                 last = std::round((at.high - origin) / s);
    return {double(scene.domain.min[axis]) + origin + first * s, counted(last - first), s};
}

}  // namespace spindrift
