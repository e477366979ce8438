#pragma once
// What a run carries from step to step of where energy came from and went to.

namespace spindrift {

// J since the beginning of the run, in two dimensions per metre of depth.
struct EnergyLedger {
    bool begun = false;
    double start = 0;  // what was there: kinetic, potential and of compression
    // Work done on the fluid, and what was dissipated, as in EnergyMeasurement.
    double gravity = 0, walls = 0, stirred = 0, others = 0;
    double viscosity = 0, artificial = 0, diffusion = 0, shifting = 0, wallPressure = 0;
};

}  // namespace spindrift
