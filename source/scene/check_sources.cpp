#include "scene/check_sources.h"

#include "scene/check_bodies.h"
#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/schema.h"
#include "scene/sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace spindrift {
namespace {

// What can't have particles that come and go, or has not been tried with them.
void checkRest(const Scene& scene) {
    const std::string list = scene.sources.empty() ? "sinks" : "sources";
    if (factsOf(scene).isHistorical || factsOf(scene).fillsSpace)
        refuse(list, fmt::format("are not of {}, whose fluid stays what it is; use "
                                 "simulation.formulation delta_sph, delta_plus, wcsph or "
                                 "incompressible",
                                 enumNames(Formulation())[size_t(scene.simulation.formulation)]));
    if (scene.time.mode == TimeMode::Local)
        refuse(list, "need the same step everywhere; set time.mode to cfl");
    if (isMultiFluid(scene))
        refuse(list, "are for one fluid; leave rest_density and viscosity of the bodies out");
    if (scene.output.energyBalance)
        refuse("output.energy_balance", "is of fluid that stays; leave " + list + " or it out");
    if (!scene.objects.empty())
        refuse(list, "don't go with elastic objects; leave one of them out");
}

// Before any lattice is made of it.
void checkSize(const Scene& scene, const Source& source, const std::string& path) {
    constexpr double MostPoints = 1e6;
    const bool flat = scene.simulation.dimensions == 2, round = source.mouth == Mouth::Disc;
    const double dx = scene.simulation.spacing, width = round ? 2.0 * source.radius : source.width,
                 height = flat    ? dx
                          : round ? width
                                  : source.height;
    Vec3d size = scene.domain.size();
    if (flat) size.z = 0;
    if (std::max(width, height) > length(size))
        refuse(path, fmt::format("its mouth of {:.4g} m is longer than the domain's diagonal, "
                                 "{:.4g} m; make it smaller",
                                 std::max(width, height), length(size)));
    const double points = width / dx * (height / dx);
    if (points > MostPoints)
        refuse(path, fmt::format("its mouth has about {:.3g} points, and {:.0g} are the most; make "
                                 "it smaller or raise simulation.spacing",
                                 points, MostPoints));
}

void checkRates(const Rates& rates, const std::string& path) {
    for (size_t i = 0; i < rates.size(); ++i)
        if (!std::isfinite(rates[i].time) || (i > 0 && rates[i].time <= rates[i - 1].time))
            refuse(path, fmt::format("row {}: t = {} s is not after the row before; put times in "
                                     "order",
                                     i + 1, rates[i].time));
}

void checkNumbers(const Scene& scene, const Source& source, const std::string& path) {
    const int given = (source.velocity > 0) + (source.flow > 0) + !source.velocities.empty() +
                      !source.flows.empty();
    if (given == 0) refuse(path, "gives nothing; set velocity, flow, velocities, flows or path");
    if (given > 1)
        refuse(path,
               "says more than once how much it gives; keep one of velocity, flow, "
               "velocities, flows and path");
    checkRates(source.velocities, path + ".velocities");
    checkRates(source.flows, path + ".flows");
    if (length(source.normal) == 0) refuse(path + ".normal", "has no direction; name one");
    if (scene.simulation.dimensions == 2 && source.normal.z != 0)
        refuse(path + ".normal", "there is no z in two dimensions; set that to 0");
    if (scene.simulation.dimensions == 2 && source.mouth == Mouth::Disc)
        refuse(path + ".mouth", "a disc has three dimensions; use rectangle");
    if (source.stop > 0 && source.stop <= source.start)
        refuse(path + ".stop", fmt::format("{} s is not after start, {} s; make it later",
                                           source.stop, source.start));
    const float extent = source.mouth == Mouth::Disc        ? 2 * source.radius
                         : scene.simulation.dimensions == 2 ? source.width
                                                            : std::min(source.width, source.height);
    if (extent < scene.simulation.spacing)
        refuse(path, fmt::format("its mouth of {} m is narrower than simulation.spacing, {} m; "
                                 "widen it or lower the spacing",
                                 extent, scene.simulation.spacing));
    checkSize(scene, source, path);
    const SourceLattice lattice = latticeOf(scene, source);
    const double fastest = largestSpeed(scene, source);
    if (scene.time.mode == TimeMode::Fixed && fastest * scene.time.step > lattice.apart)
        refuse("time.step", fmt::format("fluid of {} goes on by more than a spacing in {} s; lower "
                                        "it below {:.2g} s, or set time.mode to cfl",
                                        path, scene.time.step, lattice.apart / fastest));
}

// Where all that a source holds is, m.
std::vector<Vec3d> heldOf(const Scene& scene, const Source& source) {
    const SourceLattice lattice = latticeOf(scene, source);
    std::vector<Vec3d> out;
    for (const SourceLattice::Point& p : lattice.points)
        for (int layer = 0; layer < lattice.layers; ++layer)
            out.push_back(p.at - (layer + 0.5) * lattice.apart * lattice.normal);
    return out;
}

// No two sources hold particles in the same place. Cells are half a spacing long.
void checkOverlap(const Scene& scene) {
    if (scene.sources.size() < 2) return;
    const double near = 0.5 * double(scene.simulation.spacing);
    const Vec3d low = toDouble(scene.domain.min);
    struct Held {
        Vec3d at;
        size_t source;
    };
    using Cell = std::array<int64_t, 3>;
    const auto cellOf = [&](Vec3d p) {
        Cell cell;
        for (int k = 0; k < 3; ++k) cell[size_t(k)] = int64_t(std::floor((p[k] - low[k]) / near));
        return cell;
    };
    const auto keyOf = [](const Cell& c) { return (c[0] * 0x200000 + c[1]) * 0x200000 + c[2]; };
    std::unordered_multimap<int64_t, Held> held;
    for (size_t i = 0; i < scene.sources.size(); ++i) {
        const std::vector<Vec3d> places = heldOf(scene, scene.sources[i]);
        for (const Vec3d& at : places)
            for (int n = 0; n < 27; ++n) {
                Cell cell = cellOf(at);
                cell[0] += n % 3 - 1, cell[1] += n / 3 % 3 - 1, cell[2] += n / 9 - 1;
                const auto [begin, end] = held.equal_range(keyOf(cell));
                for (auto other = begin; other != end; ++other)
                    if (length(other->second.at - at) < near)
                        refuse(fmt::format("sources[{}].center", i),
                               fmt::format("what is about to come is where that of sources[{}] is, "
                                           "at ({:.4g}, {:.4g}, {:.4g}) m; move them apart",
                                           other->second.source, at.x, at.y, at.z));
            }
        for (const Vec3d& at : places) held.insert({keyOf(cellOf(at)), {at, i}});
    }
}

// All that is held lies behind the mouth: in the domain, and not in a solid.
void checkPlace(const Scene& scene, const Source& source, const std::string& path) {
    const SourceLattice lattice = latticeOf(scene, source);
    const double dx = scene.simulation.spacing;
    std::vector<Convex> solids;
    for (const Solid& solid : scene.solids)
        solids.push_back(convexOf(solid, scene.simulation.dimensions));
    for (const SourceLattice::Point& p : lattice.points)
        for (int layer = 0; layer < lattice.layers; ++layer) {
            const Vec3d at = p.at - (layer + 0.5) * lattice.apart * lattice.normal;
            for (int k = 0; k < scene.simulation.dimensions; ++k) {
                const double low = scene.domain.min[k], high = scene.domain.max[k];
                if (at[k] < low + 0.4 * dx || at[k] > high - 0.4 * dx)
                    refuse(path + ".center",
                           fmt::format("what is about to come takes {:.4g} m behind the mouth, and "
                                       "that reaches {} = {:.4g} m, beyond the domain's {} to {} m "
                                       "less half a spacing; move it inside",
                                       lattice.depth(), "xyz"[k], at[k], low, high));
            }
            for (size_t s = 0; s < solids.size(); ++s)
                if (solids[s].nearestInSpace(at).distance < 0.25 * dx)
                    refuse(path + ".center",
                           fmt::format("what is about to come takes {:.4g} m behind the mouth, and "
                                       "solids[{}] is there, at ({:.4g}, {:.4g}, {:.4g}) m; leave "
                                       "half a spacing between them",
                                       lattice.depth(), s, at.x, at.y, at.z));
        }
}

}  // namespace

void checkSources(const Scene& scene) {
    if (!comesAndGoes(scene)) return;
    checkRest(scene);
    for (size_t i = 0; i < scene.sources.size(); ++i) {
        const std::string path = fmt::format("sources[{}]", i);
        checkNumbers(scene, scene.sources[i], path);
        checkPlace(scene, scene.sources[i], path);
    }
    checkOverlap(scene);
    for (size_t i = 0; i < scene.sinks.size(); ++i)
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            const Sink& s = scene.sinks[i];
            if (!(s.max[k] > s.min[k]))
                refuse(fmt::format("sinks[{}].max", i),
                       fmt::format("{} = {} m is not above min {} = {} m; make it larger", "xyz"[k],
                                   s.max[k], "xyz"[k], s.min[k]));
            if (s.max[k] < scene.domain.min[k] || s.min[k] > scene.domain.max[k])
                refuse(fmt::format("sinks[{}]", i),
                       fmt::format("lies outside of the domain along {}; move it", "xyz"[k]));
        }
}

}  // namespace spindrift
