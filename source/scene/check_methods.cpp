#include "scene/check_methods.h"

#include "scene/check_bodies.h"
#include "scene/formulation.h"
#include "scene/schema.h"

#include <algorithm>

namespace spindrift {
namespace {

// Tuned as a whole: what its original does not have, it does not have.
void checkClassic(const Scene& scene) {
    const Vec3 size = scene.domain.max - scene.domain.min;
    const Domain& domain = scene.domain;
    if (scene.simulation.dimensions == 2 || domain.periodicX || domain.periodicY ||
        domain.periodicZ)
        refuse("simulation.formulation",
               "the classic one has three dimensions and walls all round; use wcsph");
    if (!(size.x == size.y && size.y == size.z))
        refuse("domain",
               "the classic formulation needs a cube; give domain.max - domain.min three "
               "equal sides, or use simulation.formulation wcsph");
    if (scene.simulation.kernel != Kernel::CubicSpline)
        refuse("simulation.kernel",
               "the classic formulation has the masses of its original's kernel, with another one "
               "densities are a half of those at rest; use cubic_spline, or simulation.formulation "
               "wcsph");
    if (scene.time.integrator != Integrator::SymplecticEuler)
        refuse("time.integrator",
               "the classic formulation is stepped by symplectic_euler; use "
               "that, or simulation.formulation wcsph");
}

void checkIncompressible(const Scene& scene) {
    if (scene.time.integrator != Integrator::SymplecticEuler)
        refuse("time.integrator",
               "the incompressible formulation has one of its own; use symplectic_euler");
    if (scene.time.mode == TimeMode::Local)
        refuse("time.mode",
               "the incompressible formulation has the same step everywhere; use cfl or fixed");
    // What velocities change densities by follows from the kernel's gradient.
    if (scene.simulation.kernel == Kernel::Mueller)
        refuse("simulation.kernel",
               "mueller's gradient is not that of its densities, which the incompressible "
               "formulation keeps by it; use wendland_c2");
}

bool anyWallReflects(const Scene& scene) {
    bool anyWall = false;
    for (int k = 0; k < scene.simulation.dimensions; ++k) anyWall |= !scene.domain.periodic(k);
    return anyWall && scene.walls.kind == WallKind::Reflect;
}

void checkReflecting(const Scene& scene) {
    if (!anyWallReflects(scene)) return;
    const Formulation formulation = scene.simulation.formulation;
    // Particles gather on such walls, and two in one place have a gradient of the spiky kernel that
    // turns around at once: of 0.02 spacings apart one became 23 % lighter in ten steps.
    if (formulation == Formulation::DeltaSph && scene.simulation.kernel == Kernel::Mueller)
        refuse("simulation.kernel",
               "mueller's gradient jumps where particles meet, as they do on "
               "walls that reflect, and carried densities with it; use "
               "wendland_c2, or walls.kind particles");
    // Walls without particles leave the fluid beside them a free surface.
    if (factsOf(scene).fillsSpace)
        refuse("walls.kind",
               "transport_velocity has no free surfaces, and beside walls that "
               "reflect there is one; use particles, or simulation.formulation "
               "delta_plus");
}

void checkViscosityForm(const Scene& scene) {
    if (factsOf(scene).fillsSpace && viscosityForm(scene) != ViscosityForm::Morris)
        refuse("fluid.viscosity_form",
               "monaghan is without what transport_velocity corrects; use auto or morris");
}

void checkPressureForm(const Scene& scene) {
    const Formulation formulation = scene.simulation.formulation;
    if (scene.simulation.pressureForm == PressureForm::Squares) return;
    if (!factsOf(scene).meansPressure)
        refuse("simulation.pressure_form",
               fmt::format("mean is one of wcsph; {} has its own, use squares",
                           enumNames(Formulation())[size_t(formulation)]));
    if (isMultiFluid(scene))
        refuse("simulation.pressure_form", "mean is for one fluid; use squares");
}

}  // namespace

void checkMethods(const Scene& scene) {
    const Integrator integrator = scene.time.integrator;
    if (factsOf(scene).isHistorical) checkClassic(scene);
    checkReflecting(scene);
    checkPressureForm(scene);
    checkViscosityForm(scene);
    if (factsOf(scene).solvesPressure) checkIncompressible(scene);
    const auto floats = [](const Solid& s) { return s.floats(); };
    const bool several =
        isMultiFluid(scene) || std::any_of(scene.solids.begin(), scene.solids.end(), floats);
    if (integrator == Integrator::Split && (!factsOf(scene).splits || several))
        refuse("time.integrator",
               "split is for delta_sph, one fluid, and nothing that floats; use "
               "symplectic_euler");
    if (scene.time.mode == TimeMode::Local &&
        (shiftsParticles(scene) || integrator != Integrator::SymplecticEuler))
        refuse("time.mode",
               "local steps need time.integrator symplectic_euler and a formulation "
               "that doesn't shift particles; use cfl, or those");
}

}  // namespace spindrift
