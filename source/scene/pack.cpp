#include "scene/pack.h"

#include "scene/body_parts.h"
#include "scene/formulation.h"
#include "scene/lattice.h"
#include "scene/particles.h"
#include "scene/sample_solid.h"
#include "scene/sources.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spindrift {

bool relaxed(const Scene& scene) { return scene.simulation.placement == StartPlaces::Relaxed; }

double distanceFrom(const Scene& scene, const Convex& shape, Vec3d p) {
    return shape.nearestInSpace(p + toDouble(scene.domain.min)).distance;
}

std::vector<Convex> solidsOf(const Scene& scene) {
    std::vector<Convex> solids;
    for (const Solid& solid : scene.solids)
        solids.push_back(convexOf(solid, scene.simulation.dimensions));
    return solids;
}

namespace {

// A block that lies between planes of the lattice of each body that it is near to.
bool meetsLayers(const Scene& scene, const Solid& solid, const std::vector<Lattice>& lattices) {
    if (!isBlock(solid) || solid.turn != 0) return false;
    for (size_t b = 0; b < lattices.size(); ++b)
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            if (!meet(scene, solid, scene.fluid.bodies[b])) continue;
            const Interval at = extentAlong(scene, solid, k);
            const double first = lattices[b].first[k] / lattices[b].step[k] - 0.5;
            for (const double end : {at.low, at.high})
                if (end > 0 && end < scene.domain.size()[k] &&
                    !isWhole(end / lattices[b].step[k] - first))
                    return false;
        }
    return true;
}

// The body's shape with its flat sides where its lattice ends, or at a side of the domain that is
// nearer than half a spacing from there, and far beyond that where the domain is periodic: the
// fluid goes on there.
Form fitted(const Scene& scene, const Body& body, const Lattice& l) {
    const Vec3d size = scene.domain.size(), origin = toDouble(scene.domain.min);
    const double dx = scene.simulation.spacing;
    Form form = body;
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const bool ends = !isBox(body);
        if (!hasFlatEnds(body, k)) continue;
        double low = l.first[k] - 0.5 * dx, high = low + double(l.n[k]) * dx;
        // Sides that are no whole number of spacings: the packing needs no layers.
        const double side = 2 * halfExtent(body)[k];
        if (std::abs(side - (high - low)) > 1e-3 * dx) {
            low = convexOf(body, 3).middle[k] - 0.5 * side - origin[k], high = low + side;
        }
        if (low < 0.5 * dx) low = 0;
        if (high > size[k] - 0.5 * dx) high = size[k];
        if (scene.domain.periodic(k) && low == 0 && high == size[k])
            low -= 100 * size[k], high += 100 * size[k];
        if (ends)
            form.center[k] = float(origin[k] + 0.5 * (low + high)), form.height = float(high - low);
        else
            form.min[k] = float(origin[k] + low), form.max[k] = float(origin[k] + high);
    }
    return form;
}

// Packed against the same boundary particles that fluid will feel: against a wall that is a
// continuum it comes 0.1 spacings nearer, and is pushed off when the run begins.
void addBoundary(const Scene& scene, Region& region) {
    const int d = scene.simulation.dimensions;
    const double dx = scene.simulation.spacing;
    const bool walls = scene.walls.kind == WallKind::Particles;
    for (const Solid& solid : scene.solids) {
        const SolidSample sample = sampleSolid(scene, solid);
        const Convex shape = convexOf(solid, d);
        const Vec3d origin = toDouble(scene.domain.min);
        for (size_t i = 0; i < sample.positions.size(); ++i) {
            region.boundary.push_back(shape.turned(toDouble(sample.positions[i]) + origin) -
                                      origin);
            region.boundaryVolumes.push_back(double(sample.volumes[i]) * std::pow(dx, d));
        }
    }
    if (walls) {
        std::vector<Vec3> points;
        placeShell(wallShell(scene), points);
        const Vec3d step = wallStep(scene);
        for (const Vec3& p : points) region.boundary.push_back(toDouble(p));
        region.boundaryVolumes.resize(region.boundary.size(),
                                      step.x * step.y * (d == 2 ? 1 : step.z));
    }
    region.air = [&scene, walls, d, inside = region.inside, solids = solidsOf(scene)](
                     Vec3d p, double width) {
        auto within = [&](double distance) { return std::clamp(0.5 - distance / width, 0.0, 1.0); };
        double share = 1;
        for (int k = 0; k < d && walls; ++k)
            if (!scene.domain.periodic(k))
                share = std::min(share, within(std::max(-p[k], p[k] - scene.domain.size()[k])));
        for (const Convex& s : solids)
            share = std::min(share, 1 - within(distanceFrom(scene, s, p)));
        return std::max(0.0, share - inside(p, width));
    };
}

// p, or where it is a quarter of a spacing from solids.
Vec3d outOf(const Scene& scene, const std::vector<Convex>& solids, Vec3d p) {
    const double least = 0.25 * double(scene.simulation.spacing);
    for (const Convex& s : solids) {
        const Convex::Nearest n = s.nearestInSpace(p + toDouble(scene.domain.min));
        if (n.distance < least) p = p + (least - n.distance) * n.normal;
    }
    return p;
}

// Particles that have to leave so that none is squeezed by more than a hundredth, nor all by more
// than their share: squeezed fluid bursts. In increasing order.
std::vector<size_t> mostCrowded(const std::vector<Vec3d>& at, const std::vector<double>& densities,
                                double dx) {
    constexpr double Most = 1.01, Mean = 1.002;
    double excess = 0;
    for (const double density : densities) excess += std::max(density - Mean, 0.0);
    std::vector<size_t> order(at.size()), out;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return std::round(1e5 * densities[a]) > std::round(1e5 * densities[b]);
    });
    for (const size_t i : order) {
        const bool many = double(out.size()) + 0.5 > excess;
        if (many && densities[i] < (out.empty() ? Most : 2 * Most - 1)) break;
        if (std::none_of(out.begin(), out.end(),
                         [&](size_t o) { return length(at[o] - at[i]) < 3 * dx; }))
            out.push_back(i);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

Slants::Slants(const Scene& scene, const std::vector<Lattice>& lattices) : scene_(scene) {
    if (!isFitted(scene) || relaxed(scene)) return;
    for (const Solid& solid : scene.solids)
        if (!isFace(solid) && !meetsLayers(scene, solid, lattices))
            solids_.push_back(convexOf(solid, scene.simulation.dimensions));
}

// Where nothing is packed, nor seen by what is, the distance from a mesh's box will do.
double Slants::distance(Vec3d p) const {
    const double enough = 3 * reach();
    double nearest = 1e30;
    for (const Convex& s : solids_) {
        const Vec3d x = s.into(p + toDouble(scene_.domain.min) - s.middle);
        double beyond = -1e300;
        for (int k = 0; k < s.planes; ++k)
            beyond = std::max(beyond, dot(s.normal[k], x) - s.offset[k]);
        nearest = std::min(nearest, beyond > enough ? beyond : s.nearest(x).distance);
    }
    return nearest;
}

CellLeft Slants::leftOf(const Lattice& l, Vec3d p, double distance) const {
    const double reach = 0.5 * length(l.step);
    if (std::abs(distance) >= reach) return {p, distance > 0 ? 1.0 : 0.0};
    constexpr int N = 4;  // parts a side
    const int deep = l.step.z > 0 ? N : 1;
    CellLeft left{{0, 0, 0}, 0};
    for (int i = 0; i < N * N * deep; ++i) {
        const Vec3d part{(i % N + 0.5) / N - 0.5, (i / N % N + 0.5) / N - 0.5,
                         deep > 1 ? (i / (N * N) + 0.5) / N - 0.5 : 0};
        const Vec3d at = p + Vec3d{part.x * l.step.x, part.y * l.step.y, part.z * l.step.z};
        const double share = std::clamp(0.5 + this->distance(at) * N / l.step.x, 0.0, 1.0);
        left.share += share, left.middle = left.middle + share * at;
    }
    if (left.share > 0) left.middle = (1 / left.share) * left.middle;
    left.share /= N * N * deep;
    return left;
}

bool areWhole(const std::vector<Candidate>& some) {
    return std::all_of(some.begin(), some.end(),
                       [](const Candidate& c) { return std::min(c.share, 1 - c.share) < 1e-3; });
}

void choose(const std::vector<Candidate>& some, const Slants& slants, std::vector<Place>& out) {
    double room = 0;
    for (const Candidate& c : some) room += c.share;
    // Files of the same mesh differ by rounding.
    const double per = 1e4 / slants.reach();
    auto steps = [&](const Candidate& c) { return std::round(c.distance * per); };
    std::vector<size_t> order(some.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return steps(some[a]) > steps(some[b]); });
    order.resize(std::min(order.size(), size_t(std::llround(room))));
    std::sort(order.begin(), order.end());
    for (const size_t i : order) out.push_back(some[i].place);
}

std::vector<Form> fittedBodies(const Scene& scene, const std::vector<Lattice>& lattices) {
    std::vector<Form> forms;
    for (size_t b = 0; b < lattices.size(); ++b)
        forms.push_back(fitted(scene, scene.fluid.bodies[b], lattices[b]));
    return forms;
}

Region regionOf(const Scene& scene, const std::vector<Form>& forms) {
    const Vec3d size = scene.domain.size(), origin = toDouble(scene.domain.min);
    const int d = scene.simulation.dimensions;
    std::vector<Convex> bodies;
    Region region;
    region.dimensions = d;
    region.low = size, region.high = {0, 0, 0};
    for (const Form& form : forms) {
        bodies.push_back(convexOf(form, d));
        const Vec3d middle = bodies.back().middle - origin, half = halfExtent(form);
        for (int k = 0; k < 3; ++k) {
            region.low[k] = std::max(std::min(region.low[k], middle[k] - half[k]), 0.0);
            region.high[k] = std::min(std::max(region.high[k], middle[k] + half[k]), size[k]);
        }
    }
    if (d == 2) region.low.z = 0, region.high.z = size.z;
    // What ends well before a periodic side has air beyond it, all the same.
    for (int k = 0; k < d; ++k) {
        const double far = 4 * double(scene.simulation.spacing);
        region.periodic[k] =
            scene.domain.periodic(k) && (region.low[k] < far || region.high[k] > size[k] - far);
        if (region.periodic[k]) region.low[k] = 0, region.high[k] = size[k];
    }
    region.inside = [&scene, bodies, solids = solidsOf(scene)](Vec3d p, double width) {
        auto within = [&](const Convex& shape) {
            return std::clamp(0.5 - distanceFrom(scene, shape, p) / width, 0.0, 1.0);
        };
        double share = 0;
        for (const Convex& body : bodies) share += within(body);
        share = std::min(share, 1.0);
        for (const Convex& solid : solids) share = std::min(share, 1 - within(solid));
        return share;
    };
    return region;
}

void packBeside(const Scene& scene, const std::vector<Lattice>& lattices, const Slants& slants,
                size_t first, std::vector<Place>& places) {
    Region region = regionOf(scene, fittedBodies(scene, lattices));
    addBoundary(scene, region);
    const int d = scene.simulation.dimensions;
    const double volume = particleVolume(scene), dx = std::pow(volume, 1.0 / d);
    const double seen = slants.reach() + 4 * dx;
    region.boundaryVolumes.resize(region.boundary.size());
    std::vector<Vec3d> at;
    for (size_t i = 0; i < places.size(); ++i)
        if (i >= first)
            at.push_back(places[i].at);
        else if (slants.distance(places[i].at) < seen)
            region.boundary.push_back(places[i].at), region.boundaryVolumes.push_back(volume);
    region.isNear = [&](Vec3d p) { return slants.distance(p) < seen; };
    region.out = [&](Vec3d p) { return outOf(scene, slants.solids(), p); };
    Packing packing(region, dx, scene.compute.threads);
    packing.relax(at, 80);
    for (int round = 0; round < 3; ++round) {
        const std::vector<size_t> crowded = mostCrowded(at, packing.densities(at), dx);
        if (crowded.empty()) break;
        for (auto i = crowded.rbegin(); i != crowded.rend(); ++i)
            at.erase(at.begin() + long(*i)), places.erase(places.begin() + long(first + *i));
        packing.relax(at, 30);
    }
    for (size_t i = first; i < places.size(); ++i) places[i].at = at[i - first];
}

void relaxFrom(const Scene& scene, size_t first, std::vector<Vec3>& places) {
    const int d = scene.simulation.dimensions;
    const double volume = particleVolume(scene), dx = std::pow(volume, 1.0 / d);
    Region region;
    region.dimensions = d, region.low = {0, 0, 0}, region.high = scene.domain.size();
    for (int k = 0; k < d; ++k) region.periodic[k] = scene.domain.periodic(k);
    Region walls = region;
    walls.inside = [](Vec3d, double) { return 1.0; };
    if (!factsOf(scene).isHistorical) addBoundary(scene, walls);
    std::vector<Vec3d> at;
    for (const Vec3& place : places) at.push_back(toDouble(place));
    // Of what walls and solids leave.
    const auto fluid = densityAround(at, std::vector<double>(at.size(), volume), region, dx),
               solid = densityAround(walls.boundary, walls.boundaryVolumes, region, dx);
    region.inside = [fluid, solid, steepness = steepnessAtEnds(dx)](Vec3d p, double width) {
        const double density = fluid(p) / std::max(1 - solid(p), 0.3);
        return std::clamp(0.5 + (density - 0.5) / (steepness * width), 0.0, 1.0);
    };
    if (!factsOf(scene).isHistorical) addBoundary(scene, region);
    region.boundary.insert(region.boundary.end(), at.begin(), at.begin() + long(first));
    region.boundaryVolumes.resize(region.boundary.size(), volume);
    region.out = [&scene, solids = solidsOf(scene)](Vec3d p) { return outOf(scene, solids, p); };
    at.erase(at.begin(), at.begin() + long(first));
    const std::vector<Vec3d> start = at;
    relax(at, region, dx, scene.compute.threads);
    // What was pushed out of a rugged surface goes back.
    for (size_t i = 0; i < at.size(); ++i)
        places[first + i] = toFloat(region.inside(at[i], dx) > 0 ? at[i] : start[i]);
}

void relaxPlaces(const Scene& scene, const std::vector<Lattice>& lattices, bool isCut,
                 std::vector<Place>& places) {
    Region region = regionOf(scene, fittedBodies(scene, lattices));
    if (!scene.sources.empty())
        region.inside = [mouths = MouthRoom(scene), whole = region.inside](Vec3d p, double width) {
            return mouths.takes(p) ? 0 : whole(p, width);
        };
    if (!factsOf(scene).isHistorical) addBoundary(scene, region);
    // Sharp edges have no boundary particles in their tips that would keep others out.
    region.out = [&scene, solids = solidsOf(scene)](Vec3d p) { return outOf(scene, solids, p); };
    const double dx = latticeStep(scene).x;
    Jitter random(scene, 1);
    auto near = [&](Vec3d at) {
        for (int tries = 0; tries < 50; ++tries)
            if (const Vec3d to = at + random.next(); region.inside(to, dx) > 0.5) return to;
        return at;
    };
    auto adjust = [&](std::vector<Place>& some, double cells) {
        const size_t wanted = std::max<size_t>(1, size_t(std::llround(cells)));
        while (some.size() > wanted) {
            some[random.oneOf(some.size())] = some.back();
            some.pop_back();
        }
        while (some.size() < wanted && !some.empty()) {
            const Place beside = some[random.oneOf(some.size())];
            some.push_back(beside);
        }
    };
    if (isCut) {  // none gets from one part to the other
        const std::vector<double> volumes = bodyVolumes(scene);
        std::vector<Place> all;
        for (size_t b = 0; b < volumes.size(); ++b) {
            std::vector<Place> some;
            for (const Place& place : places)
                if (place.body == b) some.push_back(place);
            adjust(some, volumes[b] / particleVolume(scene));
            all.insert(all.end(), some.begin(), some.end());
        }
        places = all;
    } else {
        adjust(places, volumeOf(region, dx) / std::pow(dx, region.dimensions));
    }
    std::vector<Vec3d> at;
    for (const Place& place : places) at.push_back(near(place.at));
    relax(at, region, dx, scene.compute.threads);
    for (size_t i = 0; i < places.size(); ++i) places[i].at = at[i];
}

}  // namespace spindrift
