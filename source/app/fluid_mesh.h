#pragma once
// The surface around the particles of a fluid: a level set on a sparse grid, and the triangles on
// it.
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace spindrift {

struct FluidMesh {
    std::vector<Vec3d> points;                      // m
    std::vector<std::array<int32_t, 3>> triangles;  // against the clock seen from outside
    double volume = 0;                              // m^3, enclosed
};

// Whether this program can; spindrift-surface can.
bool canMeshFluid();

// How far places are from the fluid's surface. Particles are smoothed spheres (Zhu & Bridson 2005),
// so that flat fluid has a flat surface and drops are round; where it lies exactly is chosen so
// that it encloses the fluid's volume.
class FluidLevelSet {
public:
    // `spacing` of the particles, m; `cell` of the grid, in spacings; how often the distances are
    // averaged with their neighbours. Throws Error (Usage) where this program has no OpenVDB.
    FluidLevelSet(const std::vector<Vec3d>& particles, double spacing, double cell, int smoothings);
    ~FluidLevelSet();
    // Closed, and of this volume, m^3, as far as a shift of less than half a spacing reaches.
    // `shift` becomes what was needed, m.
    FluidMesh mesh(double volume, double& shift) const;
    // The distances less `shift`, as a grid "surface" of an OpenVDB file. Returns whether all of it
    // was written.
    bool writeVdb(const std::string& path, double shift) const;

private:
    struct Grid;
    std::unique_ptr<Grid> grid_;
    double farthest_ = 0;  // m, that a shift may be
};

}  // namespace spindrift
