#pragma once
// The one list of knobs: path, value, unit, range, help. Everything that reads or shows a knob
// walks it: JSON reader and writer, --set, the panel, --help, JSON Schema, range checks. Those of
// members of lists are in list_knobs.h, the names of choices in knob.h.
#include "scene/list_knobs.h"

#include <string>
#include <type_traits>

namespace spindrift {

namespace schema {

template <class S, class Visitor>
void visitMembers(S& list, const std::string& path, Visitor&& visit) {
    for (size_t i = 0; i < list.size(); ++i)
        visitMember(list[i], path + "[" + std::to_string(i) + "]", visit);
}

template <class C, class Visitor> void visitContact(C& c, Visitor&& visit) {
    visit("contact.influence", c.influence,
          Knob{"", 0.5f, 3,
               "of objects: fluid is kept so many times the sum of two particles' radii away",
               Restart});
    visit("contact.stiffness", c.stiffness,
          Knob{"N/m", 0, 1e9f,
               "of the spring between two particles, 0 = what the time step bears; "
               "in two dimensions for each metre of depth"});
    visit("contact.steepness", c.steepness,
          Knob{"", 0, 4, "the spring is exp(steepness (1 - distance / reach)) times as stiff"});
    visit("contact.damping", c.damping,
          Knob{"", 0, 2, "of contacts, share of the critical one; none where a bond is broken"});
    visit("contact.shear", c.shear, Knob{"", 0, 2, "the same, of motion along the surface"});
}

template <class S, class Visitor> void visitProgram(S& s, Visitor&& visit) {
    visit("version", s.version, Knob{"", 2, 2, "layout of the file", Restart});
    visit("name", s.name, Knob{"", 0, 0, "what the scene is called", Restart});

    visit("window.title", s.window.title, Knob{"", 0, 0, "title of the window", Restart});
    visit("window.width", s.window.width, Knob{"px", 16, 16384, "width of the picture", Restart});
    visit("window.height", s.window.height,
          Knob{"px", 16, 16384, "height of the picture", Restart});
    visit("window.point_size", s.window.pointSize,
          Knob{"px", 0, 255, "particles are never drawn smaller than this"});
    visit("window.samples", s.window.samples,
          Knob{"", 1, 16, "anti-aliasing samples, 1 = off", Restart});
    visit("window.interface_scale", s.window.interfaceScale,
          Knob{"", 0, 4, "size of text and panel, 0 = as the display's density asks for"});

    visit("compute.backend", s.compute.backend, Knob{"", 0, 0, "where to compute", Restart});
    visit("compute.precision", s.compute.precision,
          Knob{"", 0, 0, "of state and arithmetic", Restart});
    visit("compute.simd", s.compute.simd, Knob{"", 0, 0, "widest CPU instructions used", Restart});
    visit("compute.threads", s.compute.threads,
          Knob{"", 0, 4096, "CPU threads, 0 = all cores, or fewer while others use them", Restart});
    visit("compute.device", s.compute.device,
          Knob{"", -1, 63, "number of the GPU, -1 = the one that draws, else the first", Restart});
    visit("compute.skin", s.compute.skin,
          Knob{"", 0, 1,
               "neighbour lists reach this share of the support radius further and last until "
               "particles have moved half of it, 0 = new lists each step",
               Restart});
    visit("compute.steps", s.compute.steps,
          Knob{"", 0, 1e9f, "time steps to run, 0 = until closed or until output.time", Restart});
}

template <class S, class Visitor> void visitPhysics(S& s, Visitor&& visit) {
    auto& sim = s.simulation;
    visit(
        "simulation.formulation", sim.formulation,
        Knob{"", 0, 0,
             "wcsph: density by summation, rugged; delta_sph: density carried and diffused, smooth "
             "pressure; delta_plus: the same with shifted particles, loses little energy; "
             "transport_velocity: second order, for flows that fill the domain; classic: "
             "the historical one; incompressible: pressure solved for, steps as long as the flow "
             "lets them be, for looking and playing",
             Restart});
    visit("simulation.dimensions", sim.dimensions,
          Knob{"", 2, 3, "2 = a layer of particles, everything depends on x and y only", Restart});
    visit("simulation.kernel", sim.kernel,
          Knob{"", 0, 0,
               "smoothing kernel; mueller: poly6 for densities, the spiky one for gradients, one "
               "of its own for viscosity",
               Restart});
    visit("simulation.spacing", sim.spacing,
          Knob{"m", 1e-7f, 1e4f, "initial distance of particles", Restart});
    visit("simulation.support", sim.support, Knob{"", 1, 6, "support radius / spacing", Restart});
    visit("simulation.pressure_form", sim.pressureForm,
          Knob{"", 0, 0,
               "of wcsph: squares: p_i / rho_i^2 + p_j / rho_j^2; mean: (p_i + p_j) / (2 rho_i "
               "rho_j)"});
    visit("simulation.gravity", sim.gravity,
          Knob{"m/s²", -100, 100,
               "gravity; along a periodic axis the force that drives a channel's flow"});
    visit("simulation.gravity_ramp", sim.gravityRamp,
          Knob{"s", 0, 1e4f,
               "gravity grows from 0 to its full value in this time, without a jerk: for a pool "
               "that begins without the pressure "
               "of its depth; 0 = there at once"});
    visit("simulation.central_rate", sim.centralRate,
          Knob{"1/s", 0, 1000, "Omega of a pull -Omega^2 r to the domain's centre, 0 = off"});
    visit("simulation.placement", sim.placement,
          Knob{"", 0, 0,
               "lattice: in rows; relaxed: from a random start pushed apart until they fill the "
               "bodies evenly up to their "
               "surfaces, round ones too, in no order: without a lattice's preferred directions "
               "and without its first collapse",
               Restart});
    visit("simulation.jitter", sim.jitter,
          Knob{"", 0, 0.5f,
               "random displacement of each particle of the lattice at the start / spacing",
               Restart});
    visit("simulation.seed", sim.seed,
          Knob{"", 0, 1e9f, "of the jitter, and of relaxed places", Restart});
    visit("simulation.acceleration_limit", sim.accelerationLimit,
          Knob{"m/s²", 0, 1e6f, "caps the pressure acceleration, 0 = off"});

    visit("domain.min", s.domain.min, Knob{"m", -1e7f, 1e7f, "lower corner of the box", Restart});
    visit("domain.max", s.domain.max, Knob{"m", -1e7f, 1e7f, "upper corner of the box", Restart});
    visit("domain.periodic_x", s.domain.periodicX,
          Knob{"", 0, 0, "who leaves along x enters on the other side", Restart});
    visit("domain.periodic_y", s.domain.periodicY, Knob{"", 0, 0, "the same along y", Restart});
    visit("domain.periodic_z", s.domain.periodicZ, Knob{"", 0, 0, "the same along z", Restart});

    visit("walls.kind", s.walls.kind,
          Knob{"", 0, 0, "reflecting box or boundary particles", Restart});
    visit("walls.restitution", s.walls.restitution,
          Knob{"", 0, 1, "share of the normal velocity kept on impact"});
    visit("walls.friction", s.walls.friction,
          Knob{"", 0, 1, "share of the tangential velocity lost on impact"});
    visit("walls.margin", s.walls.margin,
          Knob{"", 0, 0.4f, "share of its size the box is smaller, each side"});
    visit("walls.moving_face", s.walls.movingFace,
          Knob{"", 0, 0, "slides with walls.velocity and drags the fluid", Restart});
    visit("walls.velocity", s.walls.velocity,
          Knob{"m/s", -1e3f, 1e3f, "of the moving face, along itself"});
    visit("walls.slip", s.walls.slip,
          Knob{"m", -1, 1e6f,
               "Navier's slip length of all faces: how far behind them the fluid's velocity would "
               "be theirs; 0 = it sticks, -1 = it slides freely"});
    visit("walls.slip_min", s.walls.slipMin,
          Knob{"m", -1, 1e6f,
               "the same of the faces at x_min, y_min and z_min; the one that lets fluid slip more "
               "counts"});
    visit("walls.slip_max", s.walls.slipMax,
          Knob{"m", -1, 1e6f, "the same of the faces at x_max, y_max and z_max"});

    visit("time.mode", s.time.mode,
          Knob{"", 0, 0,
               "fixed step, the largest that is good for all, or local: each particle's own, and "
               "rest for who is calm"});
    visit("time.integrator", s.time.integrator,
          Knob{"", 0, 0,
               "symplectic_euler (semi-implicit): first order; velocity_verlet: second order for "
               "the same work, of carried density "
               "nearly; predictor_corrector: second order, evaluates everything twice a step; "
               "split: first order, viscosity and "
               "external forces first, then the pressure that follows from them, for delta_sph",
               Restart});
    visit("time.step", s.time.step, Knob{"s", 1e-12f, 100, "time step when fixed"});
    visit("time.cfl", s.time.cfl, Knob{"", 0.01f, 1, "Courant number: share of the stable step"});
    visit("time.max_step", s.time.maxStep,
          Knob{"s", 0, 1e6f,
               "longest step that cfl and local take, 0 = what sound, forces and viscosity allow"});
    visit("time.rest_speed", s.time.restSpeed,
          Knob{"", 0, 0.1f,
               "local: slower than this share of the speed of sound, fluid may fall asleep; 0 = "
               "never"});
    visit("time.retries", s.time.retries,
          Knob{"", 0, 8,
               "how often a run in trouble goes back to its last good state and on with half the "
               "step"});
    visit("solver.density_error", s.solver.densityError,
          Knob{"", 1e-6f, 0.1f,
               "incompressible: pressures are good enough when densities are too large by less, in "
               "the mean, as a share of the rest density"});
    visit("solver.iterations", s.solver.iterations,
          Knob{"", 2, 10000, "incompressible: at most, for the pressures of a step"});
    visit("solver.density_share", s.solver.densityShare,
          Knob{"", 0.01f, 1, "incompressible: share of an error of density that a step takes out"});
    visit("solver.relaxation", s.solver.relaxation,
          Knob{"", 0.05f, 1.5f,
               "incompressible: how far pressures go in an iteration, share of what a lattice of "
               "particles is sure to bear"});
}

template <class S, class Visitor> void visitFluid(S& s, Visitor&& visit) {
    auto& f = s.fluid;
    visit("fluid.rest_density", f.restDensity,
          Knob{"kg/m³", 1e-3f, 1e5f, "density at rest", Restart});
    visit("fluid.particle_mass", f.particleMass,
          Knob{"kg", 0, 1e18f,
               "mass of a particle, 0 = rest density x its cell of the lattice; in two dimensions "
               "kg/m",
               Restart});
    visit("fluid.sound_speed", f.soundSpeed,
          Knob{"m/s", 0, 1e4f, "speed of sound, 0 = speed_ratio x the expected speed"});
    visit("fluid.speed_ratio", f.speedRatio,
          Knob{"", 1, 100, "speed of sound / largest expected speed"});
    visit("fluid.viscosity", f.viscosity, Knob{"Pa s", 0, 1000, "dynamic viscosity, 0 = off"});
    visit("fluid.viscosity_form", f.viscosityForm,
          Knob{"", 0, 0,
               "sum that stands for viscosity: morris, along the difference of velocities, which "
               "drags fluid at free surfaces; monaghan, along the line between particles, which "
               "doesn't and keeps angular momentum; auto = morris in transport_velocity, else "
               "monaghan",
               Restart});
    visit("fluid.artificial_viscosity", f.artificialViscosity,
          Knob{"", 0, 2, "alpha of Monaghan's artificial viscosity, 0 = off"});
    visit("fluid.density_diffusion", f.densityDiffusion,
          Knob{"", 0, 1, "delta where density is carried, 0 = off"});
    visit("fluid.shifting", f.shifting,
          Knob{"", 0, 4,
               "strength of particle shifting, delta_plus and transport_velocity, 0 = off"});
    visit("fluid.equation_of_state", f.equationOfState,
          Knob{"", 0, 0, "pressure from density", Restart});
    visit("fluid.gamma", f.gamma, Knob{"", 1, 10, "exponent of the Tait equation"});
    visit("fluid.stiffness", f.stiffness,
          Knob{"Pa", 0, 1e10f, "pressure scale, 0 = rest density x sound speed^2 / gamma"});
    visit("fluid.background_pressure", f.backgroundPressure,
          Knob{"Pa", 0, 1e8f,
               "p0 of p = p0 + k ((rho / rho0)^gamma - 1): for fluid that fills its space; "
               "surfaces are pushed apart by it"});
    visit("fluid.surface_tension", f.surfaceTension,
          Knob{"N/m", 0, 1000, "of free surfaces (delta_plus), 0 = off"});
    visit("fluid.velocity_transfer", f.velocityTransfer,
          Knob{"1/s", 0, 1e4f,
               "rate at which neighbours take over each other's velocity, 0 = off: viscosity that "
               "does not ask for its unit"});
    visit("fluid.buoyancy", f.buoyancy,
          Knob{"", 0, 100,
               "who is lighter than the mean in its support rises with this times gravity times "
               "the share, 0 = off"});
    visit("fluid.dissipation", f.dissipation,
          Knob{"1/s", 0, 100, "rate at which all motion fades, 0 = off"});
    visit("fluid.air_density", f.airDensity,
          Knob{"kg/m³", 0, 100, "of air that slows drops and surfaces (wcsph), 0 = none"});
    visit("fluid.drag_coefficient", f.dragCoefficient,
          Knob{"", 0, 10, "of a particle in that air, a sphere of its volume"});
    visit("fluid.wind", f.wind, Knob{"m/s", -1e3f, 1e3f, "velocity of that air"});
}

template <class V, class Visitor> void visitColors(V& v, Visitor&& visit) {
    visit("view.style", v.style,
          Knob{"", 0, 0,
               "fluid as its particles, or as a surface with light behind it; of one colour where "
               "color_by is plain"});
    visit("view.color_by", v.colorBy,
          Knob{"", 0, 0,
               "what colours the particles; vorticity is signed in two dimensions, neighbours are "
               "those within the support, time_bin is of local steps: -1 = at rest"});
    visit("view.color_map", v.colorMap, Knob{"", 0, 0, "table of colours"});
    visit(
        "view.color_file", v.colorFile,
        Knob{"", 0, 0,
             "of color_map file: .csv with columns r, g, b, of 0 to 255 or 0 to 1, or .json, a "
             "list of [r, g, b] or a colour map as ParaView exports it; a relative path starts at "
             "the scene file"});
    visit("view.color_scale", v.colorScale,
          Knob{"", 0, 0,
               "colours by the quantity or by its logarithm, over four powers of ten at most "
               "unless the range is fixed"});
    visit("view.range", v.range,
          Knob{"", 0, 0, "colour range: of each frame, of the run so far, or fixed"});
    visit("view.range_min", v.rangeMin,
          Knob{"", -1e9f, 1e9f, "fixed range, lower end, unit of the quantity"});
    visit("view.range_max", v.rangeMax,
          Knob{"", -1e9f, 1e9f, "fixed range, upper end, unit of the quantity"});
    visit("view.theme", v.theme, Knob{"", 0, 0, "dark or light background and panel"});
}

// What of the fluid is shown, and what is drawn into it.
template <class V, class Visitor> void visitInside(V& v, Visitor&& visit) {
    visit("view.threshold.on", v.threshold.on,
          Knob{"", 0, 0, "shows only fluid whose coloured quantity is from min to max"});
    visit("view.threshold.min", v.threshold.min,
          Knob{"", -1e9f, 1e9f, "least that is shown, unit of the quantity"});
    visit("view.threshold.max", v.threshold.max,
          Knob{"", -1e9f, 1e9f, "most that is shown, unit of the quantity"});
    visit("view.clip.min", v.clip.min,
          Knob{"", 0, 1,
               "lower corner of the box of which fluid is shown, shares of the domain; 0 = all on "
               "that side"});
    visit("view.clip.max", v.clip.max, Knob{"", 0, 1, "its upper corner; 1 = all on that side"});
    visit("view.clip.solids", v.clip.solids,
          Knob{"", 0, 0, "cuts solids, elastic objects and boundary particles as well"});
    visit("view.slice.axis", v.slice.axis,
          Knob{"", 0, 0,
               "axis across which a plane shows the coloured quantity between the particles, by "
               "SPH interpolation"});
    visit("view.slice.position", v.slice.position,
          Knob{"", 0, 1, "of the plane along its axis, share of the domain"});
    visit("view.slice.contours", v.slice.contours,
          Knob{"", 0, 50,
               "about how many lines of one value it has over the colour range, at round values"});
    visit("view.slice.fluid", v.slice.fluid,
          Knob{"", 0, 0, "draws the fluid as well; clip it to see the plane"});
    visit("view.arrows.count", v.arrows.count,
          Knob{"", 0, 100,
               "arrows of velocity along the domain's longest side, of the fluid around points of "
               "a grid, in the slice's plane where there is one; 0 = none"});
    visit("view.arrows.length", v.arrows.length,
          Knob{"", 0.1f, 10, "of the longest arrow / the grid's step"});
}

template <class S, class Visitor> void visitPicture(S& s, Visitor&& visit) {
    auto& v = s.view;
    visitColors(v, visit);
    visit("view.show_walls", v.showWalls, Knob{"", 0, 0, "draws the boundary particles"});
    visit("view.show_outline", v.showOutline, Knob{"", 0, 0, "draws the edges of the box"});
    visit("view.show_ground", v.showGround, Knob{"", 0, 0, "draws the ground"});
    visit("view.show_axes", v.showAxes, Knob{"", 0, 0, "draws which way x, y and z are"});
    visit("view.show_scale", v.showScale,
          Knob{"", 0, 0,
               "draws a bar of a known length, as it is where the camera looks, and says how large "
               "the ground's cells are"});
    visit("view.projection", v.projection,
          Knob{"", 0, 0, "perspective, or orthographic: nothing gets smaller with distance"});
    visit(
        "view.up", v.up,
        Knob{"", 0, 0,
             "direction that is up in pictures; auto = against gravity as the run begins with it, "
             "y where there is none or it acts along a periodic axis"});
    visit("view.solid_particles", v.solidParticles,
          Knob{"", 0, 0, "draws the particles of solids instead of their shapes"});
    visit("view.particle_scale", v.particleScale, Knob{"", 0.05f, 5, "drawn diameter / spacing"});
    visit("view.speed", v.speed,
          Knob{"x real time", 0.01f, 10,
               "how fast the window plays: simulated seconds for one of the clock's"});
    visit("view.history", v.history,
          Knob{"MB", 0, 1e6f,
               "memory for moments of the run that the window can go back to, evenly over all of "
               "it; 0 = none"});
    visit("view.path_of", v.pathOf,
          Knob{"", -1, 1e9f,
               "number of a fluid particle whose path is drawn, as of the first picture with it; "
               "-1 = none. A double click sets it to the one that is picked"});

    visitInside(v, visit);

    auto& stir = v.stir;
    visit("view.stir.mode", stir.mode,
          Knob{"", 0, 0,
               "what Ctrl + drag does to the fluid: drags it along, pulls it to the mouse or "
               "pushes it away"});
    visit("view.stir.strength", stir.strength, Knob{"", 0.05f, 10, "how firmly"});
    visit("view.stir.radius", stir.radius,
          Knob{"m", 0, 1e4f,
               "how far around the mouse, 0 = an eighth of the domain's shortest side"});

    auto& c = v.camera;
    visit("view.camera.yaw", c.yaw, Knob{"degrees", -360, 360, "turn about the vertical"});
    visit("view.camera.pitch", c.pitch, Knob{"degrees", -90, 90, "height of the view"});
    visit("view.camera.distance", c.distance,
          Knob{"m", 0, 1e8f, "distance to the target, 0 = fits the box"});
    visit("view.camera.field_of_view", c.fieldOfView,
          Knob{"degrees", 5, 120, "vertical angle of view"});
    visit("view.camera.automatic_target", c.automaticTarget,
          Knob{"", 0, 0, "looks at the box's centre"});
    visit("view.camera.target", c.target,
          Knob{"m", -1e7f, 1e7f, "point looked at when not automatic"});
}

template <class S, class Visitor> void visitOutput(S& s, Visitor&& visit) {
    auto& o = s.output;
    visit("output.headless", o.headless, Knob{"", 0, 0, "runs without a window", Restart});
    visit("output.time", o.time,
          Knob{"s", 0, 1e6f, "simulated time to run, 0 = by compute.steps", Restart});
    visit("output.screenshot", o.screenshot, Knob{"", 0, 0, "PNG of the last state", Restart});
    visit("output.frames", o.frames, Knob{"", 0, 0, "folder for a sequence of PNGs", Restart});
    visit("output.fps", o.fps,
          Knob{"1/s", 0.01f, 1e5f, "frames a second of simulated time", Restart});
    visit("output.csv", o.csv, Knob{"", 0, 0, "CSV time series, - = standard output", Restart});
    visit("output.json", o.json, Knob{"", 0, 0, "JSON time series, - = standard output", Restart});
    visit("output.checkpoint", o.checkpoint,
          Knob{"", 0, 0,
               "HDF5 file from which the run can go on, written at its end and when it is stopped",
               Restart});
    visit("output.checkpoint_every", o.checkpointEvery,
          Knob{"s", 0, 1e6f, "simulated time between checkpoints, 0 = at the end only", Restart});
    visit("output.particles", o.particles,
          Knob{"", 0, 0,
               "the last state's particles, .csv or .h5: what a body of shape file can start "
               "another run with",
               Restart});
    visit("output.hdf5", o.hdf5,
          Knob{"", 0, 0, "HDF5 time series: a dataset with its unit for each column", Restart});
    visit("output.sample_every", o.sampleEvery,
          Knob{"s", 0, 1e6f,
               "simulated time between rows of the series, for impacts shorter than a frame; 0 = "
               "with the frames, by output.fps",
               Restart});
    visit("output.series", o.series,
          Knob{"", 0, 0,
               "particles and solids at every frame, by output.fps: .pvd (VTK, ParaView), .xdmf "
               "(HDF5), .ply or .csv; files are in a folder of that name",
               Restart});
    visit("output.fields", o.fields,
          Knob{"", 0, 0,
               "of particles in output.series: velocity, acceleration, density, pressure, mass, "
               "fluid",
               Restart});
    visit("output.surface", o.surface,
          Knob{"", 0, 0,
               "the surface of the fluid at every frame, by output.fps, as triangles (.ply, .obj) "
               "or as a level set (.vdb); files are in a folder of that name",
               Restart});
    visit("output.surface_anisotropic", o.surfaceAnisotropic,
          Knob{"", 0, 0, "of kernels that are flat along the surface: smoother, for twice the time",
               Restart});
    visit("output.video", o.video,
          Knob{"", 0, 0,
               "film of the run, .mp4, .mkv or .webm, made by ffmpeg; output.fps frames a second "
               "of simulated time, shown 60 a second at most",
               Restart});
    visit("output.face_forces", o.faceForces,
          Knob{"", 0, 0,
               "columns of the series: the force of fluid on each face of the domain, of pressure "
               "and of viscosity",
               Restart});
    visit("output.energy_balance", o.energyBalance,
          Knob{"", 0, 0,
               "columns of the series: work done on the fluid, what each term has dissipated, "
               "energy of compression, and what is left that nothing explains; a step takes "
               "2.7 to 3.4 times as long (incompressible 1.2)",
               Restart});
    visit("output.strict", o.strict,
          Knob{"", 0, 0, "results outside the validity of the method are an error, not a remark",
               Restart});
}

}  // namespace schema

// Calls visit(path, value, knob) for every knob of the scene. `visit` is a callable for float, int,
// bool, std::string, Vec3, Vec3d, Keyframes, Rates and every enumeration above; values are
// references into the scene (const when it is).
template <class S, class Visitor>
requires std::is_same_v<std::remove_const_t<S>, Scene>
void visitKnobs(S& scene, Visitor&& visit) {
    schema::visitProgram(scene, visit);
    schema::visitPhysics(scene, visit);
    schema::visitMembers(scene.solids, "solids", visit);
    schema::visitMembers(scene.objects, "objects", visit);
    schema::visitMembers(scene.grips, "grips", visit);
    schema::visitMembers(scene.cuts, "cuts", visit);
    schema::visitMembers(scene.sources, "sources", visit);
    schema::visitMembers(scene.sinks, "sinks", visit);
    schema::visitContact(scene.contact, visit);
    schema::visitFluid(scene, visit);
    schema::visitMembers(scene.fluid.bodies, "fluid.bodies", visit);
    schema::visitPicture(scene, visit);
    schema::visitOutput(scene, visit);
    schema::visitMembers(scene.output.probes, "output.probes", visit);
}

}  // namespace spindrift
