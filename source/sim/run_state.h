#pragma once
// What a run carries from step to step, and what its constants were derived from: another device
// that starts from it goes on exactly.
#include "scene/particles.h"
#include "sim/energy_ledger.h"
#include "sim/object_state.h"
#include "sim/solid_motion.h"
#include "sim/step_state.h"

namespace spindrift {

// Of sources and sinks: until when all has come that was due (s), how many particles have come and
// left, how many could not come, and the id from which on those that come are counted; at the
// beginning none.
struct SourceState {
    double time = 0;
    int64_t came = 0, left = 0, missed = 0;
    int firstId = -1;
};

struct RunState {
    Placement particles;  // in the order of their ids
    StepState clock;
    FluidExtent start;
    std::vector<float>
        densities;  // kg/m³, where they are carried; empty at the beginning, when pressures say
    std::vector<float> pressures;     // p / rho^2, Pa m^6/kg^2, where they are solved for; empty at
                                      // the beginning
    std::vector<SolidMotion> solids;  // one for each, where any floats or has been dragged;
                                      // otherwise, and at the beginning, empty
    ObjectState objects;
    EnergyLedger energy;  // where it is asked for
    SourceState sources;

    RunState() = default;
    // The beginning of a run.
    RunState(Placement p) : particles(std::move(p)), start(extentOf(particles)) {}
};

}  // namespace spindrift
