#pragma once
// What is true of each formulation, in one table: code that depends on what a scene's formulation
// does asks here, and a new formulation is a line.
#include "scene/scene.h"

namespace spindrift {

struct FormulationFacts {
    Formulation formulation;
    bool carriesDensity = false;  // by the continuity equation, step by step; else summed up anew
    bool shifts = false;          // particles move a little beside the fluid, to stay evenly spread
    bool fillsSpace = false;      // fluid has no free surface
    bool takesOthers = false;     // artificial viscosity, mixing, resistance
    bool takesObjects = false;    // elastic ones
    bool meansPressure = false;   // there is another form of pressure: simulation.pressure_form
    bool splits = false;          // a step may be split into that of viscosity and of pressure
    bool takesFluids = false;     // more than one
    bool takesTension = false;    // surface tension
    bool airResists = false;      // surface particles are known by their summed density
    bool solvesPressure = false;  // for densities that stay; else pressure follows from density
    bool isHistorical = false;    // the original program's: its masses, walls without pressure, a
                                  // limit of acceleration, and nothing that it did not have
};

inline constexpr FormulationFacts formulations[] = {
    {.formulation = Formulation::Wcsph,
     .takesOthers = true,
     .takesObjects = true,
     .meansPressure = true,
     .takesFluids = true,
     .airResists = true},
    {.formulation = Formulation::DeltaSph,
     .carriesDensity = true,
     .takesOthers = true,
     .takesObjects = true,
     .splits = true,
     .takesFluids = true},
    {.formulation = Formulation::DeltaPlus,
     .carriesDensity = true,
     .shifts = true,
     .takesOthers = true,
     .takesObjects = true,
     .takesTension = true},
    {.formulation = Formulation::TransportVelocity,
     .carriesDensity = true,
     .shifts = true,
     .fillsSpace = true},
    {.formulation = Formulation::Classic, .isHistorical = true},
    {.formulation = Formulation::Incompressible,
     .takesOthers = true,
     .airResists = true,
     .solvesPressure = true},
};

constexpr const FormulationFacts& factsOf(Formulation f) { return formulations[int(f)]; }
static_assert(factsOf(Formulation::DeltaSph).formulation == Formulation::DeltaSph &&
                  factsOf(Formulation::Incompressible).solvesPressure,
              "the table is in the order of the enumeration");
inline const FormulationFacts& factsOf(const Scene& s) { return factsOf(s.simulation.formulation); }

}  // namespace spindrift
