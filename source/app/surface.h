#pragma once
// spindrift surface: files of particles, of any program, into surfaces.
#include "app/fluid_mesh.h"

#include <string>
#include <vector>

namespace spindrift {

struct SurfaceOptions {
    std::vector<std::string> files;  // tables of particles, CSV or HDF5
    std::string out;     // a file for one table, a folder for more; "": beside the table
    std::string format;  // ply, obj or vdb; "": as `out` says, else ply
    double spacing = 0;  // of the particles, m; 0: as the particles say
    SurfaceMethod method;
};

// Throws Error: Scene for a table that can't be read, Usage for a mistake in the options, Output.
int makeSurfaces(const SurfaceOptions&);

}  // namespace spindrift
