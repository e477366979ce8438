#pragma once
// The fluid's surface at every frame of a run, written beside it.
#include "app/fluid_mesh.h"
#include "core/beside.h"
#include "measure/moment_folder.h"
#include "sim/simulation.h"

#include <set>
#include <string>

namespace spindrift {

// output.surface: for a path run.ply the files run/surface_00000.ply, ...; the number says which of
// the series' moments it is. A new run takes the files of an older one away.
class SurfaceSeries {
public:
    // Throws Error: Output where nothing can be written, or what the scene begins with lies there;
    // Usage where this program has no OpenVDB; Scene in two dimensions.
    SurfaceSeries(const Scene&, const Measurement& now, double interval);
    void add(Simulation&, double time);
    // The run has gone back to this time, s.
    void dropAfter(double time);
    void finish() { beside_.wait(); }
    size_t moments() const { return numbers_.size(); }
    double endBefore() const { return endBefore_; }  // s, of the run before; -1: it has none

private:
    MomentFolder folder_;
    SurfaceMethod method_;
    double spacing_, volume_;  // m, and m^3 of a particle
    double interval_;          // s
    std::set<size_t> numbers_;
    double endBefore_ = -1;
    Beside beside_;
};

}  // namespace spindrift
