#include "scene/check.h"

#include "scene/body_lattice.h"
#include "core/error.h"
#include "core/system.h"
#include "scene/check_methods.h"
#include "scene/check_view.h"
#include "scene/check_bodies.h"
#include "scene/check_particle_files.h"
#include "scene/check_sources.h"
#include "scene/convex.h"
#include "scene/formulation.h"
#include "scene/json.h"
#include "scene/motion.h"
#include "scene/output_fields.h"
#include "scene/particle_file.h"
#include "scene/lattice.h"
#include "scene/memory.h"
#include "scene/particle_spacing.h"
#include "scene/sample_object.h"
#include "scene/schema.h"
#include "scene/sources.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace spindrift {
namespace {

// Particle ids are 32-bit; walls and fluid together stay clear of the limit.
constexpr int64_t MostParticles = 1'000'000'000;
constexpr double SmallestSupport = 1.5;

std::string bodyPath(size_t index) { return fmt::format("fluid.bodies[{}]", index); }

// Places in a scene are floats.
void requirePlaces(const Scene& scene) {
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const double farthest =
            std::max(std::abs(scene.domain.min[k]), std::abs(scene.domain.max[k]));
        const double step = farthest * double(std::numeric_limits<float>::epsilon());
        if (step > 0.01 * double(scene.simulation.spacing))
            refuse("domain",
                   fmt::format("reaches {} m from 0 along {}, where numbers are {:.2g} m apart, "
                               "too coarse for a simulation.spacing of {} m; move the scene "
                               "near 0, meshes by their offset, or raise simulation.spacing",
                               farthest, "xyz"[k], step, scene.simulation.spacing));
    }
}

void checkDomain(const Scene& scene) {
    const Vec3 size = scene.domain.max - scene.domain.min;
    const float R = supportRadius(scene);
    const int dimensions = scene.simulation.dimensions;
    for (int k = 0; k < 3; ++k) {
        const char axis = "xyz"[k];
        if (size[k] <= 0)
            refuse("domain.max",
                   fmt::format("{} = {} m is not above domain.min {} = {} m; make it larger", axis,
                               scene.domain.max[k], axis, scene.domain.min[k]));
        const float least = scene.domain.periodic(k) ? 4 * R : R;
        if (scene.domain.periodic(k) && k >= dimensions)
            refuse("domain.periodic_z", "there is no z in two dimensions; leave it out");
        if (scene.domain.periodic(k) && size[k] < least)
            refuse("domain", fmt::format("{} m along {}, a periodic axis, is less than four "
                                         "support radii, {} m; enlarge "
                                         "the domain or lower simulation.spacing",
                                         size[k], axis, least));
        if (k < dimensions && size[k] < R)
            refuse("domain",
                   fmt::format(
                       "{} m along {} is less than the support radius {} m; enlarge the domain or "
                       "lower simulation.spacing",
                       size[k], axis, R));
    }
    requirePlaces(scene);
    if (scene.simulation.support < SmallestSupport)
        refuse("simulation.support",
               fmt::format("{} leaves particles without neighbours; use {} to 6",
                           scene.simulation.support, SmallestSupport));
}

// Shifting spreads particles evenly over all the space it finds, and the pressure's gradient does
// not feel a surface.
void checkFills(const Scene& scene, ParticleCount count) {
    if (!factsOf(scene).fillsSpace) return;
    const double filled = shareFilled(scene, count);
    if (filled < 0.9)
        refuse("simulation.formulation",
               fmt::format("transport_velocity has no free surfaces, and fluid fills {:.0f} % of "
                           "the domain; use delta_plus "
                           "or wcsph, or fill it",
                           100 * filled));
}

// Forces that not every formulation has.
void checkRareForces(const Scene& scene) {
    const Fluid& f = scene.fluid;
    const Formulation formulation = scene.simulation.formulation;
    const char* name = enumNames(Formulation())[size_t(formulation)];
    if (!factsOf(scene).airResists && f.airDensity > 0)
        refuse("fluid.air_density",
               fmt::format("who is at the surface is known by summed densities, which {} does not "
                           "have; use wcsph, or 0",
                           name));
    if (!factsOf(scene).takesOthers && (hasMixingForces(scene) || f.dissipation > 0))
        refuse("fluid", fmt::format("velocity_transfer, buoyancy and dissipation are not of {}; "
                                    "use wcsph, delta_sph or delta_plus, or set "
                                    "them to 0",
                                    name));
    const bool several = isMultiFluid(scene);
    if (several && !factsOf(scene).takesFluids)
        refuse("fluid.bodies", fmt::format("are of several fluids, which {} does not have; use "
                                           "wcsph or delta_sph, or leave rest_density and "
                                           "viscosity of the bodies out",
                                           name));
    if (several && f.bodies.size() > 65535)
        refuse("fluid.bodies", "are more than the 65535 that a mixture can have; join some");
    for (size_t b = 0; b < f.bodies.size(); ++b)
        if (restDensity(scene, f.bodies[b]) < 0.01f * f.restDensity ||
            restDensity(scene, f.bodies[b]) > 100 * f.restDensity)
            refuse(bodyPath(b) + ".rest_density",
                   fmt::format("{} kg/m³ is more than 100 times lighter or heavier than "
                               "fluid.rest_density, {} kg/m³; "
                               "bring them closer",
                               restDensity(scene, f.bodies[b]), f.restDensity));
    if (f.surfaceTension > 0 && !factsOf(scene).takesTension)
        refuse("fluid.surface_tension", fmt::format("needs particles that are kept evenly spread, "
                                                    "or surfaces tear themselves apart; {} does "
                                                    "not, use simulation.formulation delta_plus",
                                                    name));
    if (f.buoyancy > 0 && scene.simulation.gravityRamp > 0)
        refuse("fluid.buoyancy",
               "goes with the whole gravity at once; set simulation.gravity_ramp or it to 0");
}

// Relaxing works through the whole box around the bodies, and has a start of its own.
void checkPlacement(const Scene& scene) {
    const SimulationKnobs& s = scene.simulation;
    if (s.placement == StartPlaces::Lattice) return;
    constexpr double MostCells = 1e8;
    if (s.jitter != 0)
        refuse("simulation.jitter",
               "moves particles of a lattice; set it to 0, or simulation.placement to lattice");
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b)
        if (scene.fluid.bodies[b].shape == Shape::File)
            refuse("simulation.placement",
                   fmt::format("relaxed moves no particles of a file, as {} has them; use lattice",
                               bodyPath(b)));
    if (const double cells = relaxedCells(scene); cells > MostCells)
        refuse("simulation.placement", fmt::format("relaxed would work through {:.2g} spacings^{} "
                                                   "around the bodies, more than {:g}; use "
                                                   "lattice, or a larger simulation.spacing",
                                                   cells, s.dimensions, MostCells));
}

void checkMovingFace(const Scene& scene) {
    const Walls& walls = scene.walls;
    if (walls.movingFace == Face::None) return;
    const int axis = (int(walls.movingFace) - 1) / 2;
    if (axis >= scene.simulation.dimensions || scene.domain.periodic(axis))
        refuse("walls.moving_face", fmt::format("there is no wall at {}; name a face that has one",
                                                enumNames(Face())[size_t(walls.movingFace)]));
    if (walls.velocity[axis] != 0)
        refuse("walls.velocity",
               fmt::format("{} = {} m/s leads out of the face; a face slides along itself",
                           "xyz"[axis], walls.velocity[axis]));
    if (walls.kind != WallKind::Particles || largestViscosity(scene) <= 0 ||
        factsOf(scene).isHistorical)
        refuse("walls.moving_face",
               "nothing sticks to it; it needs walls.kind particles, a fluid.viscosity above 0, "
               "and any "
               "formulation but the classic one");
}

void requireSlip(float length, const std::string& path) {
    if (length < 0 && length != -1)
        refuse(path, fmt::format("{} m is no length; use -1 for fluid that slides freely", length));
}

void checkSlip(const Scene& scene) {
    const Walls& walls = scene.walls;
    requireSlip(walls.slip, "walls.slip");
    for (int k = 0; k < 3; ++k)
        for (const auto& [lengths, name] :
             {std::pair(walls.slipMin, "walls.slip_min"), {walls.slipMax, "walls.slip_max"}}) {
            requireSlip(lengths[k], name);
            if (lengths[k] != 0 && (k >= scene.simulation.dimensions || scene.domain.periodic(k)))
                refuse(name, fmt::format("there is no wall across {}; set that to 0", "xyz"[k]));
        }
    for (size_t s = 0; s < scene.solids.size(); ++s)
        requireSlip(scene.solids[s].slip, fmt::format("solids[{}].slip", s));
    const bool faces = walls.slip != 0 || walls.slipMin != Vec3{} || walls.slipMax != Vec3{};
    if (faces && walls.kind != WallKind::Particles)
        refuse("walls.slip",
               "walls that reflect have walls.friction; use walls.kind particles, or set it to 0");
    if (faces && factsOf(scene).isHistorical)
        refuse("walls.slip", "the classic formulation's walls let all slip; set it to 0");
    const int face = int(walls.movingFace) - 1;
    if (face < 0) return;
    const Vec3 own = face % 2 ? walls.slipMax : walls.slipMin;
    if (walls.slip < 0 || own[face / 2] < 0)
        refuse("walls.moving_face",
               "fluid slides freely on it, and stays behind; give it a slip "
               "length of 0 or more, or set moving_face to none");
}

void checkBody(const Scene& scene, size_t index) {
    const Body& body = scene.fluid.bodies[index];
    if (body.shape == Shape::Plane)
        refuse(bodyPath(index) + ".shape", "a plane is for solids; name another shape");
    if (body.shape == Shape::File) return;  // when it is known to fit into memory
    if (body.shape == Shape::Mesh) checkMesh(scene, body, 1, bodyPath(index));
    const Vec3 half = toFloat(halfExtent(body)), middle = toFloat(convexOf(body, 3).middle);
    const bool cornered = body.shape == Shape::Block || body.shape == Shape::Wedge;
    const Vec3 low = cornered ? body.min : middle - half,
               high = cornered ? body.max : middle + half;
    for (int k = 0; k < 3; ++k) {
        const char axis = "xyz"[k];
        if (k >= scene.simulation.dimensions) continue;
        const float room = scene.domain.max[k] - scene.domain.min[k], extent = high[k] - low[k];
        const float tolerance = 1e-5f * room;
        if (extent <= 0)
            refuse(bodyPath(index) + ".max",
                   fmt::format("{} = {} m is not above min {} = {} m; make it larger", axis,
                               high[k], axis, low[k]));
        if (extent > room + tolerance)
            refuse(bodyPath(index),
                   fmt::format("{} m along {} is larger than the domain's {} m; shrink the body or "
                               "enlarge the domain",
                               extent, axis, room));
        const bool within =
            low[k] >= scene.domain.min[k] - tolerance && high[k] <= scene.domain.max[k] + tolerance;
        if (!within && body.shape == Shape::Mesh) refuseMeshPlace(scene, body, bodyPath(index));
        if (!within)
            refuse(
                bodyPath(index),
                fmt::format("spans {} to {} m along {}, outside the domain's {} to {} m; move it "
                            "inside",
                            low[k], high[k], axis, scene.domain.min[k], scene.domain.max[k]));
        if (body.field == Field::SoundWave &&
            !(carriesDensity(scene) && (scene.fluid.soundSpeed > 0 || scene.fluid.stiffness > 0)))
            refuse(
                bodyPath(index) + ".field",
                "a sound wave needs a fluid.sound_speed, and a formulation that carries density: "
                "delta_sph or transport_velocity");
        if (latticePlanes(scene, body, k) == 0)
            refuse(
                bodyPath(index),
                fmt::format("{} m along {} is too thin for a particle; thicken the body or lower "
                            "simulation.spacing ({} m)",
                            extent, axis, scene.simulation.spacing));
    }
}

// The particles that the bodies have, files among them counted.
ParticleCount countBodies(const Scene& scene) {
    try {
        return countParticles(scene);
    } catch (const Error& error) { refuse("fluid.bodies", error.what()); }
}

// What walls feel is known where their particles press.
void checkFaceForces(const Scene& scene) {
    const std::string path = "output.face_forces";
    if (factsOf(scene).isHistorical)
        refuse(path, "walls have no pressure in the classic formulation; use wcsph");
    if (scene.walls.kind != WallKind::Particles)
        refuse(path, "walls that reflect do not say what they feel; set walls.kind to particles");
    if (scene.domain.periodicX && scene.domain.periodicY &&
        (scene.domain.periodicZ || scene.simulation.dimensions == 2))
        refuse(path, "all axes are periodic, and the domain has no faces; leave it off");
}

void checkEnergyBalance(const Scene& scene) {
    const std::string path = "output.energy_balance";
    if (factsOf(scene).isHistorical)
        refuse(path, "the classic formulation's forces have no energies; use wcsph");
    if (scene.time.mode == TimeMode::Local)
        refuse(path, "it needs the same step everywhere; set time.mode to cfl");
    if (scene.time.integrator == Integrator::Split)
        refuse(path, "a split step knows no forces of one moment; use symplectic_euler");
}

void checkOutput(const Scene& scene) {
    const Output& output = scene.output;
    if (output.faceForces) checkFaceForces(scene);
    if (output.energyBalance) checkEnergyBalance(scene);
    const std::string& file = output.particles;
    if (!file.empty() && !file.ends_with(".csv") && !file.ends_with(".h5"))
        refuse(
            "output.particles",
            fmt::format("\"{}\" is of no known kind; name a file that ends in .csv or .h5", file));
    fieldsOf(output.fields);
}

// Where something reads must be in the domain; in two dimensions z does not matter, and a gauge's
// own axis never does.
void requireInside(const Scene& scene, const std::string& path, Vec3 at, int except = -1) {
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const float low = scene.domain.min[k], high = scene.domain.max[k],
                    tolerance = 1e-5f * (high - low);
        if (k != except && !(at[k] >= low - tolerance && at[k] <= high + tolerance))
            refuse(path, fmt::format("{} = {} m is outside the domain's {} to {} m; move it inside",
                                     "xyz"[k], at[k], low, high));
    }
}

void checkProbe(const Scene& scene, size_t index) {
    const std::vector<Probe>& probes = scene.output.probes;
    const Probe& probe = probes[index];
    const std::string path = fmt::format("output.probes[{}]", index);
    requireColumnName(probes, index, "output.probes");
    const bool reads = probe.kind == ProbeKind::Height || probe.kind == ProbeKind::Front;
    if (reads && int(probe.axis) >= scene.simulation.dimensions)
        refuse(path + ".axis", "there is no z in two dimensions; use x or y");
    if (probe.kind == ProbeKind::Point) requireInside(scene, path + ".position", probe.position);
    if (probe.kind == ProbeKind::Height)
        requireInside(scene, path + ".position", probe.position, int(probe.axis));
    if (probe.kind == ProbeKind::Line) {
        requireInside(scene, path + ".from", probe.from);
        requireInside(scene, path + ".to", probe.to);
    }
}

void checkCounts(const Scene& scene, ParticleCount count) {
    const std::string what = fmt::format(
        "{} fluid and {} boundary particles{}", count.fluid, count.walls,
        comesAndGoes(scene)     ? " at most"
        : scene.objects.empty() ? ""
                                : fmt::format(", {:.0f} of objects", countObjectParticles(scene)));
    const char* remedy = "raise simulation.spacing or shrink the bodies and the domain";
    if (count.fluid > MostParticles || count.walls > MostParticles - count.fluid)
        throw Error(
            Failure::Memory,
            fmt::format("simulation.spacing: {} are more than the {} that a run can have; {}", what,
                        MostParticles, remedy));
    constexpr double GiB = 1 << 30;
    const int64_t needed = estimateMemory(scene, count), available = os::freeMemory();
    if (needed > available)
        throw Error(
            Failure::Memory,
            fmt::format("simulation.spacing: {} need about {:.1f} GiB of memory, {:.1f} GiB "
                        "are free; {}",
                        what, double(needed) / GiB, double(available) / GiB, remedy));
    if (scene.compute.threads > count.fluid)
        refuse("compute.threads",
               fmt::format("{} threads are more than the {} particles; use 0 for all cores",
                           scene.compute.threads, count.fluid));
}

}  // namespace

void checkScene(const Scene& scene, const std::string& place, std::optional<ParticleCount> begun) {
    requireRanges(scene, place);
    try {
        checkDomain(scene);
        checkMethods(scene);
        if (scene.fluid.bodies.empty() && scene.sources.empty())
            refuse("fluid.bodies", "is empty; add a body of fluid, e.g. {\"shape\": \"block\"}");
        for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) checkBody(scene, b);
        checkMeshes(scene);
        checkSources(scene);
        const ParticleCount count = begun ? *begun : countBodies(scene);
        checkFills(scene, count);
        checkMovingFace(scene);
        checkSlip(scene);
        checkRareForces(scene);
        if (!begun) checkPlacement(scene);
        checkSolids(scene);
        checkObjects(scene);
        for (size_t p = 0; p < scene.output.probes.size(); ++p) checkProbe(scene, p);
        if (!begun) checkView(scene);
        checkOutput(scene);
        checkCounts(scene, {mostFluid(scene, count.fluid), count.walls});
        if (!begun) checkParticleFiles(scene);
    } catch (const Error& error) {
        throw Error(error.failure, fmt::format("{}: {}", place, error.what()));
    }
}

}  // namespace spindrift
