#include "scene/historical.h"

#include <cmath>

namespace spindrift {
namespace {

// The layout's own values; the defaults are those of its first benchmark file.
struct Historical {
    struct {
        std::string title = "Spindrift";
        int width = 1280, height = 800;
        float pointSize = 0;
    } window;
    struct {
        bool cli = false, gpu = true;
        int gpuThreads = 128, ompThreads = 0, steps = 0;
    } compute;
    struct {
        float delta = 0.0025f, spaceSize = 1, smoothRadius = 0.04f;
        Int3 fluidGrid{16, 22, 16};
        bool boxBoundary = false;
    } simulation;
    struct {
        float gravity = -9.8f, mass = 0.0000765f, density = 1, viscosity = 0.05f, stiffness = 10;
    } fluid;
};

// Particles of the initial block are this far apart, m.
constexpr float Spacing = 0.025f;

template <class Visitor> void visitKnobs(Historical& h, Visitor&& visit) {
    auto& w = h.window;
    visit("window.title", w.title, Knob{"", 0, 0, "title of the window"});
    visit("window.width", w.width, Knob{"px", 16, 16384, "width of the window"});
    visit("window.height", w.height, Knob{"px", 16, 16384, "height of the window"});
    visit("window.point_size", w.pointSize, Knob{"px", 0, 255, "smallest diameter of a particle"});
    auto& c = h.compute;
    visit("compute.cli", c.cli, Knob{"", 0, 0, "runs without a window"});
    visit("compute.gpu", c.gpu, Knob{"", 0, 0, "uses a GPU when there is one"});
    visit("compute.gpu_threads", c.gpuThreads, Knob{"", 1, 1024, "ignored: chosen by the program"});
    visit("compute.omp_threads", c.ompThreads, Knob{"", 1, 4096, "CPU threads"});
    visit("compute.steps", c.steps, Knob{"", 0, 1e9f, "time steps to run, 0 = until closed"});
    auto& s = h.simulation;
    visit("simulation.delta", s.delta, Knob{"s", 1e-8f, 1, "time step"});
    visit("simulation.space_size", s.spaceSize, Knob{"m", 1e-4f, 1e4f, "side of the cube"});
    visit(
        "simulation.smooth_radius", s.smoothRadius,
        Knob{"m", 1.5f * Spacing, 6 * Spacing, "support radius; the block's lattice has 0.025 m"});
    visit("simulation.fluid_grid", s.fluidGrid,
          Knob{"", 1, 1e6f, "particles of the block along x, y, z"});
    visit("simulation.box_boundary", s.boxBoundary, Knob{"", 0, 0, "false: boundary particles"});
    auto& f = h.fluid;
    visit("fluid.gravity", f.gravity, Knob{"m/s²", -100, 100, "gravity along y"});
    visit("fluid.mass", f.mass, Knob{"kg", 1e-12f, 1e6f, "mass of a particle"});
    visit("fluid.density", f.density, Knob{"kg/m³", 1e-3f, 1e5f, "density at rest"});
    visit("fluid.viscosity", f.viscosity, Knob{"", 0, 1000, "viscosity"});
    visit("fluid.stiffness", f.stiffness, Knob{"Pa", 0, 1e10f, "pressure scale"});
}

void translateProgram(const Historical& h, Scene& scene) {
    scene.window.title = h.window.title;
    scene.window.width = h.window.width;
    scene.window.height = h.window.height;
    scene.window.pointSize = h.window.pointSize;
    scene.compute.backend = h.compute.gpu ? Backend::Auto : Backend::Cpu;
    scene.compute.threads = h.compute.ompThreads;
    scene.compute.steps = h.compute.steps;
    scene.output.headless = h.compute.cli;
}

void translatePhysics(const Historical& h, Scene& scene) {
    const float side = h.simulation.spaceSize;
    scene.domain = {{0, 0, 0}, {side, side, side}};
    const Vec3 half = 0.5f * Spacing *
                      Vec3{float(h.simulation.fluidGrid.x), float(h.simulation.fluidGrid.y),
                           float(h.simulation.fluidGrid.z)};
    const Vec3 center{side / 2, side / 2, side / 2};
    Body block;
    block.min = center - half;
    block.max = center + half;
    scene.fluid.bodies = {block};

    auto& sim = scene.simulation;
    sim.formulation = Formulation::Classic;
    sim.kernel = Kernel::CubicSpline;
    sim.spacing = Spacing;
    sim.support = h.simulation.smoothRadius / Spacing;
    sim.gravity = {0, h.fluid.gravity, 0};
    sim.accelerationLimit = 1000;
    scene.walls = {h.simulation.boxBoundary ? WallKind::Reflect : WallKind::Particles, 1, 0,
                   0.001f};
    scene.time.mode = TimeMode::Fixed;
    scene.time.step = h.simulation.delta;

    scene.fluid.restDensity = h.fluid.density;
    scene.fluid.particleMass = h.fluid.mass;
    scene.fluid.viscosity = h.fluid.viscosity;
    scene.fluid.artificialViscosity = 0;
    scene.fluid.equationOfState = EquationOfState::Tait;
    scene.fluid.gamma = 7;
    scene.fluid.stiffness = h.fluid.stiffness;
}

}  // namespace

Scene readHistorical(const Json& root, const std::string& file) {
    Historical historical;
    readKnobs(root, historical,
              Place{file, " (without \"version\": 2 a file is read in the historical layout)"});
    Scene scene;
    scene.name = "classic block drop";
    translateProgram(historical, scene);
    translatePhysics(historical, scene);
    return scene;
}

}  // namespace spindrift
