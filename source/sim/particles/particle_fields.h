// Every field that particles may have: where a View shows it, when a set of particles holds it, and
// when it goes along as they are put in order. A new field is a line here and a member of
// Particles.
#pragma once

#include "sim/particles/view.h"

namespace spindrift::LANES {

enum class Kind { Fluid, Walls, Objects };  // of objects just places: the rest is elsewhere

// What a set of particles is to hold.
struct Holdings {
    Kind kind;
    bool velocity;     // of boundary particles: fluid sticks to them
    bool density;      // of boundary particles: its gradient is wanted
    bool densityRate;  // density goes from step to step with a rate, instead of being summed up
    bool shifts;       // particles leave the fluid's paths a little
    bool moves, accelerates;  // boundary particles that do
    bool slips;               // boundary particles along which fluid may slip
    bool continues;           // boundary particles into which the flow goes on, for its divergence
    bool keepsVelocity, keepsState, keepsPlace;  // while forces are evaluated elsewhere
    bool timeBins;                               // particles have steps of their own
    bool addsPairs, normals;  // sums for forces on top of the others; normals of the surface
    bool mixture;             // more than one fluid
    bool comesAndGoes;        // particles do, while the run goes on
    bool viscousVolume;
    bool solvesPressure;  // of the fluid: pressures go from step to step, and what solving needs

    bool isFluid() const { return kind == Kind::Fluid; }
    bool isWalls() const { return kind == Kind::Walls; }
    bool isActiveInBins() const { return timeBins && isFluid(); }
};

struct ParticleField {
    const char* name;
    VectorField Particles::*vector;  // one of the two, the other is null
    ScalarField Particles::*scalar;
    bool (*held)(const Holdings&);
    bool (*sorted)(const Holdings&);
    real empty;  // in slots that hold no particle; positions are far away there

    constexpr bool isVector() const { return vector != nullptr; }
    constexpr bool isPosition() const {
        return vector == &Particles::position || vector == &Particles::keptPosition;
    }
};

#define SPINDRIFT_WHEN(condition) [](const Holdings& h) -> bool { return (void)h, condition; }
#define SPINDRIFT_VECTOR(name, held, sorted) \
    { #name, &Particles::name, nullptr, SPINDRIFT_WHEN(held), SPINDRIFT_WHEN(sorted), 0 }
#define SPINDRIFT_SCALAR(name, held, sorted, empty) \
    { #name, nullptr, &Particles::name, SPINDRIFT_WHEN(held), SPINDRIFT_WHEN(sorted), empty }

inline constexpr ParticleField particleFields[] = {
    SPINDRIFT_VECTOR(position, true, true),
    SPINDRIFT_VECTOR(velocity, h.velocity, h.isFluid()),
    SPINDRIFT_VECTOR(acceleration, h.isFluid(), h.isActiveInBins()),
    SPINDRIFT_SCALAR(pressureOverRho2, h.kind != Kind::Objects, h.solvesPressure, 0),
    SPINDRIFT_SCALAR(density, h.density, h.densityRate || h.isActiveInBins(), 0),
    SPINDRIFT_SCALAR(densityRate, h.densityRate, h.densityRate&& h.isActiveInBins(), 0),
    SPINDRIFT_SCALAR(inverseDensity, h.isFluid(), false, 0),
    SPINDRIFT_SCALAR(viscousVolume, h.isFluid() && h.viscousVolume, false, 0),
    SPINDRIFT_VECTOR(shiftVelocity, h.isFluid() && h.shifts, false),
    SPINDRIFT_VECTOR(shiftAcceleration, h.isFluid() && h.shifts, false),
    SPINDRIFT_VECTOR(addedForce, h.isFluid() && h.addsPairs, false),
    SPINDRIFT_VECTOR(normal, h.isFluid() && h.normals, false),
    SPINDRIFT_SCALAR(normalLength, h.isFluid() && h.normals, false, 0),
    SPINDRIFT_VECTOR(pressureAcceleration, h.solvesPressure, false),
    SPINDRIFT_VECTOR(wallGradient, h.solvesPressure, false),
    SPINDRIFT_SCALAR(diagonal, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(mirrored, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(lastPressure, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(triedPressure, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(fluidWeight, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(source, h.solvesPressure, false, 0),
    SPINDRIFT_SCALAR(residual, h.solvesPressure, false, 0),
    SPINDRIFT_VECTOR(keptPosition, h.isFluid() && (h.keepsState || h.keepsPlace),
                     h.keepsState || h.keepsPlace),
    SPINDRIFT_VECTOR(keptVelocity, h.isFluid() && h.keepsVelocity, h.keepsVelocity),
    SPINDRIFT_SCALAR(keptDensity, h.isFluid() && h.keepsState && h.densityRate,
                     h.keepsState&& h.densityRate, 0),
    SPINDRIFT_SCALAR(massRatio, h.mixture, h.mixture, 1),
    SPINDRIFT_SCALAR(viscosity, h.mixture, h.mixture, 0),
    SPINDRIFT_SCALAR(heldBy, h.comesAndGoes, h.comesAndGoes, 0),
    SPINDRIFT_SCALAR(timeBin, h.isActiveInBins(), h.isActiveInBins(), resting),
    SPINDRIFT_SCALAR(mass, h.isWalls(), false, 0),
    SPINDRIFT_VECTOR(outward, h.isWalls() && (h.velocity || h.continues), false),
    SPINDRIFT_VECTOR(ownVelocity, h.isWalls() && h.moves, false),
    SPINDRIFT_VECTOR(ownAcceleration, h.isWalls() && h.accelerates, false),
    SPINDRIFT_VECTOR(flowVelocity, h.isWalls() && h.continues, false),
    SPINDRIFT_SCALAR(slip, h.isWalls() && (h.slips || h.continues), false, 0),
    SPINDRIFT_VECTOR(slipVelocity, h.isWalls() && h.slips, false),
};

#undef SPINDRIFT_WHEN
#undef SPINDRIFT_VECTOR
#undef SPINDRIFT_SCALAR

}  // namespace spindrift::LANES
