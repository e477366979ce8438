#include "measure/validation.h"

#include "measure/accelerated_bodies.h"
#include "measure/enclosed_flows.h"
#include "measure/free_surface_flows.h"
#include "measure/operators.h"
#include "scene/schema.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

void spacing(Scene& s, int n) { s.simulation.spacing = 1.0f / float(n); }
void solveForPressures(Scene& s) {
    s.simulation.formulation = Formulation::Incompressible;
    s.time.integrator = Integrator::SymplecticEuler, s.time.cfl = 0.4f;
}

}  // namespace

std::vector<ValidationCase> validationCases(const std::string& data) {
    auto taylorGreen = [](double until, std::vector<std::pair<int, double>> targets) {
        return [=](const Scene& s, ValidationRun& r) { runTaylorGreen(s, r, until, targets); };
    };
    auto cavity = [data](const char* column, double end, double target, int from) {
        return [=](const Scene& s, ValidationRun& r) {
            runCavity(s, r, data, column, end, target, from);
        };
    };
    auto viscous = [](float viscosity) {
        return [=](Scene& s, int n) { spacing(s, n), s.fluid.viscosity = viscosity; };
    };
    // The better kernel for the same time at Re = 100, not at 1000 (docs/ACCURACY.md).
    auto smooth = [](Scene& s, int n) {
        spacing(s, n), s.simulation.kernel = Kernel::WendlandC4, s.simulation.support = 3.2f;
    };
    auto perRadius = [](Scene& s, int n) { s.simulation.spacing = 0.1f / float(n); };
    auto accelerated = [](double coefficient, double target, int from) {
        return [=](const Scene& s, ValidationRun& r) {
            runAcceleratedBody(s, r, coefficient, target, from);
        };
    };
    auto tank = [](Scene& s, int n) {  // 0.9 m deep, about 2 m wide in whole spacings
        const float dx = 0.9f / float(n);
        s.simulation.spacing = dx,
        s.fluid.bodies[0].max.x = s.domain.max.x = dx * std::round(2 * float(n) / 0.9f);
    };
    const std::string morris = "Morris, Fox and Zhu 1997, series",
                      stream = "finite differences, 256^2, Richardson";
    return {
        {"hydrostatic",
         "Hydrostatic tank",
         "hydrostatic",
         "p = rho g (H - y)",
         "H / dx",
         {30, 60, 120},
         {30},
         tank,
         [](const Scene& s, ValidationRun& r) { runHydrostatic(s, r, 60); }},
        {"hydrostatic_wedge",
         "Hydrostatic tank with a wedge on its floor",
         "hydrostatic_wedge",
         "p = rho g (H - y)",
         "H / dx",
         {30, 60, 120},
         {30},
         tank,
         [](const Scene& s, ValidationRun& r) { runHydrostatic(s, r, 60); }},
        {"hydrostatic_sphere",
         "Hydrostatic tank with a sphere, three dimensions",
         "hydrostatic_sphere",
         "p = rho g (H - y)",
         "H / dx",
         {15, 30},
         {},
         [](Scene& s, int n) { s.simulation.spacing = 0.6f / float(n); },
         [](const Scene& s, ValidationRun& r) {
             runHydrostatic(s, r, 30, 4 * std::numbers::pi / 3 * std::pow(s.solids[0].radius, 3));
         }},
        {"poiseuille",
         "Start-up of Poiseuille flow, Re 0.0125",
         "poiseuille",
         morris,
         "L / dx",
         {20, 40, 80},
         {20, 40},
         spacing,
         runPoiseuille},
        {"poiseuille_re100",
         "Start-up of Poiseuille flow, Re 100",
         "poiseuille_re100",
         morris,
         "L / dx",
         {20, 40},
         {},
         spacing,
         runPoiseuille},
        {"couette",
         "Start-up of Couette flow, Re 0.0125",
         "couette",
         morris,
         "L / dx",
         {20, 40, 80},
         {20, 40},
         spacing,
         runCouette},
        {"half_channel",
         "Start-up of flow over a plate, below one that it slides on",
         "half_channel",
         morris,
         "L / dx",
         {20, 40, 80},
         {20},
         spacing,
         runHalfChannel},
        {"slip_channel",
         "Poiseuille flow with a slip length of L / 10",
         "slip_channel",
         "Navier 1823",
         "L / dx",
         {10, 20, 40},
         {20},
         spacing,
         runSlipChannel},
        {"cavity_re100",
         "Lid-driven cavity, Re 100",
         "cavity",
         stream,
         "L / dx",
         {25, 50, 100},
         {25},
         viscous(0.01f),
         cavity("Re100", 20, 0.5, 50)},
        {"cavity_re1000",
         "Lid-driven cavity, Re 1000",
         "cavity",
         stream,
         "L / dx",
         {50, 100},
         {},
         viscous(0.001f),
         cavity("Re1000", 60, 1.5, 100)},
        {"taylor_green",
         "Taylor-Green vortices, Re 100, jittered start",
         "taylor_green",
         "Taylor and Green 1937",
         "L / dx",
         {50, 100, 200},
         {50, 100},
         smooth,
         taylorGreen(2, {{100, 0.01}, {200, 0.004}})},
        {"taylor_green_lattice",
         "Taylor-Green vortices, Re 100, lattice start",
         "taylor_green",
         "Taylor and Green 1937",
         "L / dx",
         {50, 100},
         {},
         [smooth](Scene& s, int n) { smooth(s, n), s.simulation.jitter = 0; },
         taylorGreen(2, {{100, 0.01}})},
        {"taylor_green_re1000",
         "Taylor-Green vortices, Re 1000, jittered start",
         "taylor_green",
         "Taylor and Green 1937",
         "L / dx",
         {50, 100},
         {},
         viscous(0.001f),
         taylorGreen(5, {{100, 0.015}})},
        {"drop",
         "Oscillating drop, s0 = 1",
         "drop",
         "Monaghan and Rafiee 2013, ODE",
         "R / dx",
         {25, 50},
         {},
         spacing,
         runDrop},
        {"rotation",
         "Viscous disc that turns as a solid",
         "rotation",
         "nothing happens",
         "R / dx",
         {12, 25, 50},
         {12, 25},
         spacing,
         runRotation},
        {"viscous_drop",
         "Drop that viscosity stills, nu = 0.02 Omega R^2",
         "viscous_drop",
         "linear, potential and vortical part",
         "R / dx",
         {12, 25, 50},
         {12},
         spacing,
         runViscousDrop},
        {"viscous_wave",
         "Standing wave that viscosity stills",
         "viscous_wave",
         "Lamb 1932, linear",
         "L / dx",
         {25, 50, 100},
         {25},
         spacing,
         runViscousWave},
        {"film",
         "Film down an incline, Re 1",
         "film",
         "Nusselt 1916",
         "H / dx",
         {10, 20, 40},
         {10, 20},
         spacing,
         runFilm},
        {"added_mass",
         "Cylinder that accelerates in a box",
         "added_mass",
         "Lamb 1932, images",
         "a / dx",
         {5, 10, 20},
         {5},
         perRadius,
         accelerated(1, 5, 5)},
        {"added_mass_square",
         "Square that accelerates in a box",
         "added_mass_square",
         "Newman 1977, 4.754 a^2, images",
         "a / dx",
         {5, 10, 20},
         {5},
         perRadius,
         accelerated(4.754 / 4, 5, 5)},
        {"added_mass_sphere",
         "Sphere that accelerates in a box, three dimensions",
         "added_mass_sphere",
         "Lamb 1932, images",
         "a / dx",
         {4, 5, 6},
         {},
         perRadius,
         accelerated(0.5, 5, 5)},
        {"stokes_layer",
         "Early drag of a cylinder that accelerates",
         "stokes_layer",
         "Stokes 1851, Basset 1888, images",
         "a / dx",
         {5, 10, 20},
         {},
         perRadius,
         accelerated(1, 10, 20)},
        {"heave",
         "Cylinder afloat that heaves",
         "heave",
         "Ursell 1949, Maskell and Ursell 1970",
         "a / dx",
         {5, 10, 20},
         {5},
         perRadius,
         [data](const Scene& s, ValidationRun& r) { runHeave(s, r, data); }},
        {"settling",
         "Sphere that settles, Re 31.9",
         "settling",
         "ten Cate et al. 2002, E4",
         "0.1 m / dx",
         {27, 40},
         {},
         [](Scene& s, int n) { s.simulation.spacing = 0.1f / float(n); },
         [](const Scene& s, ValidationRun& r) { runSettling(s, r, 0.122); }},
        {"dam_break_front",
         "Dam-break front, n^2 = 2",
         "dam_break_front",
         "Martin and Moyce 1952, a = 2.25 in",
         "a / dx",
         {20, 40, 80},
         {20},
         spacing,
         [data](const Scene& s, ValidationRun& r) { runFront(s, r, data); }},
        {"dam_break_pressure",
         "Dam-break pressures, H = 0.3 m",
         "dam_break_pressure",
         "Lobovsky et al. 2014",
         "H / dx",
         {40, 80, 160},
         {},
         [](Scene& s, int n) { s.simulation.spacing = 0.3f / float(n); },
         [data](const Scene& s, ValidationRun& r) { runImpact(s, r, data); }},
        {"dam_break_front_incompressible",
         "Dam-break front, incompressible",
         "dam_break_front",
         "Martin and Moyce 1952, a = 2.25 in",
         "a / dx",
         {20, 40, 80},
         {},
         [=](Scene& s, int n) { spacing(s, n), solveForPressures(s); },
         [data](const Scene& s, ValidationRun& r) { runFront(s, r, data); }},
        {"dam_break_pressure_incompressible",
         "Dam-break pressures, incompressible",
         "dam_break_pressure",
         "Lobovsky et al. 2014",
         "H / dx",
         {40, 80, 160},
         {},
         [=](Scene& s, int n) { s.simulation.spacing = 0.3f / float(n), solveForPressures(s); },
         [data](const Scene& s, ValidationRun& r) { runImpact(s, r, data); }},
        {"kleefsman",
         "Dam break with a box, three dimensions",
         "kleefsman",
         "Kleefsman et al. 2005",
         "0.55 m / dx",
         {15, 30},
         {},
         [](Scene& s, int n) { s.simulation.spacing = 0.55f / float(n); },
         [data](const Scene& s, ValidationRun& r) { runKleefsman(s, r, data); }},
        {"conservation",
         "Conservation in a periodic box, 10,000 steps, delta_sph",
         "taylor_green",
         "momentum and energy",
         "L / dx",
         {64},
         {32},
         [](Scene& s, int n) {
             spacing(s, n), s.simulation.formulation = Formulation::DeltaSph, s.fluid.viscosity = 0,
                            s.time = {.cfl = 0.6f};
         },
         runConservation},
        {"sound_wave",
         "Sound wave, delta_sph",
         "sound_wave",
         "c k, and the lattice's dispersion relation",
         "L / dx",
         {32, 64, 128},
         {32, 64},
         spacing,
         runSoundWave},
        {"operators",
         "Gradients and Laplacians of sin 2 pi x cos 2 pi y",
         "taylor_green",
         "its derivatives",
         "L / dx",
         {25, 50, 100, 200},
         {50, 100},
         spacing,
         runOperators},
    };
}

ValidationRun validate(const ValidationCase& c, const Scene& scene, int resolution) {
    ValidationRun run;
    run.resolution = resolution;
    const SimulationKnobs& s = scene.simulation;
    run.method = fmt::format("{}, {}, R = {:g} dx", enumNames(s.formulation)[size_t(s.formulation)],
                             enumNames(s.kernel)[size_t(s.kernel)], s.support);
    c.run(scene, run);
    if (run.diverged)
        for (Metric& m : run.metrics) m.value = std::nan("");
    run.chart.title = fmt::format("{}, {} = {}", c.title, c.length, resolution);
    return run;
}

}  // namespace spindrift
