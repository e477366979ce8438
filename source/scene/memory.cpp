#include "scene/memory.h"

#include "scene/formulation.h"
#include "scene/sample_object.h"

#include <algorithm>

namespace spindrift {
namespace {

// State, sorted copies, neighbour blocks and vertices of one particle, with room to spare.
constexpr double BytesPerParticle = 400;
// Start and fill counters of one grid cell.
constexpr double BytesPerCell = 16;
// On a GPU: state, sorted copies, sort and vertices; what carried density and shifting add;
// boundary particles have no velocity. Cells: two starts and a count.
constexpr double GpuBytesPerParticle = 136, GpuBytesPerCarried = 8, GpuBytesPerShifted = 32,
                 GpuBytesPerWall = 76, GpuBytesPerCell = 13;
// Mixtures: mass and viscosity, and their sorted copies. Surface tension: a normal and its length.
constexpr double GpuBytesPerMixed = 16, GpuBytesPerNormal = 20;
// Of an elastic block, whose particles have 18 bonds each (measured: 1170 and 300); sheets have
// fewer.
constexpr double BytesPerObjectParticle = 1200, GpuBytesPerObjectParticle = 320;
constexpr double HostBytesPerGpuParticle = 100;
constexpr double GpuBytesAnyway = 64 << 20;
// Cells are half a spacing long and two wide; in a box that is mostly empty they are made larger.
double mostCells(const Scene& scene, double particles) {
    const Vec3d size = toDouble(scene.domain.max) - toDouble(scene.domain.min);
    const double dx = scene.simulation.spacing;
    const double depth = scene.simulation.dimensions == 2 ? 2 * dx : size.z;
    return std::min(size.x * size.y * depth / (2 * dx * dx * dx), std::max(4e6, 16 * particles));
}

// What an integrator keeps over an evaluation of the forces, or collisions over a step, and its
// sorted copies, on a GPU.
double keptBytes(const Scene& scene) {
    constexpr double Vector = 2 * 16, Scalar = 2 * 4;
    const double place = scene.solids.empty() ? 0 : Vector;  // where ways began
    if (scene.time.integrator == Integrator::SymplecticEuler ||
        scene.time.integrator == Integrator::Split)
        return place;
    if (scene.time.integrator == Integrator::VelocityVerlet) return Vector + place;
    return 2 * Vector + (carriesDensity(scene) ? Scalar : 0);
}

// What only some scenes keep, in bytes: what each term does to the fluid and what the fluid does to
// walls, and which point of a mouth holds a particle, with its number.
double extraBytes(const Scene& scene, double fluid, double walls) {
    constexpr double Vector = 16, Scalar = 4;
    const bool balance = scene.output.energyBalance, loads = balance || scene.output.faceForces;
    return ((balance ? 5 * Vector + 4 * Scalar : 0) + (comesAndGoes(scene) ? 2 * Scalar : 0)) *
               fluid +
           ((balance ? 2 * Vector : 0) + (loads ? 4 * Vector : 0)) * walls;
}

}  // namespace

int64_t estimateMemory(const Scene& scene, ParticleCount count) {
    const double particles = double(count.fluid) + double(count.walls),
                 objects = BytesPerObjectParticle * countObjectParticles(scene);
    // A GPU's run keeps nothing here, but passes through.
    if (scene.compute.backend == Backend::Cuda)
        return int64_t(HostBytesPerGpuParticle * particles + objects);
    const double bytes = BytesPerParticle * particles + BytesPerCell * mostCells(scene, particles) +
                         objects + extraBytes(scene, double(count.fluid), double(count.walls));
    return int64_t(std::min(bytes, 9e18));
}

int64_t estimateGpuMemory(const Scene& scene, ParticleCount count) {
    const double fluid = double(count.fluid), walls = double(count.walls);
    const double more = (carriesDensity(scene) ? GpuBytesPerCarried : 0) +
                        (shiftsParticles(scene) ? GpuBytesPerShifted : 0) +
                        (isMultiFluid(scene) ? GpuBytesPerMixed : 0) +
                        (scene.fluid.surfaceTension > 0 ? GpuBytesPerNormal : 0);
    const double bytes =
        (GpuBytesPerParticle + more + keptBytes(scene)) * fluid + GpuBytesPerWall * walls +
        GpuBytesPerCell * mostCells(scene, fluid + walls) + extraBytes(scene, fluid, walls) +
        GpuBytesPerObjectParticle * countObjectParticles(scene) + GpuBytesAnyway;
    return int64_t(std::min(bytes, 9e18));
}

}  // namespace spindrift
