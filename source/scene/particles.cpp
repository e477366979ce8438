#include "scene/particles.h"

#include "scene/body_parts.h"
#include "scene/convex.h"
#include "scene/lattice.h"
#include "scene/motion.h"
#include "scene/particle_file.h"
#include "scene/relax.h"
#include "scene/sample_object.h"
#include "scene/sample_solid.h"
#include "scene/start_fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace spindrift {
namespace {

// Counts beyond this stay here, so that a product of three fits in 64 bits.
constexpr double MaxPlanes = 2e6;

// A lattice in doubles: point (i, j, k) is at first + i * step, per axis.
struct Lattice {
    int64_t n[3];
    Vec3d first, step;
    Vec3d at(int64_t i, int64_t j, int64_t k) const {
        return {first.x + i * step.x, first.y + j * step.y, first.z + k * step.z};
    }
};

// In two dimensions there is none along z.
double leastStep(const Lattice& l) {
    return std::min({l.step.x, l.step.y, l.step.z > 0 ? l.step.z : l.step.x});
}

int64_t planes(double ratio) {
    return std::isfinite(ratio) ? int64_t(std::clamp(ratio, 0.0, MaxPlanes)) : int64_t(MaxPlanes);
}

// In two dimensions z has one layer.
bool flat(const Scene& scene, int axis) { return scene.simulation.dimensions == 2 && axis == 2; }

// The planes of a body along an axis, m from the domain's lower corner: a cornered one's begin half
// a step inside its lower corner, a round body's are symmetric about its centre.
struct Planes {
    int64_t count;
    double first, step;
};
Planes planesOf(const Scene& scene, const Body& body, int axis, double step) {
    if (flat(scene, axis)) return {1, 0.5 * scene.domain.size()[axis], 0};
    const double origin = scene.domain.min[axis];
    if (!isBox(body)) {
        const int64_t n = planes(std::round(2 * halfExtent(body)[axis] / step));
        return {n, convexOf(body, 3).middle[axis] - 0.5 * step * double(n - 1) - origin, step};
    }
    const auto [low, count, s] = layersOf(scene, body, axis, step);
    // A body that ends at the wall must not round up into it.
    const double room = double(scene.domain.max[axis]) - low;
    const int64_t n = count > 0 && double(count) * s > room + 0.25 * s ? count - 1 : count;
    return {n, low + 0.5 * s - origin, s};
}

// The body's cell-centred lattice relative to domain.min.
Lattice bodyLattice(const Scene& scene, const Body& body) {
    const Vec3d step = latticeStep(scene);
    Lattice lattice{{}, {}, step};
    if (flat(scene, 2)) lattice.step.z = 0;
    if (body.shape == Shape::File) return lattice;  // no point
    for (int k = 0; k < 3; ++k) {
        const Planes p = planesOf(scene, body, k, step[k]);
        lattice.n[k] = p.count, lattice.first[k] = p.first, lattice.step[k] = p.step;
    }
    return lattice;
}

std::vector<Lattice> latticesOf(const Scene& scene) {
    std::vector<Lattice> lattices;
    for (const Body& body : scene.fluid.bodies) lattices.push_back(bodyLattice(scene, body));
    return lattices;
}

// Whether p, relative to domain.min, lies in the body. Flat sides are taken where the lattice ends,
// half a spacing beyond its last plane.
bool contains(const Body& body, const Lattice& lattice, Vec3d origin, Vec3d p) {
    if (body.shape == Shape::File) return false;
    for (int k = 0; k < 3; ++k) {
        if (!hasFlatEnds(body, k)) continue;
        const double low = lattice.first[k] - 0.5 * lattice.step[k];
        if (p[k] < low || p[k] > low + double(lattice.n[k]) * lattice.step[k]) return false;
    }
    if (body.shape == Shape::Block) return true;
    if (body.shape == Shape::Wedge) {
        const Convex wedge = convexOf(body, 2);
        return wedge.nearest(p + origin - wedge.middle).distance <= 1e-6 * lattice.step.x;
    }
    if (body.shape == Shape::Mesh) {  // files round coordinates
        const Convex mesh = convexOf(body, 3);
        return mesh.nearest(p + origin - mesh.middle).distance <= 1e-4 * lattice.step.x;
    }
    Vec3d d = p - (toDouble(body.center) - origin);
    if (lattice.step.z == 0) d.z = 0;  // two dimensions
    if (body.shape == Shape::Cylinder) d[int(body.axis)] = 0;
    // The tolerance keeps lattice points on the surface on both sides of the centre alike.
    return length(d) <= double(body.radius) + 1e-6 * lattice.step.x;
}

// Layers of boundary particles on each face of an axis, none where it has none: all that fluid half
// a spacing from the face can see. Classic: one.
int64_t wallLayers(const Scene& scene, int axis) {
    if (scene.domain.periodic(axis) || flat(scene, axis)) return 0;
    if (scene.simulation.formulation == Formulation::Classic) return 1;
    return boundaryLayers(scene);
}

// The lattice whose outer layers are boundary particles. Default: it continues the fluid's lattice,
// the first layer half a spacing outside each face. Classic: 2G points an edge at 0.999 i L/(2G-1),
// G = ceil(L/R) rounded as the original's floats do.
Lattice wallLattice(const Scene& scene) {
    Lattice lattice{};
    const Vec3d size = scene.domain.size(), step = wallStep(scene);
    const float R = supportRadius(scene);
    for (int k = 0; k < 3; ++k) {
        if (scene.simulation.formulation == Formulation::Classic) {
            const float side = scene.domain.max[k] - scene.domain.min[k];
            lattice.n[k] = std::max<int64_t>(2, planes(2 * double(std::ceil(side / R))));
            lattice.step[k] = 0.999 * size[k] / double(lattice.n[k] - 1);
        } else {
            const int64_t inside =
                flat(scene, k) ? 1 : std::max<int64_t>(1, planes(std::round(size[k] / step[k])));
            lattice.step[k] = flat(scene, k) ? size[k] : step[k];
            lattice.n[k] = inside + 2 * wallLayers(scene, k);
            lattice.first[k] = (0.5 - double(wallLayers(scene, k))) * lattice.step[k];
        }
    }
    return lattice;
}

// The points of a lattice that are not in its inside.
struct Shell {
    Lattice lattice;
    int64_t layers[3];
    int64_t count() const {
        int64_t all = 1, inner = 1;
        for (int k = 0; k < 3; ++k) {
            all *= lattice.n[k];
            inner *= std::max<int64_t>(0, lattice.n[k] - 2 * layers[k]);
        }
        return all - inner;
    }
    bool contains(int64_t i, int axis) const {
        return i < layers[axis] || i >= lattice.n[axis] - layers[axis];
    }
};

Shell wallShell(const Scene& scene) {
    return {wallLattice(scene), {wallLayers(scene, 0), wallLayers(scene, 1), wallLayers(scene, 2)}};
}

void placeShell(const Shell& shell, std::vector<Vec3>& out) {
    const Lattice& l = shell.lattice;
    out.reserve(size_t(shell.count()));
    for (int64_t k = 0; k < l.n[2]; ++k)
        for (int64_t j = 0; j < l.n[1]; ++j)
            for (int64_t i = 0; i < l.n[0]; ++i) {
                if (shell.contains(i, 0) || shell.contains(j, 1) || shell.contains(k, 2))
                    out.push_back(toFloat(l.at(i, j, k)));
                else
                    i = l.n[0] - shell.layers[0] - 1;  // on to the far face
            }
}

bool relaxed(const Scene& scene) { return scene.simulation.placement == StartPlaces::Relaxed; }

// Uniform in [-reach, reach] along each axis that the scene has. The same numbers from every
// standard library.
class Jitter {
public:
    Jitter(const Scene& scene, double reach)  // in spacings
        : random_(unsigned(scene.simulation.seed)),
          dimensions_(scene.simulation.dimensions),
          reach_(reach * double(scene.simulation.spacing)) {}
    Vec3d next() {
        Vec3d d{0, 0, 0};
        if (reach_ == 0) return d;
        for (int k = 0; k < dimensions_; ++k)
            d[k] = reach_ * (2 * (random_() + 0.5) / 4294967296.0 - 1);
        return d;
    }
    size_t oneOf(size_t count) { return random_() % count; }

private:
    std::mt19937 random_;
    int dimensions_;
    double reach_;  // m
};

// Signed distance from a shape's surface at p, relative to domain.min, m: positive outside.
double distanceFrom(const Scene& scene, const Convex& shape, Vec3d p) {
    return shape.nearest(p + toDouble(scene.domain.min) - shape.middle).distance;
}

std::vector<Convex> solidsOf(const Scene& scene) {
    std::vector<Convex> solids;
    for (const Solid& solid : scene.solids)
        solids.push_back(convexOf(solid, scene.simulation.dimensions));
    return solids;
}

// Whether p lies in a solid or a thin skin around it, in which no fluid starts. Lattices that don't
// end at the surface must fill the space in front of it in the mean: a tank with a wedge on its
// floor, H/dx = 40, has 0.5 % error of pressure with a skin of 0.1 dx, 1.7 % with 0.3 dx. Where
// layers are parallel to a face and don't fit, there is one too few rather than one too many, which
// bursts.
bool isTaken(const Scene& scene, const std::vector<Convex>& solids, double besideFaces, Vec3d p) {
    const double skin = 0.1 * double(scene.simulation.spacing);
    for (size_t s = 0; s < solids.size(); ++s) {
        const double least = isFace(scene.solids[s]) ? std::max(besideFaces, skin) : skin;
        if (distanceFrom(scene, solids[s], p) < least) return true;
    }
    return false;
}

// Where a particle begins, relative to domain.min, and of which body it has the rest.
struct Place {
    Vec3d at;
    size_t body;
};

// Whether a particle of this body lies nearer to p than 0.98 spacings. Lattices that don't match
// and come nearer squeeze particles (0.95 spacings: 6 %, 0.78: 12 %), and their fluid bursts apart
// in the first steps, faster than a first-order integrator follows.
bool crowds(const Body& body, const Lattice& l, Vec3d origin, Vec3d p) {
    const double least = 0.98 * leastStep(l);
    int64_t low[3];
    for (int k = 0; k < 3; ++k)
        low[k] = l.step[k] > 0 ? int64_t(std::floor((p[k] - l.first[k]) / l.step[k])) : 0;
    for (int corner = 0; corner < 8; ++corner) {
        int64_t at[3];
        bool inside = true;
        for (int k = 0; k < 3; ++k)
            at[k] = low[k] + (corner >> k & 1), inside = inside && at[k] >= 0 && at[k] < l.n[k];
        const Vec3d q = l.at(at[0], at[1], at[2]);
        if (inside && length(p - q) < least && contains(body, l, origin, q)) return true;
    }
    return false;
}

// Appends the points of body `b` that are not in an earlier body or a solid.
void placeBody(const Scene& scene, const std::vector<Lattice>& lattices, size_t b,
               const std::vector<Convex>& solids, Jitter& jitter, std::vector<Place>& out) {
    const std::vector<Body>& bodies = scene.fluid.bodies;
    const Vec3d origin = toDouble(scene.domain.min);
    const Lattice& l = lattices[b];
    const bool fits = areSidesWhole(scene) || relaxed(scene);
    const double besideFaces = fits ? 0 : 0.4 * leastStep(l);
    for (int64_t k = 0; k < l.n[2]; ++k)
        for (int64_t j = 0; j < l.n[1]; ++j)
            for (int64_t i = 0; i < l.n[0]; ++i) {
                const Vec3d p = l.at(i, j, k);
                bool free =
                    contains(bodies[b], l, origin, p) && !isTaken(scene, solids, besideFaces, p);
                for (size_t e = 0; e < b && free; ++e)
                    free = !crowds(bodies[e], lattices[e], origin, p);
                if (free) out.push_back({p + jitter.next(), b});
            }
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

std::vector<Form> fittedBodies(const Scene& scene, const std::vector<Lattice>& lattices) {
    std::vector<Form> forms;
    for (size_t b = 0; b < lattices.size(); ++b)
        forms.push_back(fitted(scene, scene.fluid.bodies[b], lattices[b]));
    return forms;
}

// Some forms together, without the solids.
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

// Packed against the same boundary particles that fluid will feel: against a wall that is a
// continuum it comes 0.1 spacings nearer, and is pushed off when the run begins.
void addBoundary(const Scene& scene, Region& region) {
    const int d = scene.simulation.dimensions;
    const double dx = scene.simulation.spacing;
    const bool walls = scene.walls.kind == WallKind::Particles;
    for (const Solid& solid : scene.solids) {
        const SolidSample sample = sampleSolid(scene, solid);
        for (size_t i = 0; i < sample.positions.size(); ++i) {
            region.boundary.push_back(toDouble(sample.positions[i]));
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

// From a random start: up to a spacing away from the lattice along each axis (half a spacing leaves
// its rows to be seen), but in the region. As many as fit: a lattice in a round body has a few too
// many or too few.
void relaxPlaces(const Scene& scene, const std::vector<Lattice>& lattices, bool isCut,
                 std::vector<Place>& places) {
    Region region = regionOf(scene, fittedBodies(scene, lattices));
    if (scene.simulation.formulation != Formulation::Classic) addBoundary(scene, region);
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

// Appends the particles of a file as they are, in two dimensions in the layer of the others.
void placeFile(const Scene& scene, const Body& body, Placement& out) {
    const ParticleTable table = readParticles(body.path);
    const Vec3d origin = toDouble(scene.domain.min);
    for (size_t i = 0; i < table.positions.size(); ++i) {
        Vec3d place = table.positions[i] - origin, velocity = table.velocities[i];
        if (flat(scene, 2)) place.z = 0.5 * scene.domain.size().z, velocity.z = 0;
        out.positions.push_back(toFloat(place));
        out.velocities.push_back(toFloat(velocity));
        out.pressures.push_back(table.pressures.empty() ? 0.0f : float(table.pressures[i]));
    }
    if (table.densities.empty()) return;
    out.densities.resize(out.positions.size() - table.densities.size());
    for (double rho : table.densities) out.densities.push_back(float(rho));
}

}  // namespace

float supportRadius(const Scene& scene) {
    return scene.simulation.support * scene.simulation.spacing;
}

std::string perDepth(const std::string& unit, int dimensions) {
    return dimensions == 2 ? unit + "/m" : unit;
}

float particleMass(const Scene& scene) {
    if (scene.fluid.particleMass > 0) return scene.fluid.particleMass;
    if (hasOwnVolume(scene)) return float(scene.fluid.restDensity * particleVolume(scene));
    const float dx = scene.simulation.spacing, area = scene.fluid.restDensity * dx * dx;
    return scene.simulation.dimensions == 2 ? area : area * dx;
}

bool carriesDensity(const Scene& scene) {
    return scene.simulation.formulation == Formulation::DeltaSph || shiftsParticles(scene);
}

namespace {

// Up is what pictures show upright: a flow that gravity drives along a periodic axis lies level.
Up upAgainstGravity(const Scene& scene) {
    const Vec3 g = scene.simulation.gravity;
    int axis = 1;
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        if (std::abs(g[k]) > std::abs(g[axis])) axis = k;
    if (g[axis] == 0 || scene.domain.periodic(axis)) return Up::Y;
    constexpr Up Against[] = {Up::X, Up::Y, Up::Z}, Along[] = {Up::MinusX, Up::MinusY, Up::MinusZ};
    return g[axis] < 0 ? Against[axis] : Along[axis];
}

}  // namespace

Up upOf(const Scene& scene) {
    return scene.view.up == Up::Auto ? upAgainstGravity(scene) : scene.view.up;
}

Vec3 upward(const Scene& scene) {
    constexpr Vec3 Axes[] = {{0, 1, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                             {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    return Axes[size_t(upOf(scene))];
}

float restDensity(const Scene& scene, const Body& body) {
    return body.restDensity > 0 ? body.restDensity : scene.fluid.restDensity;
}
float viscosity(const Scene& scene, const Body& body) {
    return body.viscosity >= 0 ? body.viscosity : scene.fluid.viscosity;
}
bool isMixture(const Scene& scene) {
    return std::any_of(scene.fluid.bodies.begin(), scene.fluid.bodies.end(), [&](const Body& b) {
        return restDensity(scene, b) != scene.fluid.restDensity ||
               b.viscosity >= 0;  // the scene's viscosity may change during a run
    });
}
float largestViscosity(const Scene& scene) {
    float most = 0;
    for (const Body& body : scene.fluid.bodies) most = std::max(most, viscosity(scene, body));
    return most;
}

bool mixes(const Scene& scene) {
    return scene.fluid.velocityTransfer > 0 || scene.fluid.buoyancy > 0;
}

bool shiftsParticles(const Scene& scene) {
    const Formulation f = scene.simulation.formulation;
    return f == Formulation::DeltaPlus || f == Formulation::TransportVelocity;
}

int64_t latticePlanes(const Scene& scene, const Body& body, int axis) {
    return planesOf(scene, body, axis, latticeStep(scene)[axis]).count;
}

Placement placeParticles(const Scene& scene) {
    Placement out;
    const std::vector<BodyPart> parts = partsOf(scene);
    Scene cut = scene;
    cut.fluid.bodies.clear();
    for (const BodyPart& part : parts) cut.fluid.bodies.push_back(part.body);
    const std::vector<Lattice> lattices = latticesOf(cut);
    const size_t expected = size_t(countParticles(scene).fluid);
    out.positions.reserve(expected);
    out.velocities.reserve(expected);
    out.pressures.reserve(expected);
    Jitter jitter(scene, scene.simulation.jitter);
    const std::vector<Convex> solids = solidsOf(scene);
    std::vector<Place> places;
    for (size_t b = 0; b < lattices.size(); ++b)
        placeBody(cut, lattices, b, solids, jitter, places);
    if (!scene.objects.empty())
        std::erase_if(
            places, [objects = ObjectRoom(scene)](const Place& p) { return objects.takes(p.at); });
    if (relaxed(scene) && !places.empty())
        relaxPlaces(cut, lattices, parts.size() > scene.fluid.bodies.size(), places);
    for (const Place& place : places) {
        const size_t body = parts[place.body].of;
        const Start start = startOf(scene, scene.fluid.bodies[body], place.at);
        out.positions.push_back(toFloat(place.at));
        out.velocities.push_back(toFloat(start.velocity));
        out.pressures.push_back(float(start.pressure));
        out.bodies.push_back(uint16_t(body));
    }
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        if (scene.fluid.bodies[b].shape == Shape::File)
            placeFile(scene, scene.fluid.bodies[b], out);
        out.bodies.resize(out.positions.size(), uint16_t(b));
    }
    if (!isMixture(scene)) out.bodies = {};
    if (!out.densities.empty()) out.densities.resize(out.positions.size());
    for (const Solid& solid : scene.solids) {
        const std::vector<Vec3> points = sampleSolid(scene, solid).positions;
        out.walls.insert(out.walls.end(), points.begin(), points.end());
        out.solidSizes.push_back(int(points.size()));
    }
    if (scene.walls.kind == WallKind::Particles) placeShell(wallShell(scene), out.walls);
    return out;
}

double relaxedCells(const Scene& scene) {
    const Region region = regionOf(scene, fittedBodies(scene, latticesOf(scene)));
    double cells = 1;
    for (int k = 0; k < region.dimensions; ++k)
        cells *= (region.high[k] - region.low[k]) / scene.simulation.spacing;
    return cells;
}

std::vector<double> bodyVolumes(const Scene& scene) {
    const int d = scene.simulation.dimensions;
    const double dx = scene.simulation.spacing, most = 3e5;
    const std::optional<ObjectRoom> objects =
        scene.objects.empty() ? std::nullopt : std::optional<ObjectRoom>(scene);
    std::vector<double> volumes;
    std::vector<Convex> earlier;
    for (const Body& body : scene.fluid.bodies) {
        if (body.shape == Shape::File) {
            volumes.push_back(0);
            continue;
        }
        Region region = regionOf(scene, {body});
        region.inside = [&, alone = region.inside](Vec3d p, double width) {
            double share = objects && objects->takes(p) ? 0 : alone(p, width);
            for (const Convex& e : earlier)
                share =
                    std::min(share, std::clamp(0.5 + distanceFrom(scene, e, p) / width, 0.0, 1.0));
            return share;
        };
        double box = 1;
        for (int k = 0; k < d; ++k) box *= region.high[k] - region.low[k];
        volumes.push_back(volumeOf(region, std::max(dx, 2 * std::pow(box / most, 1.0 / d))));
        earlier.push_back(convexOf(body, d));
    }
    return volumes;
}

FluidExtent extentOf(const Placement& p) {
    FluidExtent e;
    for (size_t i = 0; i < p.positions.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            e.low[k] = std::min<double>(e.low[k], p.positions[i][k]);
            e.high[k] = std::max<double>(e.high[k], p.positions[i][k]);
        }
        e.speed = std::max<double>(e.speed, length(p.velocities[i]));
    }
    return e;
}

double soundSpeed(const Scene& s, const FluidExtent& fluid) {
    const int gamma = s.fluid.equationOfState == EquationOfState::Linear ? 1 : s.fluid.gamma;
    if (s.fluid.stiffness > 0)
        return std::sqrt(double(s.fluid.stiffness) * gamma / s.fluid.restDensity);
    if (s.fluid.soundSpeed > 0) return s.fluid.soundSpeed;
    const Vec3d g = toDouble(s.simulation.gravity), size = s.domain.size();
    Vec3d low = fluid.low, high = fluid.high;  // of all that falls
    for (const Solid& solid : s.solids) {
        if (!solid.floats()) continue;
        const Vec3d middle = convexOf(solid, 3).middle - toDouble(s.domain.min);
        for (int k = 0; k < 3; ++k)
            low[k] = std::min(low[k], middle[k]), high[k] = std::max(high[k], middle[k]);
    }
    for (const Object& o : s.objects) {
        const Vec3d at = middleOf(o) - toDouble(s.domain.min);
        for (int k = 0; k < 3; ++k)
            low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    double fall = 0;  // m^2/s^2
    for (int k = 0; k < 3; ++k)
        fall += s.domain.periodic(k) ? std::abs(g[k]) * size[k]
                : g[k] > 0           ? g[k] * (size[k] - low[k])
                                     : -g[k] * high[k];
    double start = std::max<double>(fluid.speed, length(s.walls.velocity));
    for (const Solid& solid : s.solids) start = std::max(start, largestSpeed(solid));
    for (const Object& object : s.objects)
        start = std::max(start, length(toDouble(object.velocity)));
    for (const Grip& grip : s.grips) start = std::max(start, largestSpeed(grip));
    const double pull =
        s.simulation.centralRate * length(0.5 * size);  // to the centre from a corner
    // The pressure in the smallest drop that is one, 2 sigma / R.
    const double tension = 4 * s.fluid.surfaceTension / (s.fluid.restDensity * supportRadius(s));
    return s.fluid.speedRatio *
           std::max(std::sqrt(start * start + 2 * fall + pull * pull + tension), 1e-3);
}

// Whole shells of the bounding box.
static double mostInSolid(const Scene& scene, const Solid& solid) {
    double all = 1, inner = 1;
    if (solid.shape == Shape::Plane) return mostOfPlane(scene);
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const double n = std::ceil(2 * halfExtent(solid)[k] / scene.simulation.spacing) + 1;
        all *= n, inner *= std::max(0.0, n - 2 * boundaryLayers(scene) - 2);
    }
    if (solid.shape == Shape::Mesh) {  // near its surface, which may be anywhere in the box
        const double dx = scene.simulation.spacing / double(solid.scale);
        return std::min(
            all, 2 * (boundaryLayers(scene) + 1) * (readMesh(solid.path)->area() / (dx * dx) + 10));
    }
    return all - inner;
}

ParticleCount countParticles(const Scene& scene) {
    ParticleCount count;
    const Vec3d step = latticeStep(scene);
    const double least = std::min({step.x, step.y, step.z});
    double fluid = 0;
    for (const Body& body : scene.fluid.bodies) {
        if (body.shape == Shape::File) {
            fluid += double(countParticlesIn(body.path));
            continue;
        }
        const Lattice l = bodyLattice(scene, body);
        double points = double(l.n[0]) * double(l.n[1]) * double(l.n[2]);
        // A relaxed block fills the domain up to a side that is half a spacing beyond its last
        // plane.
        for (int k = 0; k < scene.simulation.dimensions && relaxed(scene); ++k)
            points *= 1 + 1 / std::max(double(l.n[k]), 1.0);
        if (scene.simulation.dimensions == 2) {
            fluid += points;
            continue;
        }
        // Every kept point's cell lies in the round body grown by half a cell's diagonal.
        const double r = double(body.radius) / least + 0.5 * std::numbers::sqrt3;
        if (body.shape == Shape::Sphere)
            points = std::min(points, 4.0 / 3 * std::numbers::pi * r * r * r);
        if (body.shape == Shape::Cylinder)
            points = std::min(points, std::numbers::pi * r * r * double(l.n[int(body.axis)]));
        fluid += points;
    }
    count.fluid = int64_t(std::min(fluid, 9e18));
    if (scene.walls.kind == WallKind::Particles) count.walls = wallShell(scene).count();
    double solids = 0;
    for (const Solid& solid : scene.solids) solids += mostInSolid(scene, solid);
    count.walls += int64_t(std::min(solids, 4e18));
    return count;
}

}  // namespace spindrift
