// What a pass sees: raw pointers and the constants of a step, passed by value to every device.
#pragma once

#include "core/lanes.h"
#include "core/vec.h"
#include "scene/convex.h"
#include "sim/step_state.h"

#include <cstdint>

namespace spindrift {
enum class Kernel;
}
namespace spindrift::LANES {

// Particles of one kind, sorted by cell. A slot with id -1 holds none: it fills a row of cells up
// to whole clusters and lies far outside, so that no pair with it counts.
struct Particles {
    int slots;
    int* id;
    VectorField position;      // m, relative to the domain's lower corner
    VectorField velocity;      // m/s; of boundary particles the one that makes fluid stick to them,
                               // where it does
    VectorField acceleration;  // m/s²
    VectorField addedForce;    // sums of pairs for what comes on top, in units of gradientScale;
                               // where there is any
    VectorField normal;  // of the surface, inward, of length 1, or 0 where there is none; with
                         // surface tension
    ScalarField normalLength;  // 1/m, |sum_j V grad W|
    ScalarField density;  // kg/m³; of boundary particles only where density gradients are wanted
    ScalarField inverseDensity;  // m^3/kg
    ScalarField viscousVolume;   // m^3/kg, 1/rho as viscosity along lines of pairs counts it: more
                                 // where neighbours are missing, if that is found out
    ScalarField pressureOverRho2;  // p / rho^2
    ScalarField mass;              // boundary particles only (Akinci 2012): m_b / m
    VectorField outward;  // m, boundary particles only: from the nearest point of their surface,
                          // where fluid sticks to it
    VectorField ownVelocity;  // m/s, boundary particles only: of the wall itself, where any moves
    VectorField ownAcceleration;  // m/s², the same, where any may accelerate
    ScalarField slip;           // m, of boundary particles where any wall lets fluid slip: Navier's
                                // length; negative of the domain's faces, across which velocities
                                // are components
    VectorField slipVelocity;   // m/s, and of the fluid at their surface
    VectorField flowVelocity;   // m/s, and with which the flow there goes on into the wall, for its
                                // divergence
    ScalarField densityRate;    // kg/(m^3 s), where density is carried
    VectorField shiftVelocity;  // m/s, where particles are shifted: how much faster than the fluid
                                // they move,
    VectorField
        shiftAcceleration;  // m/s², and what a particle's velocity changes by for being elsewhere
    VectorField pressureAcceleration;  // m/s², where pressures are solved for; and what solving
                                       // needs (solver/pressure_passes.h):
    VectorField wallGradient;          // kg/m^4, sum_b m_b grad W
    ScalarField diagonal;              // kg^2/m^8, of the operator
    ScalarField mirrored;              // share of a particle's pressure that walls beside it have
    ScalarField lastPressure;          // as pressureOverRho2, an iteration ago
    ScalarField triedPressure;         // as pressureOverRho2, that pressureAcceleration is of
    ScalarField fluidWeight;           // sum of W over the fluid alone
    ScalarField source, residual;      // share of rho0 that densities would grow by in the step,
                                       // without pressures, and what is left of it
    VectorField keptPosition;  // m, what the integrator keeps while forces are evaluated elsewhere;
                               // with solids, after the drift, where its way began
    VectorField keptVelocity;  // m/s
    ScalarField keptDensity;   // kg/m³
    ScalarField massRatio;     // of a mixture: rest density / the scene's. Density and what follows
                               // from it are those of the same particle of the scene's fluid, which
                               // has its volume and pressure; forces are divided by the ratio
    ScalarField viscosity;     // of a mixture, Pa s
    ScalarField heldBy;        // where particles come and go: the source's point, from 1 on, before
                               // whose mouth it is still held, or 0
    ScalarField timeBin;       // local steps only: how short a particle's own step is, longest /
                               // 2^level, or how it rests
    uint8_t* active;           // local steps only: per cluster, whether it is evaluated now
};

// The time bin of a particle that rests.
inline constexpr real resting = -1;
// What clusters are. Sleeping: all of it. Near: not active, but maybe a neighbour of one that is.
// SleepingHalo: near and resting, so that its density goes with its neighbours' places as a wall's
// would; with a pressure of its own it would push them without an end.
enum : uint8_t { Sleeping, Inactive, NearActive, SleepingHalo, Active };

template <uint8_t from = Active, class I> HD inline bool isActive(const Particles& p, I i) {
    return !p.active || p.active[firstOf(i) / clusterSize] >= from;
}

// Cells are thin along x and a few particles wide along y and z: a row of cells is one stretch of
// memory.
struct Grid {
    Vector<real> low;       // m, corner of the first cell
    Vector<real> perMetre;  // cells per metre
    Int3 cells;
    Int3 wraps;  // 1 along a periodic axis
    HD static int clamped(real cell, int n) {
        return !(cell > 0) ? 0 : cell >= real(n) ? n - 1 : int(cell);
    }
    // Along a periodic axis an index beyond the grid is an image of the cell at wrapped(index).
    HD static int index(real cell, int n, int wraps) {
        if (!wraps || !(cell > real(-n) && cell < real(2 * n))) return clamped(cell, n);
        return cell < 0 ? -1 - int(-cell) : int(cell);
    }
    HD static int wrapped(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }
    HD int cellX(real x) const { return index((x - low.x) * perMetre.x, cells.x, wraps.x); }
    HD int rowY(real y) const { return index((y - low.y) * perMetre.y, cells.y, wraps.y); }
    HD int rowZ(real z) const { return index((z - low.z) * perMetre.z, cells.z, wraps.z); }
    // Of the row at (y, z), which may be an image, the number of its first cell.
    HD int row(int y, int z) const {
        return (wrapped(z, cells.z) * cells.y + wrapped(y, cells.y)) * cells.x;
    }
    HD int cell(Vector<real> x) const {
        return (clamped((x.z - low.z) * perMetre.z, cells.z) * cells.y +
                clamped((x.y - low.y) * perMetre.y, cells.y)) *
                   cells.x +
               clamped((x.x - low.x) * perMetre.x, cells.x);
    }
};

// Calls f(first, last) for the stretches of cells of one row that [first, last] stands for: two of
// them where it reaches over the end of a periodic row, never a cell twice.
template <class F> HD inline void forStretches(int first, int last, int n, const F& f) {
    int beyond = -1;  // where the stretch ends that goes on from cell 0
    if (last - first + 1 >= n) first = 0, last = n - 1;
    if (first < 0) first += n, last += n;
    if (last >= n) beyond = last - n, last = n - 1;
    // One call, so that f is inlined once.
    for (int k = beyond < 0; k < 2; ++k) f(k ? first : 0, k ? last : beyond);
}

// What the squared distances (in support radii) of a cluster's pairs with another one grow by,
// particle by particle of the one: 0 where they see each other (screens.h).
struct PairsApart {
    float of[clusterSize * clusterSize];
};

// The clusters of another set that may hold neighbours of one cluster (SIMD lanes only): all that
// are near enough for the life of the list, and of these the ones with a neighbour in this step.
// Beside thin solids the last ones of both have pairs that do not see all of each other.
struct ClusterList {
    const uint32_t* clusters;
    uint32_t* inner;
    uint32_t count, innerCount;
    uint32_t clear, innerClear;  // how many come first of which all pairs see each other
    const PairsApart* apart;
    PairsApart* innerApart;
    const PairsApart* within = nullptr;  // of the cluster with itself, where lists hold each pair
                                         // once; null: all see each other
};

// Whose pairs thin solids may separate.
enum class Between { Nobody, Fluid, FluidAndWalls, WallsAndFluid };

// Where the neighbours of one set's particles are found in another set (or in their own).
struct Neighbourhood {
    ClusterList* lists;    // per cluster of the set; null without SIMD
    const int* cellStart;  // of the other set; slots [cellStart[c], cellStart[c+1]) are in cell c
    VectorField position;  // of the other set
    Between between = Between::Nobody;
};

// Cubes of cells, for local steps. What is known of each:
struct Blocks {
    Int3 count, size;  // along each axis, in cells; the last ones are larger
    real* speed2;      // (m/s)^2, mean at the last decision of what rests
    int* calm;         // decisions for which nothing has happened around
    int* sleepLength;  // and after how many it wakes for a look
    uint8_t *active,
        *near;  // whether it has an active particle; what its clusters are that have none
};

inline Vector<real> toVector(Vec3 a) { return {real(a.x), real(a.y), real(a.z)}; }

struct StepParameters {
    Kernel kernel;
    real support, support2, inverseSupport2;  // R, R^2, 1/R^2
    real kernelScale, gradientScale;          // m norm/R^3, m gradientNorm/R^5, m the mass in sums
    real selfWeight;                          // 1: a particle counts itself in its density; 0: not
    real wallFactor,
        wallMassFloor;  // boundary mass m_b = wallFactor rho0 / sum W; floor in units of m
    real restDensity;   // kg/m³
    real stiffness;
    int gamma;                // p = p0 + k ((rho/rho0)^gamma - 1), Pa
    real backgroundPressure;  // p0, Pa
    real leastPressure;       // Pa
    real diffusion;           // 2 delta h c, m^2/s, of carried density
    int dimensions;
    real flatMoment;         // what makes moments in two dimensions invertible: 1, otherwise 0
    bool isViscous;          // laminar viscosity acts
    real eta2;               // 0.01 h^2, keeps 1/d^2 finite
    real accelerationLimit;  // m/s²
    Vector<real> gravity;    // m/s²
    real gravityRate;        // 1/s, how fast it grows from 0; 0: it is there at once
    real centralPull;        // 1/s^2, Omega^2 of -Omega^2 (x - center)
    Vector<real> center;     // m
    Vector<real> slidesBelow, slidesAbove;  // m: boundary particles below or above these slide with
    Vector<real> slideVelocity;             // m/s
    Vector<real> slipBelow, slipAbove;      // m, Navier's lengths of the faces at 0 and at the end
    real rateAhead;   // steps, from the places of which the rate of density is to those it is for
    real solidSpeed;  // m/s, the most that any solid reaches
    real gap;         // m: what a solid stopped is so far off, which is more than rounding
    Vector<real> low, high;              // m, the box that positions stay in
    Vector<real> period, inversePeriod;  // m, 1/m, of periodic axes; 0 for the others
    bool periodic;                       // any of them
    real restitution, friction;
    real soundSpeed, fastestSound;  // m/s, of the scene's rest density, and of the lightest fluid
    real leastSpeed;                // m/s: no slower is anything to steps that the flow bounds
    real cfl, fixedStep;
    real maxStep;    // s, what is asked for and what forces but pressure allow
    real restSpeed;  // below that share of the speed of sound fluid may rest, 0: nothing rests
};

// What the mouse does to fluid (Stir), relative to the domain's lower corner: in memory of the
// device, so that it changes without another plan or recording.
struct Stirring {
    Vector<real> center, velocity;  // m, m/s
    real radius, rate, pull;        // m, 1/s, 1/s
};

// A solid now. Its shape is convex (scene/convex.h), in its own axes and relative to its middle;
// that of a mesh is a field of distances in its bounding box.
struct SolidState {
    Vector<real> home,
        middle;  // m, relative to the domain's lower corner: at its place in the scene, now
    Vector<real> velocity, spin;          // m/s, rad/s
    Vector<real> acceleration, spinRate;  // m/s², rad/s^2, of its middle and of the spin
    Vector<real> axis[3];                 // its own axes in space
    int firstKey, endKey;                 // of its motion
    bool steady;                          // which goes on and on
    int spinAxis;
    int planes;
    Vector<real> normal[Convex::mostPlanes];
    real offset[Convex::mostPlanes];
    real radius;
    real slip;  // m, Navier's length
    Vector<real> across;
    real reach;  // m, from its middle to its farthest point
    real grace;  // m, 0: it is not thin; otherwise what goes no deeper into it does not cross it
    real beyond[Convex::mostPlanes];  // m, of one that is thin: how much further it separates,
                                      // where it stands on the domain's wall
    bool joined[Convex::mostPlanes];  // whether another solid goes on there
    bool hides;                       // fluid on its sides would see each other
    int plate;                        // which plane is a face of it, the next one the other; or -1
    Vector<real> centreOfMass;        // m, of one that floats
    real speed;  // m/s, the most of its points, of one that floats or is dragged; otherwise 0: the
                 // scene knows it
    Vector<real> middleBefore, axisBefore[3];  // where the step began, for collisions,
    Vector<real> turn;                         // rad, and how it has turned since, in its own axes
    const real*
        field;  // m from the surface at the nodes of a lattice, x first; null: there is none
    Vector<real> fieldLow;  // m, its first node
    real nodesPerMetre;
    Int3 nodes;
};

// Thin solids, which hide from each other what is on their sides.
struct Screens {
    const SolidState* solids;
    const int* thin;  // which of them
    int count;
    StepParameters c;
    int firstId;  // below, of boundary particles by their ids from that one on:
    const int* solidOf;
    VectorField face;   // m, of a thin solid's particles: from its face to it, in its own axes
    ScalarField least;  // m^2: it is seen from where that is further along `face` than itself
    real spacing;       // m
};

struct View {
    Particles fluid, walls;
    SolidState* solids;
    int solidCount;
    Neighbourhood fluidNearFluid, wallsNearFluid, fluidNearWalls, wallsNearWalls;
    Grid grid;
    StepParameters c;
    StepState* state;
    const Stirring* stirring;
    Blocks blocks;
    const Screens* screens;  // null: no solid is thin
};

// m/s², at the run's time, which is on the device: a recorded step needs no new constants while it
// grows. Passes ask outside of their loops: a branch among their sums would keep the compiler from
// fusing multiplications with additions, and change bits.
HD inline Vector<real> gravityNow(const View& v) {
    if (v.c.gravityRate <= 0) return v.c.gravity;
    const real s = min(real(v.state->time) * v.c.gravityRate, real(1)),
               share = s * s * (real(3) - real(2) * s);
    return {share * v.c.gravity.x, share * v.c.gravity.y, share * v.c.gravity.z};
}

// What pulls at every particle, m/s².
template <class R>
HD inline Vector<R> bodyForce(const StepParameters& c, Vector<real> gravityNow, Vector<R> x) {
    const Vector<R> gravity{gravityNow.x, gravityNow.y, gravityNow.z},
        center{c.center.x, c.center.y, c.center.z};
    return subtractScaled(gravity, R(c.centralPull), x - center);
}

// What fluids weigh in comparison to the scene's.
template <class I> HD inline Real<I> massRatio(const Particles& fluid, I i) {
    return fluid.massRatio.data ? load(fluid.massRatio, i) : Real<I>(1);
}

// Of a boundary particle's wall itself, m/s.
template <class I> HD inline Vector<Real<I>> ownVelocity(const Particles& walls, I b) {
    using R = Real<I>;
    return walls.ownVelocity.data ? load(walls.ownVelocity, b) : Vector<R>{R(0), R(0), R(0)};
}
// And its acceleration, m/s².
template <class I> HD inline Vector<Real<I>> ownAcceleration(const Particles& walls, I b) {
    using R = Real<I>;
    return walls.ownAcceleration.data ? load(walls.ownAcceleration, b)
                                      : Vector<R>{R(0), R(0), R(0)};
}
// Its velocity, along the wall that of the fluid at its surface, where that may slip.
template <class I> HD inline Vector<Real<I>> surfaceVelocity(const Particles& walls, I b) {
    return walls.slipVelocity.data ? load(walls.slipVelocity, b) : ownVelocity(walls, b);
}

// And with which its divergence sees them.
template <class I> HD inline Vector<Real<I>> flowVelocity(const Particles& walls, I b) {
    return walls.flowVelocity.data ? load(walls.flowVelocity, b) : ownVelocity(walls, b);
}

// Of the domain's walls at one of their particles, m/s.
template <class R> HD inline Vector<R> wallVelocity(const StepParameters& c, Vector<R> x) {
    const R zero = 0, one = 1;
    auto slides = [&](R at, real below, real above) LANE_CALL {
        return max(select(at < R(below), one, zero), select(at > R(above), one, zero));
    };
    const R share = max(slides(x.x, c.slidesBelow.x, c.slidesAbove.x),
                        max(slides(x.y, c.slidesBelow.y, c.slidesAbove.y),
                            slides(x.z, c.slidesBelow.z, c.slidesAbove.z)));
    return share * Vector<R>{c.slideVelocity.x, c.slideVelocity.y, c.slideVelocity.z};
}

}  // namespace spindrift::LANES
