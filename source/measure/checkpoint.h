#pragma once
// A run that can go on later: its scene and its state in one HDF5 file.
#include "scene/scene.h"
#include "sim/run_state.h"

#include <string>
#include <vector>

namespace spindrift {

// What the window's curves show of a moment: s, J, J, 1; in two dimensions J/m.
struct CurvePoint {
    float time, kineticEnergy, potentialEnergy, densityError;
};

struct Checkpoint {
    Scene scene;
    RunState state;
    std::vector<CurvePoint> curves;  // of the run before, where the window kept them
};

// The file is there whole or not at all: it is written beside its target, flushed to the disk and
// renamed, so that a full disk or a power cut leaves the last one. Datasets (float32): positions
// and velocities [fluid, 3], walls [boundary, 3] in m and m/s, relative to the domain's lower
// corner, in the order of ids; attributes (float64): "clock" (time s, dt s, steps), "start" (lower
// and upper corner of the fluid m, its speed m/s); the scene as JSON; "curves" [points, 4], where
// there are any. Throws Error(Failure::Output).
void writeCheckpoint(const std::string& path, const Scene&, const RunState&,
                     const std::vector<CurvePoint>& curves = {});

// Whether a file claims to be HDF5, as scene files never do.
bool isCheckpoint(const std::string& path);

// Throws Error(Failure::Scene) with one line for a file that is truncated, damaged, of another
// program or of a newer version.
Checkpoint readCheckpoint(const std::string& path);

}  // namespace spindrift
