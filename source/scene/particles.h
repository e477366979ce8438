#pragma once
// Shapes of a scene -> particle positions.
#include "core/vec.h"
#include "scene/sample_solid.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace spindrift {

// Positions and walls in metres relative to domain.min, velocities in m/s and pressures in Pa (one
// for each position; no pressures: none anywhere). The first of `walls` are the solids' particles
// where solids are at time 0, solidSizes[i] of the i-th.
struct Placement {
    std::vector<Vec3> positions, velocities, walls;
    std::vector<float> pressures;
    std::vector<int> solidSizes;
    std::vector<float>
        densities{};  // kg/m³, 0 where the pressure says; none at all where no file had any
    std::vector<uint16_t> bodies{};     // of a mixture: which body each particle is of
    std::vector<SolidSample> solids{};  // those of walls, at the beginning of a run
    // Where particles come and go: ids, rising, none at the beginning: 0, 1, ...; and which point
    // of the sources each is held by, from 1 on (scene/sources.h), 0: none; none at all: no one.
    std::vector<int> ids{}, heldBy{};
};

// Where the fluid is at the start, m from the domain's corner, and how fast, m/s.
struct FluidExtent {
    Vec3d low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
    double speed = 0;
};
FluidExtent extentOf(const Placement&);

// m/s: the scene's, or speed_ratio times the speed that fluid can reach by falling through the
// domain, whichever way gravity points now.
double soundSpeed(const Scene&, const FluidExtent&);

// Fills the bodies on lattices, relaxed from there if the scene says so, or from their files, and
// builds the boundary particles, in an order that depends on the scene only.
Placement placeParticles(const Scene&);

// What each body holds that no earlier one, no solid and no elastic object takes, m³, in two
// dimensions m²; 0 of a file's. To about 0.1 %.
std::vector<double> bodyVolumes(const Scene&);

struct ParticleCount {
    int64_t fluid = 0, walls = 0;
};

inline ParticleCount countOf(const Placement& p) {
    return {int64_t(p.positions.size()), int64_t(p.walls.size())};
}

// How many particles placeParticles would make, at most, without making any: exact for blocks that
// don't overlap and for the domain's walls, a few per cent too many for round bodies, more for
// solids. Absurd sizes saturate instead of overflowing. Throws Error (Scene) when a body's file
// can't be read.
ParticleCount countParticles(const Scene&);

// Of the domain, by the volume of so many fluid particles.
double shareFilled(const Scene&, ParticleCount);

// How many cells of a spacing's width the box around the bodies has: what relaxed places take time
// by.
double relaxedCells(const Scene&);

}  // namespace spindrift
