#pragma once
// All that the front end sees of the physics: some functions, no templates, no CUDA.
#include "core/pass_time.h"
#include "core/vec.h"
#include "core/vertex.h"
#include "scene/scene.h"
#include "sim/object_driver.h"
#include "sim/run_state.h"
#include "sim/solid_motion.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

// One row of the plan, in the order of the step: a pass or a term of one, "forces: laminar
// viscosity". It runs, or this scene doesn't need it, and why not.
struct PlanRow {
    std::string name, skipped;
};

// Where the values of the vertices lie, a few outliers on either side left out (0.5 % each): what a
// colour scale needs.
struct Range {
    float min, max;
};

// What fluid does to a solid, and where it is. N and N m; in two dimensions per metre of depth.
struct SolidMeasurement {
    std::string name;                   // the scene's, or solid0, solid1, ...
    Vec3d position;                     // m, of its middle, world coordinates
    Vec3d velocity, spin;               // m/s, of its middle; rad/s
    Vec3d pressureForce, viscousForce;  // N
    Vec3d torque;                       // N m, about its middle
};

// What fluid does to a face of the domain. N, in two dimensions per metre of depth.
struct FaceMeasurement {
    std::string name;  // x_min, x_max, ...
    Vec3d pressureForce, viscousForce;
};

// Where energy came from and went to since the beginning of the run, J
// (sim/parts/energy_balance.h).
struct EnergyMeasurement {
    double compression = 0;  // stored now
    // Work done on the fluid by gravity and the pull to the centre, by walls and solids that move,
    // by the mouse, and by all other forces: resistance, mixing, surface tension, contact.
    double gravityWork = 0, wallWork = 0, stirWork = 0, otherWork = 0;
    // Dissipated by each; by walls: what their own pressure takes, which nothing stores.
    double viscosity = 0, artificialViscosity = 0, diffusion = 0, shifting = 0, wallPressure = 0;
    double unexplained = 0;  // what is there more than all that says; below 0: less
};

// Where a solid is: its middle, m from the domain's lower corner, and its axes, of length 1.
struct SolidPose {
    Vec3d middle, axis[3];
};

// What the incompressible formulation's pressures took in the last step.
struct SolveReport {
    int iterations = 0;
    double error = 0;      // of density in the step, mean, share of the rest density
    double allowed = 0;    // with which iterations end
    int64_t failures = 0;  // steps of the run whose pressures were not found
    int64_t rough = 0;     // and those whose long waves of pressure were not
};

// What a run says of itself. Energies in J, momentum in kg m/s, in two dimensions per metre of
// depth; lengths in m; sums in double precision.
struct Measurement {
    int dimensions = 3;
    double time = 0;         // s
    double dt = 0;           // s, the last step
    double longestStep = 0;  // s, what that could have been if the run had nowhere to stop
    int64_t steps = 0;
    double evaluations = 0;       // of a particle's forces, all together
    double kineticEnergy = 0;     // sum m v^2 / 2
    double potentialEnergy = 0;   // -sum m g.x, zero at the domain's lower corner
    Vec3d momentum;               // sum m v
    Vec3d angularMomentum;        // sum m (x - c) x v, c the middle of the domain
    Vec3d centerOfMass;           // world coordinates
    double meanDensity = 0;       // kg/m³
    double densityError = 0;      // mean of max(rho/rho0 - 1, 0): compression only
    double maxDensityError = 0;   // largest rho/rho0 - 1
    double maxSpeed = 0;          // m/s
    double soundSpeed = 0;        // m/s, of the equation of state
    bool solvesPressure = false;  // the formulation does, as `solve` reports
    SolveReport solve;
    bool comesAndGoes = false;                       // fluid does, as these say:
    double massIn = 0, massOut = 0, massMissed = 0;  // kg since the beginning, that came, that
                                                     // left, that could not come for want of room
    std::vector<SolidMeasurement> solids;            // one for each of the scene's
    std::vector<FaceMeasurement> faces;  // of the domain that are walls, where they are asked for
    std::optional<EnergyMeasurement> energy;  // where it is asked for
    bool finite = true;                       // no NaN or infinity in position, velocity, density
};

// One particle as the picker and tests see it. Position in world coordinates.
struct Particle {
    int id = -1;
    Vec3d position, velocity, acceleration;
    double density = 0, pressure = 0;
};

// A sphere of fluid that the mouse drags along, or pulls to its middle. World coordinates; off when
// radius is 0.
struct Stir {
    Vec3 center;
    float radius = 0;  // m
    Vec3 velocity;     // m/s
    float rate = 30;   // 1/s, at which fluid takes over its velocity
    float pull = 0;    // 1/s: velocity towards the middle for each metre from it; negative: away
    // The most that it gives to fluid, m/s.
    double speed() const { return length(velocity) + std::abs(pull) * radius; }
};

// A run in three interfaces: what moves it on, what it says of itself, and what it costs. A
// function takes the one that it needs.
class Steppable {
public:
    virtual ~Steppable() = default;

    // Advances by `count` time steps.
    virtual void step(int count = 1) = 0;
    // Steps from now on end at this time (s) exactly instead of reaching beyond it, if they aren't
    // of fixed length.
    virtual void stopAt(double time) = 0;
    // A GPU steps while the program goes on: returns when it is done.
    virtual void wait() = 0;
    // Takes over live knobs (schema.h says which); restart knobs must be unchanged.
    virtual void apply(const Scene&) = 0;
    virtual void stir(const Stir&) = 0;
    // Until the next call the solid is pulled to where the mouse wants it, whatever moves it
    // otherwise; none: let go. In local steps that is refused. Throws Error (Usage) where there is
    // no such solid.
    virtual void hold(const Hold&) = 0;
    // From now on another engine moves the elastic objects (object_driver.h); null: they move by
    // themselves again. Not owned. Throws Error (Usage) where there are none, or its interval is
    // not positive.
    virtual void drive(ObjectDriver*) = 0;
    // Goes on from a state of this run. Particles are then in the order, and neighbour lists of the
    // age, that a new simulation of this state has: both go on with the same bits. Throws Error
    // (Usage) where it has another number of particles.
    virtual void restart(const RunState&) = 0;
};

class Readable {
public:
    virtual ~Readable() = default;

    // Of fluid and of boundary particles. Fluid particles have ids [0, fluidCount); where they come
    // and go (sources, sinks) it is how many there are now, whose ids rise and are never used
    // again.
    virtual int fluidCount() = 0;
    virtual int wallCount() const = 0;
    // The first of the boundary particles belong to solids.
    virtual int solidParticleCount() const = 0;
    // Of elastic objects, in the order of sampleObjects().
    virtual int objectParticleCount() const = 0;

    // What it comes to, which takes a look at all particles; and the time alone.
    virtual Measurement measure() = 0;
    virtual StepState clock() = 0;
    // Whether it has come to this time (s), but for rounding. A GPU is waited for only where it may
    // have.
    virtual bool hasReached(double time) = 0;
    // All fluid particles, in the order of their ids; one of them by its id, nothing where there
    // is none; the same, Error (Usage) where there is none.
    virtual std::vector<Particle> particles() = 0;
    virtual std::optional<Particle> find(int id) = 0;
    virtual Particle particle(int id) = 0;
    // Where each of the scene's solids is now.
    virtual std::vector<SolidPose> solidPoses() = 0;
    // The solid whose surface is within a spacing of a point (m, world coordinates), or -1.
    virtual int solidAt(Vec3d point) = 0;
    // Where the run stands: makeSimulation(scene, state) goes on from there, on any device.
    virtual RunState state() = 0;

    // Fills out[id] for every fluid particle, where they come and go the first fluidCount in an
    // order of their own, and then for the first `walls` of the boundary particles; those of
    // objects follow. `out` must hold fluidCount + walls + objectParticleCount vertices; memory of
    // cudaDevice() is written by a kernel, host memory of a GPU run by one copy. Returns the range
    // of the fluid's values. Boundary value: 1 of a solid, 0 of the domain's walls, of objects 2 +
    // their radius / that of a fluid particle.
    virtual Range writeVertices(VertexMemory out, ColorBy, int walls) = 0;
    // The number of the CUDA device that steps, or hostMemory (-1); and the cudaStream_t that its
    // work is on, or null.
    virtual int cudaDevice() const = 0;
    virtual void* cudaStream() const = 0;
};

class Profiled {
public:
    virtual ~Profiled() = default;

    // "CPU, 2 threads, AVX-512, float"
    virtual std::string deviceName() const = 0;
    virtual std::vector<PlanRow> plan() const = 0;
    // Time of each pass since the last resetTimes(). A CPU measures every step, a GPU the first
    // step after resetTimes().
    virtual std::vector<PassTime> times() = 0;
    virtual void resetTimes() = 0;
    // Advances by `count` steps and returns the ms that each took: by the clock, on a GPU by events
    // on its stream.
    virtual std::vector<double> timeSteps(int count) = 0;
    // Of different fluid particles, in the last step, each once for what it gives to both; 0 where
    // there are no lists.
    virtual PairsSeen pairsSeen() = 0;
    // Memory that particles, cells and neighbour lists take on the device.
    virtual int64_t bytes() const = 0;
};

class Simulation : public Steppable, public Readable, public Profiled {};

// Chooses the backend by scene.compute, builds the particles, or goes on from a state. Throws Error
// (NoDevice, Memory, Scene).
std::unique_ptr<Simulation> makeSimulation(const Scene&);
std::unique_ptr<Simulation> makeSimulation(const Scene&, const RunState&);
// Why this scene can't run on a GPU, in one line; "" when it can. And why not on any, however good.
std::string whyNoGpu(const Scene&);
std::string whyNotForGpus(const Scene&);

}  // namespace spindrift
