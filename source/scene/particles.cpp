#include "scene/particles.h"

#include "scene/body_lattice.h"
#include "scene/body_parts.h"
#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/lattice.h"
#include "scene/motion.h"
#include "scene/particle_file.h"
#include "scene/pack.h"
#include "scene/sample_object.h"
#include "scene/sample_solid.h"
#include "scene/sources.h"
#include "scene/start_fields.h"
#include "scene/thin_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace spindrift {
namespace {

// Whether p lies in a solid or a thin skin around it, in which no fluid starts; only in one that
// the lattice is to fit to, for fluid that is packed. Where layers are parallel to a face and don't
// fit, there is one too few rather than one too many, which bursts.
bool isTaken(const Scene& scene, const std::vector<Convex>& solids, double besideFaces,
             bool byFacesOnly, Vec3d p) {
    const double skin = 0.1 * double(scene.simulation.spacing);
    for (size_t s = 0; s < solids.size(); ++s) {
        const bool face = isFace(scene.solids[s]);
        if (byFacesOnly && !face) continue;
        if (distanceFrom(scene, solids[s], p) < (face ? std::max(besideFaces, skin) : skin))
            return true;
    }
    return false;
}

// Appends the points of body `b` that are not in an earlier body or a solid; those near slants
// apart.
void placeBody(const Scene& scene, const std::vector<Lattice>& lattices, size_t b,
               const std::vector<Convex>& solids, const Slants& slants, std::vector<Place>& out,
               std::vector<Candidate>& near) {
    const std::vector<Body>& bodies = scene.fluid.bodies;
    const Vec3d origin = toDouble(scene.domain.min);
    const Lattice& l = lattices[b];
    const bool fits = areSidesWhole(scene) || relaxed(scene);
    const double besideFaces = fits ? 0 : 0.4 * leastStep(l);
    auto crowded = [&](Vec3d p) {
        for (size_t e = 0; e < b; ++e)
            if (crowds(bodies[e], lattices[e], origin, p)) return true;
        return false;
    };
    for (int64_t k = 0; k < l.n[2]; ++k)
        for (int64_t j = 0; j < l.n[1]; ++j)
            for (int64_t i = 0; i < l.n[0]; ++i) {
                const Vec3d p = l.at(i, j, k);
                const double d = slants.distance(p);
                const bool isNear = d < slants.reach();
                if (!contains(bodies[b], l, origin, p) ||
                    isTaken(scene, solids, besideFaces, isNear, p) || crowded(p))
                    continue;
                if (!isNear)
                    out.push_back({p, b});
                else if (const CellLeft left = slants.leftOf(l, p, d); left.share > 0)
                    near.push_back({{left.middle, b}, d, left.share});
            }
}

// Appends the particles of a file, as they are or relaxed, each of its own body's fluid or of the
// one that it names, in two dimensions in the layer of the others.
void placeFile(const Scene& scene, size_t index, Placement& out) {
    const Body& body = scene.fluid.bodies[index];
    const ParticleTable table = readParticles(body.path);
    const Vec3d origin = toDouble(scene.domain.min);
    const size_t first = out.positions.size();
    for (size_t i = 0; i < table.positions.size(); ++i) {
        Vec3d place = table.positions[i] - origin, velocity = table.velocities[i];
        if (flat(scene, 2)) place.z = 0.5 * scene.domain.size().z, velocity.z = 0;
        out.positions.push_back(toFloat(place));
        out.velocities.push_back(toFloat(velocity));
        out.pressures.push_back(table.pressures.empty() ? 0.0f : float(table.pressures[i]));
        out.bodies.push_back(uint16_t(table.fluids.empty() ? double(index) : table.fluids[i]));
    }
    if (body.relax) relaxFrom(scene, first, out.positions);
    if (table.densities.empty()) return;
    out.densities.resize(out.positions.size() - table.densities.size());
    for (double rho : table.densities) out.densities.push_back(float(rho));
}

// None but what is held begins before a mouth, wherever it has come there from: moved by relaxing
// or read from a file.
void clearMouths(const Scene& scene, Placement& out) {
    if (scene.sources.empty()) return;
    const MouthRoom mouths(scene);
    size_t kept = 0;
    const bool hasDensities = !out.densities.empty();
    if (hasDensities) out.densities.resize(out.positions.size());
    for (size_t i = 0; i < out.positions.size(); ++i) {
        if (mouths.takes(toDouble(out.positions[i]))) continue;
        out.positions[kept] = out.positions[i];
        out.velocities[kept] = out.velocities[i];
        out.pressures[kept] = out.pressures[i];
        out.bodies[kept] = out.bodies[i];
        if (hasDensities) out.densities[kept] = out.densities[i];
        ++kept;
    }
    out.positions.resize(kept);
    out.velocities.resize(kept);
    out.pressures.resize(kept);
    out.bodies.resize(kept);
    if (hasDensities) out.densities.resize(kept);
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

bool carriesDensity(const Scene& scene) { return factsOf(scene).carriesDensity; }

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
bool isMultiFluid(const Scene& scene) {
    return std::any_of(scene.fluid.bodies.begin(), scene.fluid.bodies.end(), [&](const Body& b) {
        return restDensity(scene, b) != scene.fluid.restDensity ||
               b.viscosity >= 0;  // the scene's viscosity may change during a run
    });
}
float largestViscosity(const Scene& scene) {
    float most = 0;
    for (const Body& body : fluidsOf(scene.fluid)) most = std::max(most, viscosity(scene, body));
    return most;
}

bool letsSlip(const Scene& scene) {
    return scene.walls.slip != 0 || scene.walls.slipMin != Vec3{} ||
           scene.walls.slipMax != Vec3{} ||
           std::any_of(scene.solids.begin(), scene.solids.end(),
                       [](const Solid& s) { return s.slip != 0; });
}

ViscosityForm viscosityForm(const Scene& scene) {
    if (scene.fluid.viscosityForm != ViscosityForm::Auto) return scene.fluid.viscosityForm;
    return factsOf(scene).fillsSpace ? ViscosityForm::Morris : ViscosityForm::Monaghan;
}
const char* whyViscosityForm(const Scene& scene) {
    if (scene.fluid.viscosityForm != ViscosityForm::Auto) return "fluid.viscosity_form says so";
    return viscosityForm(scene) == ViscosityForm::Morris
               ? "transport_velocity has no free surface, and corrects Morris's sum"
               : "it drags fluid at free surfaces (fluid.viscosity_form)";
}

bool hasMixingForces(const Scene& scene) {
    return scene.fluid.velocityTransfer > 0 || scene.fluid.buoyancy > 0;
}

bool comesAndGoes(const Scene& scene) { return !scene.sources.empty() || !scene.sinks.empty(); }

bool shiftsParticles(const Scene& scene) { return factsOf(scene).shifts; }

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
    const Slants slants(cut, lattices);
    std::vector<Place> places;
    std::vector<std::vector<Candidate>> near(lattices.size());
    for (size_t b = 0; b < lattices.size(); ++b)
        placeBody(cut, lattices, b, solids, slants, places, near[b]);
    const size_t first = places.size();
    for (const std::vector<Candidate>& some : near) choose(some, slants, places);
    if (!std::all_of(near.begin(), near.end(), areWhole))
        packBeside(cut, lattices, slants, first, places);
    for (Place& place : places) place.at = place.at + jitter.next();
    if (!scene.sources.empty())
        std::erase_if(places,
                      [mouths = MouthRoom(scene)](const Place& p) { return mouths.takes(p.at); });
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
        if (scene.fluid.bodies[b].shape == Shape::File) placeFile(scene, b, out);
    }
    clearMouths(scene, out);
    fillMouths(scene, out);
    if (!isMultiFluid(scene)) out.bodies = {};
    if (!out.densities.empty()) out.densities.resize(out.positions.size());
    for (const Solid& solid : scene.solids) {
        const SolidSample& sample = out.solids.emplace_back(boundaryOf(scene, solid));
        out.walls.insert(out.walls.end(), sample.positions.begin(), sample.positions.end());
        out.solidSizes.push_back(int(sample.positions.size()));
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
    const MouthRoom mouths(scene);
    std::vector<double> volumes;
    std::vector<Convex> earlier;
    for (const Body& body : scene.fluid.bodies) {
        if (body.shape == Shape::File) {
            volumes.push_back(0);
            continue;
        }
        Region region = regionOf(scene, {body});
        region.inside = [&, alone = region.inside](Vec3d p, double width) {
            double share = (objects && objects->takes(p)) || mouths.takes(p) ? 0 : alone(p, width);
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
    if (!s.sources.empty()) low = {0, 0, 0}, high = size;  // fluid may fill it all
    double fall = 0;                                       // m^2/s^2
    for (int k = 0; k < 3; ++k)
        fall += s.domain.periodic(k) ? std::abs(g[k]) * size[k]
                : g[k] > 0           ? g[k] * (size[k] - low[k])
                                     : -g[k] * high[k];
    double start = std::max<double>(fluid.speed, length(s.walls.velocity));
    for (const Solid& solid : s.solids) start = std::max(start, largestSpeed(solid));
    for (const Object& object : s.objects)
        start = std::max(start, length(toDouble(object.velocity)));
    for (const Grip& grip : s.grips) start = std::max(start, largestSpeed(grip));
    for (const Source& source : s.sources) start = std::max(start, largestSpeed(s, source));
    const double pull =
        s.simulation.centralRate * length(0.5 * size);  // to the centre from a corner
    // The pressure in the smallest drop that is one, 2 sigma / R.
    const double tension = 4 * s.fluid.surfaceTension / (s.fluid.restDensity * supportRadius(s));
    return s.fluid.speedRatio *
           std::max(std::sqrt(start * start + 2 * fall + pull * pull + tension), 1e-3);
}

// Both faces with their layers, in the solid and beyond it.
static double mostInThinSolid(const Scene& scene, const Solid& solid) {
    const int layers = boundaryLayers(scene);
    const double dx = scene.simulation.spacing;
    double all = 2;
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        all *= std::ceil(2 * halfExtent(solid)[k] / dx) + 2 * layers + 3;
    if (solid.shape != Shape::Mesh || isBlock(solid)) return all;
    const double apart = dx / double(solid.scale);
    return std::min(all, 4 * (layers + 2) * (readMesh(solid.path)->area() / (apart * apart) + 100));
}

// Whole shells of the bounding box.
static double mostInSolid(const Scene& scene, const Solid& solid) {
    double all = 1, inner = 1;
    if (solid.shape == Shape::Plane) return mostOfPlane(scene);
    if (thinness(scene, solid) > 0) return mostInThinSolid(scene, solid);
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const double n = std::ceil(2 * halfExtent(solid)[k] / scene.simulation.spacing) + 1;
        all *= n, inner *= std::max(0.0, n - 2 * boundaryLayers(scene) - 2);
    }
    if (solid.shape == Shape::Mesh &&
        !isBlock(solid)) {  // near its surface, which may be anywhere in the box
        const double dx = scene.simulation.spacing / double(solid.scale);
        return std::min(
            all, 2 * (boundaryLayers(scene) + 1) * (readMesh(solid.path)->area() / (dx * dx) + 10));
    }
    return all - inner;
}

double shareFilled(const Scene& scene, ParticleCount count) {
    const Vec3d size = scene.domain.size();
    const double dx = scene.simulation.spacing,
                 depth = scene.simulation.dimensions == 2 ? dx : size.z;
    return double(count.fluid) * dx * dx * dx / (size.x * size.y * depth);
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
    for (const Source& source : scene.sources) fluid += double(particlesInMouth(scene, source));
    count.fluid = int64_t(std::min(fluid, 9e18));
    if (scene.walls.kind == WallKind::Particles) count.walls = wallShell(scene).count();
    double solids = 0;
    for (const Solid& solid : scene.solids) solids += mostInSolid(scene, solid);
    count.walls += int64_t(std::min(solids, 4e18));
    return count;
}

}  // namespace spindrift
