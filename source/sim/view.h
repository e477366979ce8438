// What a pass sees: raw pointers and the constants of a step, passed by value to every device.
#if defined(SPINDRIFT_SIM_VIEW_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_VIEW_H
#undef SPINDRIFT_SIM_VIEW_H
#else
#define SPINDRIFT_SIM_VIEW_H
#endif

#include "core/lanes.h"
#include "core/vec.h"
#include "sim/step_state.h"

#include <cstdint>

namespace spindrift::LANES {

// Particles of one kind, sorted by cell. A slot with id -1 holds nobody: it fills a row of cells up to whole
// clusters and lies far outside, so that no pair with it counts.
struct Particles {
    int slots;
    int* id;
    VectorField position;          // m, relative to the domain's lower corner
    VectorField velocity;          // m/s
    VectorField acceleration;      // m/s^2
    ScalarField density;           // kg/m^3
    ScalarField inverseDensity;    // m^3/kg
    ScalarField pressureTerm;      // p / rho^2
    ScalarField mass;              // boundary particles only (Akinci 2012): m_b / m
};

// Cells are thin along x and a few particles wide along y and z: a row of cells is one stretch of memory.
struct Grid {
    Vector<real> low;              // m, corner of the first cell
    real perMetreX, perMetreRow;   // cells per metre along x, and along y and z
    Int3 cells;
    HD static int clamped(real cell, int n) { return !(cell > 0) ? 0 : cell >= real(n) ? n - 1 : int(cell); }
    HD int cellX(real x) const { return clamped((x - low.x) * perMetreX, cells.x); }
    HD int rowY(real y) const { return clamped((y - low.y) * perMetreRow, cells.y); }
    HD int rowZ(real z) const { return clamped((z - low.z) * perMetreRow, cells.z); }
    HD int cell(Vector<real> x) const { return (rowZ(x.z) * cells.y + rowY(x.y)) * cells.x + cellX(x.x); }
};

// The clusters of another set that may hold neighbours of one cluster (SIMD lanes only): all that are near enough for the
// life of the list, and of these the ones with a neighbour in this step.
struct ClusterList {
    const uint32_t* clusters;
    uint32_t* pruned;
    uint32_t count, prunedCount;
};

// Where the neighbours of one set's particles are found in another set (or in their own).
struct Neighbourhood {
    ClusterList* lists;            // per cluster of the set; null without SIMD
    const int* cellStart;          // of the other set; slots [cellStart[c], cellStart[c+1]) are in cell c
    VectorField position;          // of the other set
};

struct Constants {
    real support, support2, inverseSupport2;      // R, R^2, 1/R^2
    real kernelScale, gradientScale;              // m norm/R^3, m gradientNorm/R^5, m the mass in sums
    real selfWeight;                              // 1: a particle counts itself in its density; 0: not
    real wallFactor, wallMassFloor;               // boundary mass m_b = wallFactor rho0 / sum W; floor in units of m
    real restDensity;                             // kg/m^3
    real stiffness; int gamma;                    // p = k ((rho/rho0)^gamma - 1), Pa
    real laminar;                                 // 2 mu, Pa s
    real artificial;                              // alpha c h / 2, m^2/s
    real classicViscosity;                        // nu m / (rho0 pi R^5) in units of gradientScale
    real eta2;                                    // 0.01 h^2, keeps 1/d^2 finite
    real accelerationLimit;                       // m/s^2
    Vector<real> gravity;                         // m/s^2
    Vector<real> low, high;                       // m, the box that positions stay in
    real restitution, friction;
    real soundSpeed, cfl, maxStep, fixedStep, viscousStep;
    Vector<real> stirCenter, stirVelocity;
    real stirRadius;
};

struct View {
    Particles fluid, walls;
    Neighbourhood fluidNearFluid, wallsNearFluid, fluidNearWalls, wallsNearWalls;
    Grid grid;
    Constants c;
    StepState* state;
};

}  // namespace spindrift::LANES

#endif
