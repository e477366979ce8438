#pragma once
// Kernels of a fluid's particles that are flat where the fluid is: along surfaces and sheets.
#include <openvdb/openvdb.h>

#include <vector>

namespace spindrift {

// How much of each point is fluid, by kernels that are stretched as the particles around them lie
// (Yu & Turk 2013): half less that share, times `spacing`, so that it is 0 on the surface, positive
// outside, and there about a distance. Places, `spacing` of the particles and `cell` of the grid in
// m.
openvdb::FloatGrid::Ptr stretchedKernels(const std::vector<openvdb::Vec3d>& places, double spacing,
                                         double cell);

}  // namespace spindrift
