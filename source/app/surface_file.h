#pragma once
// The surface around particles, in a file.
#include "app/fluid_mesh.h"

#include <string>
#include <vector>

namespace spindrift {

// ply, obj, vdb.
const std::vector<std::string>& surfaceFormats();

// Around a fluid of this volume, m^3; places and spacing in m. Throws Error (Usage) where this
// program has no OpenVDB.
class SurfaceFile {
public:
    SurfaceFile(const std::vector<Vec3d>& places, double spacing, double volume,
                const SurfaceMethod&);
    size_t triangles() const { return mesh_.triangles.size(); }
    double volume() const { return mesh_.volume; }  // m^3, that they enclose
    // As the extension says, the triangles or the level set. Throws Error (Output).
    void write(const std::string& path) const;

private:
    FluidLevelSet distances_;
    double shift_ = 0;
    FluidMesh mesh_;
};

}  // namespace spindrift
