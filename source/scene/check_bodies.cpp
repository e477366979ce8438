#include "scene/check_bodies.h"

#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/motion.h"
#include "scene/sample_object.h"
#include "scene/sample_solid.h"
#include "scene/schema.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

void checkKeyframeList(const Keyframes& keyframes, const std::string& path) {
    for (size_t k = 0; k < keyframes.size(); ++k) {
        const Keyframe& key = keyframes[k];
        const Vec3d sum = key.offset + key.velocity;
        if (!std::isfinite(key.time + key.turn + key.spin + sum.x + sum.y + sum.z))
            refuse(path + ".keyframes",
                   fmt::format("the one at t = {} s has a value that is no number; mend it",
                               key.time));
        if (k > 0 && key.time <= keyframes[k - 1].time)
            refuse(path + ".keyframes",
                   fmt::format("t = {} s does not come after {} s; put them in the order of time",
                               key.time, keyframes[k - 1].time));
        if (key.hasRates != keyframes[0].hasRates)
            refuse(path + ".keyframes",
                   "some say how fast the solid is and some do not; let all of them, or none");
    }
}

void checkKeyframes(const Solid& solid, const std::string& path) {
    checkKeyframeList(solid.keyframes, path);
    if (!solid.keyframes.empty() && (solid.velocity != Vec3{} || solid.spin != 0))
        refuse(path + ".velocity",
               "keyframes say already how it moves; leave velocity and spin out");
    if (largestSpeed(solid) > 1e4)
        refuse(path, fmt::format(
                         "moves at {:.3g} m/s, faster than 1e4; check the times and the distances",
                         largestSpeed(solid)));
}

// It goes on for ever, so that it can neither turn nor be beside itself in the next period.
void checkPlane(const Scene& scene, const Solid& plane, size_t index) {
    const std::string path = fmt::format("solids[{}]", index);
    if (length(plane.normal) < 1e-3f)
        refuse(path + ".normal", "has no direction; name one to the side where fluid is");
    if (plane.turn != 0) refuse(path + ".turn", "a plane is turned by its normal; set that");
    if (plane.moves())
        refuse(path,
               "a plane is without an end and does not move; leave velocity, spin and keyframes "
               "out, or use a block");
    if (scene.simulation.dimensions == 2 && plane.normal.z != 0)
        refuse(path + ".normal", "leads out of the plane, and there are two dimensions; leave z 0");
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        if (scene.domain.periodic(k) && plane.normal[k] != 0)
            refuse(path + ".normal", fmt::format("{} is a periodic axis, along which a plane must "
                                                 "go on; set it to 0, or use a block",
                                                 "xyz"[k]));
    if (!plane.name.empty()) requireColumnName(scene.solids, index, "solids");
}

double longest(Vec3d size) { return std::max({size.x, size.y, size.z}); }

// Files are often in millimetres or inches, and don't say so. A mesh may be so many domains large:
// obstacles reach beyond it.
void requireUnits(const Scene& scene, const Form& form, double mostDomains,
                  const std::string& path) {
    const double extent = 2 * longest(halfExtent(form)), room = longest(scene.domain.size());
    constexpr double Rounding = 1e-5;
    if (extent <= (mostDomains + Rounding) * room) return;
    constexpr std::pair<double, const char*> Units[] = {
        {1e-3, "millimetres"}, {0.01, "centimetres"}, {0.0254, "inches"}};
    const auto fits = [&](const auto& unit) {
        const double then = extent * unit.first;
        return then <= 2 * room && then >= 4 * double(scene.simulation.spacing);
    };
    const auto unit = std::find_if(std::begin(Units), std::end(Units), fits);
    const std::string advice = unit == std::end(Units)
                                   ? "lower it"
                                   : fmt::format("if the file is in {}, set it to {:g}",
                                                 unit->second, double(form.scale) * unit->first);
    refuse(path + ".scale", fmt::format("the mesh is {:.4g} m large, the domain {:.4g} m; {}",
                                        extent, room, advice));
}

// As people would write it: to a hundredth of a spacing.
std::string inShort(const Scene& scene, Vec3d v) {
    const double digits = std::pow(10, std::ceil(2 - std::log10(double(scene.simulation.spacing))));
    for (int k = 0; k < 3; ++k) v[k] = std::round(v[k] * digits) / digits + 0.0;  // no -0
    return fmt::format("{}, {}, {}", v.x, v.y, v.z);
}

// Springs that hold solids apart would throw them about if they began in each other.
void checkFloating(const Scene& scene, size_t index, const std::string& path) {
    const Solid& solid = scene.solids[index];
    if (!solid.keyframes.empty())
        refuse(path + ".density", "keyframes say how it moves; leave one of the two out");
    if (scene.time.mode == TimeMode::Local)
        refuse(path + ".density",
               "what floats needs the same step everywhere; set time.mode to cfl");
    if (factsOf(scene).fillsSpace)
        refuse(path + ".density",
               "transport_velocity fills all room that walls leave; use wcsph, delta_sph or "
               "delta_plus");
    const double dx = scene.simulation.spacing;
    const Vec3d size = scene.domain.size();
    std::vector<Convex> shapes;
    for (const Solid& other : scene.solids)
        shapes.push_back(convexOf(other, scene.simulation.dimensions));
    const Vec3d origin = toDouble(scene.domain.min);
    for (const Vec3& at : sampleSolid(scene, solid).positions) {
        const Vec3d p = shapes[index].turned(toDouble(at) + origin) - origin;
        for (int k = 0; k < scene.simulation.dimensions; ++k)
            if (!scene.domain.periodic(k) && (p[k] < 0 || p[k] > size[k]))
                refuse(path,
                       fmt::format("reaches out of the domain along {}, and floats; move it inside",
                                   "xyz"[k]));
        for (size_t other = 0; other < scene.solids.size(); ++other) {
            const Convex& shape = shapes[other];
            if (other != index && shape.nearestInSpace(p + origin).distance < -0.5 * dx)
                refuse(path,
                       fmt::format("floats, and begins inside solids[{}]; move them apart", other));
        }
    }
}

void checkSolid(const Scene& scene, size_t index) {
    const Solid& solid = scene.solids[index];
    const std::string path = fmt::format("solids[{}]", index);
    if (factsOf(scene).isHistorical)
        refuse(path, "the classic formulation has no solids; use wcsph");
    if (solid.shape == Shape::File)
        refuse(path + ".shape", "a file is for bodies of fluid; name another shape");
    if (solid.shape == Shape::Plane) return checkPlane(scene, solid, index);
    const Vec3d span = halfSpan(solid), middle = convexOf(solid, 3).middle;
    bool outside = false;
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const double extent = 2 * halfExtent(solid)[k];
        const double least = 0.1 * double(scene.simulation.spacing);
        if (extent < least)
            refuse(path, fmt::format("{:.4g} m along {} is less than a tenth of "
                                     "simulation.spacing, {:.4g} m; thicken it",
                                     extent, "xyz"[k], least));
        if (scene.domain.periodic(k) &&
            2 * span[k] > scene.domain.max[k] - scene.domain.min[k] - 2 * supportRadius(scene))
            refuse(path,
                   fmt::format("leaves no room for fluid along {}, a periodic axis; shorten it",
                               "xyz"[k]));
        outside |=
            middle[k] + span[k] < scene.domain.min[k] || middle[k] - span[k] > scene.domain.max[k];
    }
    if (outside && !solid.moves() && solid.shape == Shape::Mesh)
        refuseMeshPlace(scene, solid, path);
    if (outside && !solid.moves())
        refuse(path, "lies outside the domain and does not move; move it inside");
    if (scene.simulation.dimensions == 2 && solid.shape == Shape::Cylinder && solid.axis != Axis::Z)
        refuse(path + ".axis", "in two dimensions a cylinder is a circle about z; use z");
    if (scene.simulation.dimensions == 2 && (solid.spinAxis != Axis::Z || solid.velocity.z != 0))
        refuse(
            path,
            "moves out of the plane, and there are two dimensions; leave z out, and turn about z");
    if (!solid.name.empty()) requireColumnName(scene.solids, index, "solids");
    checkKeyframes(solid, path);
    if (solid.floats()) checkFloating(scene, index, path);
}

template <class Box> void checkBox(const Box& box, const std::string& path) {
    for (int k = 0; k < 3; ++k)
        if (!(box.min[k] <= box.max[k]))
            refuse(path + ".max", fmt::format("{} is below min {} along {}; swap them", box.max[k],
                                              box.min[k], "xyz"[k]));
}

// Where an object reaches to, m.
struct Reach {
    Vec3 low, high;
};

Reach checkShell(const Scene& scene, const Object& o, const std::string& path) {
    if (scene.simulation.dimensions == 2)
        refuse(path + ".shape",
               "a shell has three dimensions; use another shape, or simulation.dimensions 3");
    Form form;
    form.shape = Shape::Mesh, form.path = o.path, form.scale = o.scale, form.offset = o.offset;
    checkMesh(scene, form, 1, path);
    const Vec3d half = halfExtent(form), middle = convexOf(form, 3).middle;
    const Reach reach{toFloat(middle - half), toFloat(middle + half)};
    for (int k = 0; k < 3; ++k)
        if (reach.low[k] < scene.domain.min[k] || reach.high[k] > scene.domain.max[k])
            refuseMeshPlace(scene, form, path);
    return reach;
}

Reach checkTube(const Scene& scene, const Object& o, const std::string& path) {
    const bool flat = scene.simulation.dimensions == 2;
    const float out = o.radius + o.thickness / 2;
    Reach reach;
    for (int k = 0; k < 3; ++k) {
        const float half = !flat && k == int(o.axis) ? o.height / 2 : out;
        reach.low[k] = o.center[k] - half, reach.high[k] = o.center[k] + half;
    }
    if (o.thickness >= 2 * o.radius)
        refuse(path + ".thickness",
               fmt::format("{} m leaves no room in the tube; make it less than twice the radius",
                           o.thickness));
    if (flat && o.axis != Axis::Z)
        refuse(path + ".axis", "in two dimensions a tube is a ring about z; use z");
    return reach;
}

Reach checkBlock(const Scene& scene, const Object& o, const std::string& path) {
    checkBox(o, path);
    const int dimensions = scene.simulation.dimensions;
    int sides = 0;
    for (int k = 0; k < dimensions; ++k) sides += o.max[k] > o.min[k];
    if (sides != dimensions - (o.shape == ObjectShape::Sheet))
        refuse(path, o.shape == ObjectShape::Sheet
                         ? "a sheet is flat along one axis: give min and max the same value "
                           "there, and others elsewhere"
                         : "a block is no wider than a point along an axis; make max larger "
                           "than min, or use a sheet");
    return {o.min, o.max};
}

void checkObject(const Scene& scene, size_t index) {
    const Object& o = scene.objects[index];
    const std::string path = fmt::format("objects[{}]", index);
    const float spacing = spacingOf(scene, o);
    if (spacing < 0.05f * scene.simulation.spacing)
        refuse(path + ".spacing", fmt::format("{:.4g} m is less than a twentieth of "
                                              "simulation.spacing; raise it, or 0 for the same",
                                              spacing));
    const auto [low, high] = o.shape == ObjectShape::Shell  ? checkShell(scene, o, path)
                             : o.shape == ObjectShape::Tube ? checkTube(scene, o, path)
                                                            : checkBlock(scene, o, path);
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        if (low[k] < scene.domain.min[k] || high[k] > scene.domain.max[k])
            refuse(path, fmt::format(
                             "reaches from {} to {} m along {}, out of the domain; move it inside",
                             low[k], high[k], "xyz"[k]));
        if (high[k] > low[k] && high[k] - low[k] < 0.99f * spacing)
            refuse(path, fmt::format("{:.4g} m along {} is less than the {} m between its "
                                     "particles; thicken it or lower spacing",
                                     high[k] - low[k], "xyz"[k], spacing));
    }
    const double reach = double(scene.contact.influence) * 0.5 *
                         (double(scene.simulation.spacing) + spacing),
                 most = 4 * double(supportRadius(scene));
    if (reach > most)
        refuse(path + ".spacing",
               fmt::format("contacts would reach {:.4g} m, more than the four support radii, "
                           "{:.4g} m, in which neighbours are looked for; lower it",
                           reach, most));
}

// As of floating solids: springs would throw apart what begins in each other.
void checkApart(const Scene& scene) {
    if (std::none_of(scene.solids.begin(), scene.solids.end(),
                     [](const Solid& s) { return s.floats(); }))
        return;
    const ObjectSample sample = sampleObjects(scene);
    for (size_t s = 0; s < scene.solids.size(); ++s) {
        if (!scene.solids[s].floats()) continue;
        const Convex shape = convexOf(scene.solids[s], scene.simulation.dimensions);
        for (size_t i = 0; i < sample.size(); ++i)
            if (shape.nearestInSpace(toDouble(sample.positions[i] + scene.domain.min)).distance < 0)
                refuse(fmt::format("objects[{}]", sample.objects[i]),
                       fmt::format("begins inside solids[{}], which floats; move them apart", s));
    }
}

}  // namespace

void checkMesh(const Scene& scene, const Form& form, double mostDomains, const std::string& path) {
    if (scene.simulation.dimensions == 2)
        refuse(path + ".shape",
               "a mesh has three dimensions; use another shape, or simulation.dimensions 3");
    try {
        readMesh(form.path);
    } catch (const Error& error) { refuse(path + ".path", error.what()); }
    requireUnits(scene, form, mostDomains, path);
}

void refuseMeshPlace(const Scene& scene, const Form& form, const std::string& path) {
    const Vec3d middle = convexOf(form, 3).middle, half = halfExtent(form),
                low = toDouble(scene.domain.min), high = toDouble(scene.domain.max);
    const Vec3d offset = form.offset + 0.5 * (low + high) - middle;
    refuse(
        path + ".offset",
        fmt::format("the mesh lies from ({}) to ({}) m, the domain from ({}) to ({}); [{}] would "
                    "put it into the domain's middle",
                    inShort(scene, middle - half), inShort(scene, middle + half),
                    inShort(scene, low), inShort(scene, high), inShort(scene, offset)));
}

void checkMeshes(const Scene& scene) {
    for (size_t i = 0; i < scene.solids.size(); ++i) {
        constexpr double MostDomains = 20;  // ground may go on far beyond the tank
        const Solid& solid = scene.solids[i];
        if (solid.shape != Shape::Mesh) continue;
        const std::string path = fmt::format("solids[{}]", i);
        checkMesh(scene, solid, MostDomains, path);
        if (isBlock(solid)) continue;
        try {
            readMesh(solid.path)->fieldSpacing(scene.simulation.spacing / solid.scale);
        } catch (const Error& error) { refuse(path + ".path", error.what()); }
    }
}

void checkSolids(const Scene& scene) {
    for (size_t i = 0; i < scene.solids.size(); ++i) checkSolid(scene, i);
}

void checkObjects(const Scene& scene) {
    for (size_t i = 0; i < scene.objects.size(); ++i) checkObject(scene, i);
    constexpr double Most = 2e7;
    if (const double count = countObjectParticles(scene); count > Most)
        throw Error(
            Failure::Memory,
            fmt::format("objects: {:.3g} particles are more than {:.0g}; raise their spacing",
                        count, Most));
    for (size_t i = 0; i < scene.grips.size(); ++i) {
        const std::string path = fmt::format("grips[{}]", i);
        checkBox(scene.grips[i], path);
        checkKeyframeList(scene.grips[i].keyframes, path);
        if (!scene.grips[i].keyframes.empty() && scene.grips[i].velocity != Vec3{})
            refuse(path + ".velocity", "keyframes say already how it moves; leave velocity out");
    }
    for (size_t i = 0; i < scene.cuts.size(); ++i)
        checkBox(scene.cuts[i], fmt::format("cuts[{}]", i));
    if (scene.objects.empty()) {
        if (!scene.grips.empty())
            refuse("grips", "there are no objects to hold; add objects or leave grips out");
        if (!scene.cuts.empty())
            refuse("cuts", "there are no objects to cut; add objects or leave cuts out");
        return;
    }
    checkApart(scene);
    if (!factsOf(scene).takesObjects)
        refuse("objects",
               "need fluid that may leave room for them: simulation.formulation wcsph, delta_sph "
               "or delta_plus");
    if (scene.time.mode == TimeMode::Local)
        refuse("objects", "need the same step everywhere; set time.mode to cfl");
    if (scene.time.integrator == Integrator::VelocityVerlet)
        refuse("objects",
               "are not stepped by velocity_verlet; set time.integrator to symplectic_euler");
}

}  // namespace spindrift
