#include "app/window/idle_knobs.h"

#include "app/frame.h"
#include "scene/formulation.h"

namespace spindrift {

namespace {

const char* whyTimeIsIdle(const Scene& s, const std::string& path) {
    const TimeMode mode = s.time.mode;
    if (path == "time.step" && mode != TimeMode::Fixed) return "time.mode is not fixed";
    if ((path == "time.cfl" || path == "time.max_step") && mode == TimeMode::Fixed)
        return "time.mode is fixed";
    if (path == "time.rest_speed" && mode != TimeMode::Local) return "time.mode is not local";
    return "";
}

const char* whyFluidIsIdle(const Scene& s, const std::string& path) {
    const Fluid& f = s.fluid;
    if ((path == "fluid.sound_speed" || path == "fluid.speed_ratio") && f.stiffness > 0)
        return "fluid.stiffness says it";
    if (path == "fluid.speed_ratio" && f.soundSpeed > 0) return "fluid.sound_speed says it";
    if (path == "fluid.gamma" && f.equationOfState == EquationOfState::Linear)
        return "fluid.equation_of_state is linear";
    if (factsOf(s).solvesPressure && (path == "fluid.gamma" || path == "fluid.equation_of_state" ||
                                      path == "fluid.background_pressure"))
        return "pressure is solved for, not by an equation of state";
    if (path == "fluid.density_diffusion" && !carriesDensity(s))
        return "density is summed up, not carried";
    if (path == "fluid.shifting" && !shiftsParticles(s))
        return "simulation.formulation is neither delta_plus nor transport_velocity";
    if (path == "fluid.surface_tension" && !factsOf(s).takesTension)
        return "simulation.formulation is not delta_plus";
    if (path == "fluid.air_density" && !factsOf(s).airResists)
        return "simulation.formulation is neither wcsph nor incompressible";
    if ((path == "fluid.drag_coefficient" || path == "fluid.wind") && f.airDensity <= 0)
        return "fluid.air_density is 0";
    const bool isRare = path == "fluid.velocity_transfer" || path == "fluid.buoyancy" ||
                        path == "fluid.dissipation";
    if (!factsOf(s).takesOthers && (isRare || path == "fluid.artificial_viscosity"))
        return "simulation.formulation does without";
    if (path == "fluid.buoyancy" && s.simulation.gravity == Vec3{}) return "there is no gravity";
    return "";
}

const char* whyRestIsIdle(const Scene& s, const std::string& path) {
    if (path == "simulation.gravity_ramp" && s.simulation.gravity == Vec3{})
        return "there is no gravity";
    if (path == "simulation.pressure_form" && !factsOf(s).meansPressure)
        return "simulation.formulation is not wcsph";
    const bool soundIsKnown = s.fluid.soundSpeed > 0 || s.fluid.stiffness > 0;  // else it follows
    if (path.starts_with("solver.") && !factsOf(s).solvesPressure)
        return "simulation.formulation is not incompressible";
    if (path == "walls.velocity" && s.walls.movingFace == Face::None && soundIsKnown)
        return "walls.moving_face is none";
    const bool sticks = largestViscosity(s) > 0 || s.fluid.artificialViscosity > 0;
    if (path.starts_with("walls.slip") && !sticks) return "nothing sticks to walls: no viscosity";
    if (path.starts_with("contact.") && s.objects.empty()) return "there are no elastic objects";
    return "";
}

const char* whyViewIsIdle(const Scene& s, const std::string& path) {
    const View& v = s.view;
    const bool needsNumber = path.starts_with("view.range") || path.starts_with("view.threshold") ||
                             path == "view.color_scale" || path == "view.slice.contours";
    if (needsNumber && !isNumber(v.colorBy)) return "what is shown is not a number";
    if (path.starts_with("view.range_") && v.range != RangeMode::Fixed)
        return "view.range is not fixed";
    if (path.starts_with("view.threshold.m") && !v.threshold.on) return "view.threshold.on is off";
    if (path == "view.solid_particles" && s.solids.empty()) return "there are no solids";
    if (path == "view.color_map" && !isNumber(v.colorBy))
        return "what is shown has colours of its own";
    if (path == "view.color_file" && v.colorMap != ColorMap::File)
        return "view.color_map is not file";
    if (path.starts_with("view.slice.") && path != "view.slice.axis" &&
        v.slice.axis == Across::None)
        return "view.slice.axis is none";
    if (path == "view.slice.axis" && v.slice.axis != Across::None && v.colorBy == ColorBy::Plain)
        return "view.color_by is plain, and so is the slice";
    if (path == "view.slice.position" && s.simulation.dimensions == 2)
        return "in two dimensions there is one layer";
    if (path == "view.arrows.length" && v.arrows.count == 0) return "view.arrows.count is 0";
    if (path == "view.camera.target" && v.camera.automaticTarget)
        return "view.camera.automatic_target is on";
    return "";
}

}  // namespace

std::string whyIdle(const Scene& scene, const std::string& path) {
    for (const auto why : {whyTimeIsIdle, whyFluidIsIdle, whyRestIsIdle, whyViewIsIdle})
        if (const std::string reason = why(scene, path); !reason.empty()) return reason;
    return "";
}

}  // namespace spindrift
