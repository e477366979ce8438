#pragma once
// What to simulate, as plain values in SI units. The default of every knob stands here and nowhere
// else; scene/schema.h gives each its path, unit, range and help.
#include "core/color_map.h"
#include "core/vec.h"

#include <string>
#include <vector>

namespace spindrift {

enum class Backend { Auto, Cpu, Cuda };
enum class Precision { Float, Double };
enum class Simd { Auto, Avx512, Avx2, Sse };
enum class Formulation { Wcsph, DeltaSph, DeltaPlus, TransportVelocity, Classic, Incompressible };
enum class Kernel { WendlandC2, CubicSpline, WendlandC4, WendlandC6, QuinticSpline, Mueller };
enum class PressureForm { Squares, Mean };
enum class ViscosityForm { Auto, Morris, Monaghan };
enum class EquationOfState { Tait, Linear };
enum class WallKind { Reflect, Particles };
enum class TimeMode { Fixed, Cfl, Local };
enum class Integrator { SymplecticEuler, VelocityVerlet, PredictorCorrector, Split };
enum class Shape { Block, Sphere, Cylinder, Wedge, Plane, Mesh, File };
enum class Axis { X, Y, Z };
enum class Up { Auto, X, Y, Z, MinusX, MinusY, MinusZ };
enum class ColorBy {
    Plain,
    Velocity,
    Pressure,
    Density,
    Acceleration,
    Id,
    Fluid,
    Surface,
    VelocityX,
    VelocityY,
    VelocityZ,
    Vorticity,
    ShearRate,
    Divergence,
    Neighbours,
    TimeBin
};
enum class ColorScale { Linear, Logarithmic };
enum class Projection { Perspective, Orthographic };
enum class Across { None, X, Y, Z };
enum class DrawStyle { Spheres, Surface };
enum class Field { Uniform, TaylorGreen, Stretching, Rotation, Shear, SoundWave, StandingWave };
enum class StartPlaces { Lattice, Relaxed };
enum class StartPressure { None, Hydrostatic };
enum class Face { None, XMin, XMax, YMin, YMax, ZMin, ZMax };
enum class RangeMode { Frame, Run, Fixed };
enum class StirMode { Drag, Attract, Repel };
enum class ProbeKind { Point, Line, Height, Front };
enum class Order { Mean, Linear };
enum class ObjectShape { Block, Sheet, Tube, Shell };
enum class Mouth { Rectangle, Disc };
enum class Profile { Uniform, Parabolic };

// A block reads min and max, a wedge too: its ridge runs along z, above the middle of its base. A
// sphere reads center and radius, a cylinder center, radius, height and axis; a mesh, triangles of
// a file, path, scale and offset. A file, of fluid only, has no shape but particles. A plane, of
// solids only, reads center, a point of it, and normal.
struct Form {
    Shape shape = Shape::Block;
    Vec3 min{0, 0, 0}, max{0.5f, 0.5f, 0.5f};  // m
    Vec3 center{0.5f, 0.5f, 0.5f};             // m
    float radius = 0.1f;                       // m
    float height = 0.2f;                       // m
    Axis axis = Axis::Y;
    Vec3 normal{0, 1, 0};   // to the side where fluid is, of any length
    std::string path{};     // of a file, beside the scene file when relative
    float scale = 1;        // m per unit of a mesh's file
    Vec3d offset{0, 0, 0};  // m, where the mesh's origin is; files of surveys have theirs far away
};

// One body of fluid, filled on a lattice, or with the particles of a file as they are.
struct Body : Form {
    Vec3 velocity{0, 0, 0};        // m/s; for a field its amplitude is the length
    Field field = Field::Uniform;  // of velocity at the start
    float restDensity = 0;         // kg/m³ at rest, 0 = the fluid's; other ones make a mixture
    float viscosity = -1;          // Pa s, -1 = the fluid's
    StartPressure pressure = StartPressure::None;  // where a field has its own, that is added
    std::string name{};  // of its fluid, in the legend; "" = by its density
    float mass = 0;      // kg, of a particle of a file; 0 = its column says
    bool relax = false;  // a file's particles are pushed apart until they lie evenly
};

// Where a solid is at one time, relative to its place in the scene: s, m, degrees. Second
// differences of finely sampled motion ask for doubles.
struct Keyframe {
    double time = 0;
    Vec3d offset;
    double turn = 0;
    bool hasRates = false;  // whether it also says how fast the solid is then: m/s, degrees/s
    Vec3d velocity{};
    double spin = 0;
    bool operator==(const Keyframe&) const = default;
};
using Keyframes = std::vector<Keyframe>;

// What something is at one time, s.
struct Rate {
    double time = 0, value = 0;
    bool operator==(const Rate&) const = default;
};
using Rates = std::vector<Rate>;  // in the order of their times

// An obstacle: fluid flows around it. It stands still, goes on and on with `velocity` and `spin`,
// or moves as its keyframes say (scene/motion.h). With a density it floats: that is
// how it moves at the start, and fluid, gravity and what it runs into do the rest.
struct Solid : Form {
    std::string name;         // of its columns in time series; "" = solid0, solid1, ...
    Vec3 velocity{0, 0, 0};   // m/s
    float spin = 0;           // degrees/s
    Axis spinAxis = Axis::Z;  // through its middle; keyframes turn about it too
    float turn = 0;           // degrees about that axis, at the start
    Keyframes keyframes;      // in the order of their times
    std::string motion;       // a CSV that becomes the keyframes when the scene is read
    float density = 0;        // kg/m³ of one that floats, 0 = it moves as prescribed
    float friction =
        0.3f;        // Coulomb's coefficient where one that floats touches walls and other solids
    float slip = 0;  // m, as of walls
    bool floats() const { return density > 0; }
    bool moves() const { return !keyframes.empty() || velocity != Vec3{} || spin != 0 || floats(); }
    // Whether it is where its shape says, for good.
    bool isAsDrawn() const { return !moves() && turn == 0; }
};

// An elastic object: particles on a lattice, and bonds between them that are springs. It meets
// fluid, itself and other objects by contact forces. A block reads min and max, a sheet too: it is
// flat along the axis on which they are the same. A tube, open at both ends, reads center, radius,
// height and axis, a shell, the triangles of a file, path, scale and offset.
struct Object {
    ObjectShape shape = ObjectShape::Block;
    Vec3 min{0, 0, 0}, max{0.5f, 0.5f, 0.5f};  // m
    Vec3 center{0.5f, 0.5f, 0.5f};             // m
    float radius = 0.1f;                       // m, to the middle of the wall
    float height = 0.5f;                       // m
    Axis axis = Axis::X;
    std::string path{};          // of a mesh, beside the scene file when relative
    float scale = 1;             // m per unit of that
    Vec3d offset{0, 0, 0};       // m, of its origin
    float thickness = 0.01f;     // m, of a wall: one layer of particles, or more where a sheet or a
                                 // tube is thicker than a spacing
    float spacing = 0;           // m, of its particles, 0 = simulation.spacing
    float density = 1000;        // kg/m³
    float youngsModulus = 1e5f;  // Pa
    float damping = 0.1f;        // of bonds, share of the critical one
    float breakingStrain = 0;    // at which bonds break, 0 = never
    Vec3 velocity{0, 0, 0};      // m/s, at the start
};

// Holds those of the objects' particles that are in its box at the start: where they are, or it
// moves them as its keyframes say.
struct Grip {
    Vec3 min{0, 0, 0}, max{0.1f, 0.1f, 0.1f};  // m
    Vec3 velocity{0, 0, 0};                    // m/s, with which it goes on and on
    Keyframes keyframes;
};

// A blade: breaks the bonds whose middles are in its box at that time.
struct Cut {
    float time = 0;                            // s
    Vec3 min{0, 0, 0}, max{0.1f, 0.1f, 0.1f};  // m
};

// A tap or an inlet: fluid of the scene comes out of a mouth, along its normal. Just before it, as
// far as a support radius, particles go on in layers with the velocity that is asked for; beyond
// the mouth they are free. A rectangle reads width and height, a disc radius.
struct Source {
    Mouth mouth = Mouth::Rectangle;
    std::string name;               // in messages; "" = sources[0], sources[1], ...
    Vec3 center{0.5f, 0.5f, 0.5f};  // m, of the mouth
    Vec3 normal{0, -1, 0};          // to where the fluid goes, of any length
    float width = 0.1f;             // m, across the normal and the height
    float height = 0.1f;            // m, along z, or along y of a mouth that looks along z
    float radius = 0.05f;           // m
    float velocity = 0;             // m/s, mean over the mouth
    float flow = 0;                 // m³/s, in two dimensions m²/s; instead of a velocity
    Rates velocities, flows;        // these over time, instead of one for all; evenly between
    std::string path;               // a CSV that becomes one of them when the scene is read
    Profile profile = Profile::Uniform;
    float start = 0, stop = 0;  // s; stop 0 = never
    float volume = 0;           // m³, in two dimensions m²: what it gives in all, 0 = no limit
};

// A drain or an outlet: what enters its box leaves the run.
struct Sink {
    Vec3 min{0, 0, 0}, max{0.1f, 0.1f, 0.1f};  // m
};

// Contact of fluid with objects, and of objects with each other (discrete element method).
struct Contact {
    float influence = 1.5f;  // fluid is kept so many times the sum of two particles' radii away
    float stiffness = 0;     // N/m, 0 = what the time step bears; in 2D N/m/m
    float steepness = 2;     // the spring is exp(steepness (1 - distance / reach)) times as stiff
    float damping = 0.1f;    // share of the critical one
    float shear = 0.1f;      // the same, along the surface
};

struct Window {
    std::string title = "Spindrift";
    int width = 1280, height = 800;  // logical pixels
    float pointSize = 0;             // px: particles are never drawn smaller than this diameter
    int samples = 4;                 // multisampling, 1 = off
    float interfaceScale = 0;        // of text and panel, 0 = as the display asks for
};

struct Compute {
    Backend backend = Backend::Auto;
    Precision precision = Precision::Float;
    Simd simd = Simd::Auto;
    int threads = 0;    // 0 = all cores
    int device = -1;    // number of the GPU; -1 = the one that draws, else the first
    float skin = 0.1f;  // neighbour lists reach this share of R further and are kept so long
    int steps = 0;      // 0 = until closed (window) or until output.time
};

struct SimulationKnobs {
    Formulation formulation = Formulation::Wcsph;
    int dimensions = 3;  // 2: one layer of particles in the middle of the domain's z
    Kernel kernel = Kernel::WendlandC2;
    float spacing = 0.02f;                              // m, initial distance of particles
    float support = 2.6f;                               // support radius R / spacing
    PressureForm pressureForm = PressureForm::Squares;  // of the forces between two particles
    Vec3 gravity{0, -9.81f, 0};                         // m/s²
    float gravityRamp = 0;  // s in which gravity grows from 0, 0 = there at once
    float centralRate = 0;  // 1/s, Omega of a force -Omega^2 r towards the domain's centre
    StartPlaces placement = StartPlaces::Lattice;  // of the particles in the bodies
    float jitter = 0;             // random displacement of the start's lattice / spacing, each axis
    int seed = 1;                 // of the jitter, and of relaxed places
    float accelerationLimit = 0;  // m/s², caps the pressure acceleration; 0 = off
};

struct Domain {
    Vec3 min{0, 0, 0}, max{1.6f, 0.9f, 0.6f};  // m
    bool periodicX = false, periodicY = false,
         periodicZ = false;  // what leaves on one side enters on the other
    Vec3d size() const { return toDouble(max) - toDouble(min); }
    bool periodic(int axis) const {
        return axis == 0 ? periodicX : axis == 1 ? periodicY : periodicZ;
    }
};

struct Walls {
    WallKind kind = WallKind::Particles;
    float restitution = 0;  // share of the normal velocity kept on impact with the domain box
    float friction = 0;     // share of the tangential velocity lost on impact
    float margin = 0;       // the box is this share of its size smaller on each side
    Face movingFace =
        Face::None;          // slides with `velocity`, and takes fluid along that sticks to it
    Vec3 velocity{0, 0, 0};  // m/s
    // Navier's slip lengths, m: how far behind a face the fluid's velocity would be the wall's. 0:
    // it sticks, -1: it slides freely. Of all faces, and of the three at `min` and at `max` of the
    // domain; the one that lets it slip more counts.
    float slip = 0;
    Vec3 slipMin{0, 0, 0}, slipMax{0, 0, 0};
};

struct Fluid {
    float restDensity = 1000;       // kg/m³
    float particleMass = 0;         // kg, 0 = rest density x spacing^3; 2D: kg/m, dx^2
    float soundSpeed = 0;           // m/s, 0 = speed_ratio x the expected largest speed
    float speedRatio = 10;          // sound speed / expected largest speed
    float backgroundPressure = 0;   // Pa, of fluid at rest density
    float surfaceTension = 0;       // N/m
    float velocityTransfer = 0;     // 1/s, at which neighbours take over each other's velocity
    float buoyancy = 0;             // of what is lighter than its surroundings, in units of gravity
    float dissipation = 0;          // 1/s, at which motion fades
    float airDensity = 0;           // kg/m³, of the air that slows drops; 0 = none
    float dragCoefficient = 0.47f;  // of the spheres as which it slows them
    Vec3 wind{0, 0, 0};             // m/s, of that air
    float viscosity = 0.001f;       // Pa s, dynamic; classic: its own coefficient
    ViscosityForm viscosityForm = ViscosityForm::Auto;  // of the sum that stands for it
    float artificialViscosity = 0.05f;                  // alpha of Monaghan 1992
    float densityDiffusion = 0.1f;  // delta of Molteni & Colagrossi 2009, where density is carried
    float shifting = 1;  // share of Sun 2019's particle shifting, delta_plus and transport_velocity
    EquationOfState equationOfState = EquationOfState::Tait;
    int gamma = 7;        // Tait exponent
    float stiffness = 0;  // Pa, pressure scale k of p = k((rho/rho0)^gamma - 1); 0 = rho0 c^2/gamma
    std::vector<Body> bodies{Body{{.max{0.5f, 0.54f, 0.6f}}}};
};

struct TimeKnobs {
    TimeMode mode = TimeMode::Cfl;
    Integrator integrator = Integrator::SymplecticEuler;
    float step = 0.0005f;  // s, used by fixed
    float cfl = 0.4f;      // Courant number: dt <= cfl h / (c + |v|), h = R/2
    float maxStep = 0;     // s, 0 = as long as sound and forces let it be
    float restSpeed =
        0.0001f;  // of local steps: share of the speed of sound below which fluid may rest
    int retries =
        3;  // with half the step from an earlier state, before a run in trouble is given up
};

// Of the incompressible formulation: when its pressures are good enough.
struct Solver {
    float densityError = 0.001f;  // mean of what densities are too large by, share of rest density
    int iterations = 100;         // at most
    float densityShare = 0.1f;    // of an error of density that a step of 0.4 h takes out
    float relaxation = 1;         // how far pressures go in an iteration, share of what is sure
};

struct Camera {
    float yaw = 35, pitch = 20;   // degrees
    float distance = 0;           // m, 0 = fits the domain
    float fieldOfView = 40;       // degrees, vertical
    bool automaticTarget = true;  // looks at the domain's centre
    Vec3 target{0, 0, 0};         // m, used when automatic_target is off
};

// What the mouse does to the fluid around it.
struct Stirrer {
    StirMode mode = StirMode::Drag;
    float strength = 1;  // of the hold that it has on the fluid
    float radius = 0;    // m, 0 = an eighth of the domain's shortest side
};

// The box of which fluid is shown, in shares of the domain; 0 and 1 are as far as anything goes.
struct Clip {
    Vec3 min{0, 0, 0}, max{1, 1, 1};
    bool solids = false;  // are cut as well
};

// A plane on which the coloured quantity is shown between the particles, across an axis.
struct Slice {
    Across axis = Across::None;
    float position = 0.5f;  // along that, share of the domain
    int contours = 0;       // lines of one value, about so many over the range
    bool fluid = false;     // is drawn too
};

// Shows only fluid whose coloured quantity is within these, in its unit.
struct Threshold {
    bool on = false;
    float min = 0, max = 1;
};

// Of velocity, at points of a grid.
struct Arrows {
    int count = 0;     // along the domain's longest side, 0 = none
    float length = 1;  // of the longest / the grid's step
};

struct View {
    DrawStyle style = DrawStyle::Spheres;
    ColorBy colorBy = ColorBy::Velocity;
    ColorMap colorMap = ColorMap::Coolwarm;
    std::string colorFile;  // of colour map file, beside the scene file when relative
    ColorScale colorScale = ColorScale::Linear;
    RangeMode range = RangeMode::Run;
    float rangeMin = 0, rangeMax = 1;  // in the unit of the coloured quantity, used by fixed
    Threshold threshold;
    Clip clip;
    Slice slice;
    Arrows arrows;
    int pathOf = -1;  // number of the particle whose path is drawn, -1 = none
    Theme theme = Theme::Dark;
    bool showAxes = false, showScale = false;
    Projection projection = Projection::Perspective;
    bool showWalls = false;       // draws boundary particles
    bool solidParticles = false;  // draws particles of solids instead of their shapes
    bool showOutline = true, showGround = true;
    Up up = Up::Auto;         // the direction that is up in pictures
    float particleScale = 1;  // drawn diameter / spacing
    float speed = 1;          // simulated / wall time that the window aims at
    float history = 512;      // MB of moments that the window can go back to, 0 = none
    Stirrer stir;
    Camera camera;
};

// A gauge whose readings are columns of the time series. A point reads position and radius, a line
// from, to and count, a height position and axis, a front axis. Points lie in the particles' layer
// in two dimensions.
struct Probe {
    ProbeKind kind = ProbeKind::Point;
    std::string name = "probe";       // begins the columns' names
    Vec3 position{0, 0, 0};           // m
    float radius = 0;                 // m, 0 = a point
    Vec3 from{0, 0, 0}, to{1, 0, 0};  // m
    int count = 11;                   // points on a line, both ends among them
    Axis axis = Axis::Y;              // along which a height or a front is read
    Order order = Order::Mean;        // of the interpolation between particles
};

struct Output {
    bool headless = false;
    float time = 0;             // s, 0 = by steps
    std::string screenshot;     // PNG path
    std::string frames;         // folder of a PNG sequence
    float fps = 60;             // 1/s of simulated time
    std::string csv, json;      // time series; "-" = standard output
    std::string checkpoint;     // HDF5 path: a run that can go on
    float checkpointEvery = 0;  // s of simulated time, 0 = at the end only
    std::string hdf5;           // the time series as an HDF5 file
    float sampleEvery =
        0;  // s of simulated time between rows of the series, 0 = with the frames, by fps
    std::string
        particles;  // CSV or HDF5 path: the last state, which a body of shape file can begin with
    std::string series;  // path: particles, solids and objects at every frame
    std::string fields = "velocity,density,pressure";  // of the particles in there
    std::string surface;              // path: the surface of the fluid at every frame
    bool surfaceAnisotropic = false;  // of kernels that lie along it
    std::string video;                // path: a film of the run
    bool strict = false;              // what is outside the validity of the method is an error
    bool faceForces = false;     // columns of the series: what fluid does to the domain's faces
    bool energyBalance = false;  // columns of the series: where energy comes from and goes to
    std::vector<Probe> probes;
};

struct Scene {
    int version = 2;
    std::string name = "dam break";
    Window window;
    Compute compute;
    SimulationKnobs simulation;
    Domain domain;
    Walls walls;
    std::vector<Solid> solids;
    std::vector<Object> objects;
    std::vector<Grip> grips;
    std::vector<Cut> cuts;
    std::vector<Source> sources;
    std::vector<Sink> sinks;
    Contact contact;
    Fluid fluid;
    TimeKnobs time;
    Solver solver;
    View view;
    Output output;
};

// Derived values, so that every reader computes them the same way.
float supportRadius(const Scene&);  // m
// What has a depth is measured per metre of it in two dimensions: masses in kg/m, forces in N/m,
// energies in J/m. This is the unit's name there.
std::string perDepth(const std::string& unit, int dimensions);
double particleVolume(const Scene&);  // m^3; in two dimensions m^2
float particleMass(const Scene&);     // kg; in two dimensions kg/m
// Whether density follows the continuity equation from step to step, instead of being summed up
// anew.
bool carriesDensity(const Scene&);
// Whether there is velocity transfer or buoyancy.
bool hasMixingForces(const Scene&);
// Of a body at rest, kg/m³, and of its fluid, Pa s: its own, or those of all.
float restDensity(const Scene&, const Body&);
float viscosity(const Scene&, const Body&);
// Whether its bodies are of more than one fluid.
bool isMultiFluid(const Scene&);
// The most of all fluids, Pa s.
float largestViscosity(const Scene&);
// Whether any wall or solid lets fluid slip.
bool letsSlip(const Scene&);
// The sum that stands for viscosity: the one that is asked for, or by auto the one for this scene;
// and why not the other.
ViscosityForm viscosityForm(const Scene&);
const char* whyViscosityForm(const Scene&);
// What is up in pictures: view.up, or in place of auto against the largest part of gravity, and y
// where there is none or it drives a flow along a periodic axis. As a unit vector:
Up upOf(const Scene&);
Vec3 upward(const Scene&);
// Whether particles come or leave while it runs.
bool comesAndGoes(const Scene&);
// Whether particles move a little beside the fluid, to stay evenly spread.
bool shiftsParticles(const Scene&);

}  // namespace spindrift
