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

// How the surface is found.
struct SurfaceMethod {
    double cell = 0.5;  // of the grid, in spacings
    // How often the distances are averaged with their neighbours; -1: 3, with anisotropic
    // kernels 1.
    int smoothings = -1;
    bool anisotropic = false;  // kernels are flat along the surface (Yu & Turk 2013)
};

// Whether this program can; spindrift-surface can.
bool canMeshFluid();
// Throws Error (Usage) where it can't, or not with cells so small, m; `what` can't be made then.
void requireFluidMeshes(const std::string& what, double cell);

// How far places are from the fluid's surface. Particles are smoothed spheres (Zhu & Bridson 2005),
// so that flat fluid has a flat surface and drops are round, or anisotropic kernels; where it lies
// exactly is chosen so that it encloses the fluid's volume.
class FluidLevelSet {
public:
    // Places and spacing of the particles in m. Throws as requireFluidMeshes() does.
    FluidLevelSet(const std::vector<Vec3d>& particles, double spacing, const SurfaceMethod&);
    ~FluidLevelSet();
    // Closed, and of this volume, m^3, as far as a shift of less than half a spacing reaches.
    // `shift` becomes what was needed, m.
    FluidMesh mesh(double volume, double& shift) const;
    // The level set around what mesh() has, as a grid "surface" of an OpenVDB file. Returns whether
    // all of it was written.
    bool writeVdb(const std::string& path, double shift) const;

private:
    struct Grid;
    std::unique_ptr<Grid> grid_;
    double farthest_ = 0;  // m, that a shift may be
};

}  // namespace spindrift
