#include "measure/validity.h"

#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/particles.h"
#include "scene/sample_solid.h"
#include "scene/sources.h"
#include "scene/thin_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace spindrift {
namespace {

constexpr double FewestSpacings = 2;
constexpr double Touching = 0.05;  // spacings: what is nearer leaves no gap
constexpr double Rounding = 1e-3;  // spacings, of lengths that are floats

std::string nameOf(const Scene& scene, size_t solid) {
    const std::string& name = scene.solids[solid].name;
    return fmt::format("solids[{}]{}", solid, name.empty() ? "" : " (" + name + ")");
}

// "0.03 m are 1.5 spacings"
std::string inSpacings(double length, double dx) {
    return fmt::format("{:.3g} m are {:.2g} spacings", length, length / dx);
}

bool isFew(double length, double dx) { return length < (FewestSpacings - Rounding) * dx; }

void addBodies(const Scene& scene, std::vector<std::string>& out) {
    const double dx = scene.simulation.spacing;
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        const Body& body = scene.fluid.bodies[b];
        if (body.shape == Shape::File) continue;
        const Vec3d half = halfExtent(body);
        int axis = 0;
        for (int k = 1; k < scene.simulation.dimensions; ++k)
            if (half[k] < half[axis]) axis = k;
        if (isFew(2 * half[axis], dx))
            out.push_back(
                fmt::format("fluid.bodies[{}]: {} along {}, fewer than the {:g} that a flow "
                            "needs; lower simulation.spacing or thicken it",
                            b, inSpacings(2 * half[axis], dx), "xyz"[axis], FewestSpacings));
    }
}

// Without a free surface there is no pressure to begin from, and particles that only follow the
// flow line up along it: energy is lost (vortices at Re 100: 38 % of it in half a time unit).
void addLackOfSurface(const Scene& scene, std::vector<std::string>& out) {
    if (!factsOf(scene).solvesPressure || !scene.solids.empty()) return;
    if (shareFilled(scene, countParticles(scene)) > 0.97)
        out.push_back(
            "simulation.formulation: incompressible loses energy where fluid fills the "
            "domain, because its particles are not shifted; use transport_velocity, or "
            "leave room above the fluid");
}

// Other fluid is kept out of what is held before a mouth, but by no pressure.
void addMouths(const Scene& scene, std::vector<std::string>& out) {
    const double dx = scene.simulation.spacing;
    const int dimensions = scene.simulation.dimensions;
    for (size_t i = 0; i < scene.sources.size(); ++i) {
        const SourceLattice lattice = latticeOf(scene, scene.sources[i]);
        const Vec3d behind =
            toDouble(scene.sources[i].center) - (lattice.depth() + dx) * lattice.normal;
        const auto holds = [&](const auto& form) {  // a body or a solid, which may be turned
            if (form.shape == Shape::File) return false;
            return convexOf(form, dimensions).nearestInSpace(behind).distance < 0;
        };
        const auto any = [&](const auto& forms) {
            return std::any_of(forms.begin(), forms.end(), holds);
        };
        if (any(scene.fluid.bodies) && !any(scene.solids))
            out.push_back(fmt::format(
                "{}: fluid lies behind its mouth, and is thrown about where more comes; put "
                "obstacles behind and beside the {:.3g} m before the mouth",
                nameOf(scene, scene.sources[i]), lattice.depth()));
    }
}

// m, of a solid where fluid can be on both sides of it.
std::optional<double> thicknessOf(const Scene& scene, const Solid& solid, double most) {
    if (solid.shape == Shape::Plane) return {};
    const Convex shape = convexOf(solid, scene.simulation.dimensions);
    if (shape.mesh) return shape.scale * shape.mesh->thinnest(most / shape.scale).thickness;
    const Vec3d half = halfExtent(solid);
    const double room = 0.5 * scene.simulation.spacing;  // of a particle's middle from the wall
    std::optional<double> least;
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const bool between = !solid.isAsDrawn() || scene.domain.periodic(k) ||
                             (shape.middle[k] - half[k] > double(scene.domain.min[k]) + room &&
                              shape.middle[k] + half[k] < double(scene.domain.max[k]) - room);
        if (between && (!least || 2 * half[k] < *least)) least = 2 * half[k];
    }
    return least;
}

// Fluid stands half a spacing off each side. (Plates, shells and the like separate it however thin
// they are.)
void addThickness(const Scene& scene, size_t index, std::vector<std::string>& out) {
    const double dx = scene.simulation.spacing, held = supportRadius(scene) - dx;
    if (thinness(scene, scene.solids[index]) > 0) return;
    const auto thickness = thicknessOf(scene, scene.solids[index], held);
    if (!thickness || *thickness >= held - Rounding * dx) return;
    out.push_back(
        fmt::format("{}, thickness: {}, and fluid on its two sides feels each other through "
                    "less than {:.2g}; thicken it to {:.3g} m, or lower simulation.spacing "
                    "to {:.2g} m",
                    nameOf(scene, index), inSpacings(*thickness, dx), held / dx, held,
                    *thickness / (held / dx)));
}

struct Gap {
    double width = 1e30;
    std::string to;
};

// Between two surfaces, as far as the particles of the first one tell: from a particle to the
// other, less how deep it lies below its own.
Gap nearestGap(const Scene& scene, size_t index, const std::vector<Convex>& shapes) {
    const double touching = Touching * double(scene.simulation.spacing);
    const Vec3d low = toDouble(scene.domain.min), high = toDouble(scene.domain.max);
    std::vector<double> toSolid(shapes.size(), 1e30), toWall(6, 1e30);
    for (const Vec3& at : sampleSolid(scene, scene.solids[index]).positions) {
        const Vec3d p = shapes[index].turned(toDouble(at) + low);
        const double depth = -shapes[index].nearestInSpace(p).distance;
        for (size_t s = 0; s < shapes.size(); ++s)
            if (s != index && !shapes[s].mesh)
                toSolid[s] = std::min(toSolid[s], shapes[s].nearestInSpace(p).distance - depth);
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            if (scene.domain.periodic(k)) continue;
            double &begin = toWall[size_t(2 * k)], &end = toWall[size_t(2 * k + 1)];
            begin = std::min(begin, p[k] - low[k] - depth),
            end = std::min(end, high[k] - p[k] - depth);
        }
    }
    Gap found;
    const auto take = [&](double width, const std::string& to) {
        if (width > touching && width < found.width) found = {width, to};
    };
    for (size_t s = 0; s < shapes.size(); ++s) take(toSolid[s], nameOf(scene, s));
    for (size_t side = 0; side < toWall.size(); ++side)
        take(toWall[side], fmt::format("the domain's {} along {}", side % 2 ? "end" : "beginning",
                                       "xyz"[side / 2]));
    return found;
}

void addGap(const Scene& scene, size_t index, const std::vector<Convex>& shapes,
            std::vector<std::string>& out) {
    const double dx = scene.simulation.spacing;
    const Solid& solid = scene.solids[index];
    if (solid.shape == Shape::Plane || solid.shape == Shape::Mesh) return;
    const Gap gap = nearestGap(scene, index, shapes);
    if (!isFew(gap.width, dx)) return;
    out.push_back(
        fmt::format("{}, gap: {} between it and {}, fewer than the {:g} that fluid needs to "
                    "pass; lower simulation.spacing, widen it or close it",
                    nameOf(scene, index), inSpacings(gap.width, dx), gap.to, FewestSpacings));
}

}  // namespace

std::string keyOf(const std::string& remark) { return remark.substr(0, remark.find(": ")); }

std::vector<std::string> remarksOn(const Scene& scene) {
    std::vector<std::string> out;
    if (scene.simulation.support < float(FewestSpacings - Rounding))
        out.push_back(fmt::format(
            "simulation.support: {:.3g} spacings, and sums over so few neighbours miss by many per "
            "cent; raise it to {:g} or more{}",
            scene.simulation.support, FewestSpacings,
            factsOf(scene).isHistorical ? ", in another formulation" : ""));
    addBodies(scene, out);
    addLackOfSurface(scene, out);
    addMouths(scene, out);
    std::vector<Convex> shapes;
    for (const Solid& solid : scene.solids)
        shapes.push_back(convexOf(solid, scene.simulation.dimensions));
    for (size_t s = 0; s < scene.solids.size(); ++s) {
        addThickness(scene, s, out);
        // Elastic objects hold fluid and fill gaps.
        if (scene.objects.empty()) addGap(scene, s, shapes, out);
    }
    return out;
}

Validity::Validity(const Scene& scene) : isClassic_(factsOf(scene).isHistorical) {
    for (const Source& s : scene.sources)
        sources_ += (sources_.empty() ? "" : ", ") + nameOf(scene, s);
    for (std::string& text : remarksOn(scene)) remark(std::move(text), 0);
}

void Validity::look(const Measurement& m) {
    // The densities of the classic formulation are what its masses make of them.
    if (m.densityError > MostCompression && !isClassic_)
        remark(fmt::format("mean compression: {:.2g} % at {:.4g} s, above {:g} %; leave room for "
                           "the fluid that is displaced, or {}",
                           100 * m.densityError, m.time, 100 * MostCompression,
                           m.solvesPressure ? "lower solver.density_error or time.cfl"
                                            : "raise fluid.speed_ratio (fluid.sound_speed)"),
               m.time);
    if (double(m.solve.failures) > 10 + 0.02 * double(m.steps))
        remark(fmt::format("pressures: not found in {} of {} steps, which were shortened; raise "
                           "solver.iterations or lower time.cfl",
                           m.solve.failures, m.steps),
               m.time);
    if (double(m.solve.rough) > 10 + 0.02 * double(m.steps))
        remark(fmt::format("long waves of pressure: not found in {} of {} steps, and pressures of "
                           "deep fluid are not to be trusted; raise solver.iterations or set "
                           "simulation.formulation to delta_sph",
                           m.solve.rough, m.steps),
               m.time);
    if (m.massMissed > 0)
        remark(fmt::format("fluid of {}: from {:.4g} s on less comes than is to, because the "
                           "domain is full, or the run goes on beyond output.time; let fluid out "
                           "by sinks, or set stop or volume",
                           sources_, m.time),
               m.time);
    if (m.maxSpeed > MostMach * m.soundSpeed && !m.solvesPressure)
        remark(fmt::format("Mach number: {:.2g} at {:.4g} s, above {:g}; set fluid.sound_speed to "
                           "{:.2g} m/s or more",
                           m.maxSpeed / m.soundSpeed, m.time, MostMach, 10 * m.maxSpeed),
               m.time);
}

void Validity::dropAfter(double time) {
    std::erase_if(remarks_, [&](const Remark& r) { return r.time > time; });
}

void Validity::remark(std::string text, double time) {
    const auto same = [&](const Remark& r) { return keyOf(r.text) == keyOf(text); };
    if (std::none_of(remarks_.begin(), remarks_.end(), same))
        remarks_.push_back({std::move(text), time});
}

}  // namespace spindrift
