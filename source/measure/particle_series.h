#pragma once
// Particles, solids and objects of a run at every frame, in files that other programs read,
// written beside the run.
#include "core/beside.h"
#include "measure/moment_files.h"
#include "measure/moment_folder.h"
#include "sim/simulation.h"

#include <chrono>
#include <string>
#include <vector>

namespace spindrift {

// Triangles of a solid around its middle, in its own axes, m.
struct SolidSurface {
    std::vector<Vec3d> points;
    std::vector<std::array<int32_t, 3>> triangles;
};

// output.series: for a path run.pvd the index run.pvd and beside it run/fluid_00000.vtp,
// run/solids_00000.vtp and run/objects_00000.vtp, as moment_files.h has them; the number says which
// of the series' moments it is. Solids that stay are written once. A new run takes the files of an
// older one away; a run that goes on adds to what its index names.
class ParticleSeries {
public:
    // `surfaces`: of the scene's solids, in their order; they may be empty. Throws Error (Output)
    // where nothing can be written, or what the scene begins with lies there; (Scene) where fields
    // are asked for that there aren't.
    ParticleSeries(const Scene&, Simulation&, std::vector<SolidSurface> surfaces,
                   const Measurement& now, double interval);
    void add(Simulation&, double time);
    // The run has gone back to this time, s.
    void dropAfter(double time);
    void finish();
    size_t moments() const { return entries_.size(); }
    double endBefore() const { return endBefore_; }  // s, of the run before; -1: it has none

private:
    bool hasSolids() const { return !surfaces_.empty() && format_.takesTriangles(); }
    Piece fluidOf(const std::vector<Particle>&) const;
    Piece solidsAt(const std::vector<SolidPose>&) const;
    Piece objectsOf(const RunState&) const;
    void goOn(double time);
    PieceFile describe(const Piece&, size_t number) const;
    PieceFile put(Piece, size_t number);
    void writeIndex();

    std::string path_;
    MomentFormat format_;
    MomentFolder folder_;
    Vec3d corner_;  // of the domain, world coordinates
    std::vector<std::string> fields_;
    float mass_;                    // kg, of a particle of the one fluid; in 2D kg/m
    std::vector<float> masses_;     // likewise, by id; empty: all have that one
    std::vector<int32_t> fluids_;   // entries of fluid.bodies, by id; empty: 0 for all
    std::vector<int32_t> objects_;  // of each object's particle, in their order
    std::vector<SolidSurface> surfaces_;
    std::vector<SolidPose> posed_;  // as last written,
    PieceFile posedFile_;           // where
    double interval_;               // s
    std::vector<IndexEntry> entries_;
    double endBefore_ = -1;
    // The index is written at most once a second: it grows, and is written whole.
    using Clock = std::chrono::steady_clock;
    Clock::time_point indexed_{};
    Beside beside_;
};

}  // namespace spindrift
