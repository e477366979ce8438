#pragma once
// The one list of knobs: path, value, unit, range, help. Everything that reads or shows a knob
// walks it: JSON reader and writer, --set, the panel, --help, JSON Schema, range checks.
#include "scene/scene.h"

#include <array>
#include <string>
#include <type_traits>

namespace spindrift {

struct Knob {
    const char* unit;  // "" when the value is a plain number, a name or a switch
    float min,
        max;  // both allowed; per component for vectors; no meaning for names, switches and text
    const char* help;
    bool live = true;  // a running simulation takes it over at once; otherwise the scene restarts
};
inline constexpr bool Restart = false;

// The names of an enumeration's values, in their order.
constexpr auto enumNames(Backend) { return std::array{"auto", "cpu", "cuda"}; }
constexpr auto enumNames(Precision) { return std::array{"float", "double"}; }
constexpr auto enumNames(Simd) { return std::array{"auto", "avx512", "avx2", "sse"}; }
constexpr auto enumNames(Formulation) {
    return std::array{"wcsph",   "delta_sph",     "delta_plus", "transport_velocity",
                      "classic", "incompressible"};
}
constexpr auto enumNames(Kernel) {
    return std::array{"wendland_c2", "cubic_spline",   "wendland_c4",
                      "wendland_c6", "quintic_spline", "mueller"};
}
constexpr auto enumNames(PressureForm) { return std::array{"squares", "mean"}; }
constexpr auto enumNames(ViscosityForm) { return std::array{"auto", "morris", "monaghan"}; }
constexpr auto enumNames(EquationOfState) { return std::array{"tait", "linear"}; }
constexpr auto enumNames(WallKind) { return std::array{"reflect", "particles"}; }
constexpr auto enumNames(TimeMode) { return std::array{"fixed", "cfl", "local"}; }
constexpr auto enumNames(Integrator) {
    return std::array{"symplectic_euler", "velocity_verlet", "predictor_corrector", "split"};
}
constexpr auto enumNames(Shape) {
    return std::array{"block", "sphere", "cylinder", "wedge", "plane", "mesh", "file"};
}
constexpr auto enumNames(Axis) { return std::array{"x", "y", "z"}; }
constexpr auto enumNames(Up) { return std::array{"auto", "x", "y", "z", "-x", "-y", "-z"}; }
constexpr auto enumNames(ColorBy) {
    return std::array{"plain",        "velocity",   "pressure",   "density",
                      "acceleration", "id",         "fluid",      "surface",
                      "velocity_x",   "velocity_y", "velocity_z", "vorticity",
                      "shear_rate",   "divergence", "neighbours", "time_bin"};
}
constexpr auto enumNames(DrawStyle) { return std::array{"spheres", "surface"}; }
constexpr auto enumNames(ColorMap) {
    return std::array{"viridis", "cividis", "turbo", "coolwarm", "file"};
}
constexpr auto enumNames(ColorScale) { return std::array{"linear", "logarithmic"}; }
constexpr auto enumNames(Theme) { return std::array{"dark", "light"}; }
constexpr auto enumNames(Projection) { return std::array{"perspective", "orthographic"}; }
constexpr auto enumNames(Across) { return std::array{"none", "x", "y", "z"}; }
constexpr auto enumNames(Field) {
    return std::array{"uniform", "taylor_green", "stretching",   "rotation",
                      "shear",   "sound_wave",   "standing_wave"};
}
constexpr auto enumNames(StartPlaces) { return std::array{"lattice", "relaxed"}; }
constexpr auto enumNames(StartPressure) { return std::array{"none", "hydrostatic"}; }
constexpr auto enumNames(Face) {
    return std::array{"none", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
}
constexpr auto enumNames(RangeMode) { return std::array{"frame", "run", "fixed"}; }

constexpr auto enumNames(StirMode) { return std::array{"drag", "attract", "repel"}; }

constexpr auto enumNames(ProbeKind) { return std::array{"point", "line", "height", "front"}; }
constexpr auto enumNames(ObjectShape) { return std::array{"block", "sheet", "tube", "shell"}; }
constexpr auto enumNames(Mouth) { return std::array{"rectangle", "disc"}; }
constexpr auto enumNames(Profile) { return std::array{"uniform", "parabolic"}; }
constexpr auto enumNames(Order) { return std::array{"mean", "linear"}; }

// Which knobs a shape has depends on which it is; that is visited first, so that a reader has set
// it before the others are chosen.
template <class F, class Visitor> void visitForm(F& f, const std::string& at, Visitor&& visit) {
    visit(
        at + ".shape", f.shape,
        Knob{
            "", 0, 0,
            "block, sphere, cylinder, wedge, or mesh: triangles of a file; of fluid also file: the "
            "particles of another run or program; of obstacles also plane: all that is behind it",
            Restart});
    if (f.shape == Shape::Mesh) {
        visit(at + ".path", f.path,
              Knob{"", 0, 0,
                   "closed surfaces of triangles or polygons, OBJ, STL, PLY or glTF; a relative "
                   "path starts at the scene file",
                   Restart});
        visit(at + ".scale", f.scale, Knob{"", 1e-6f, 1e6f, "m per unit of the file", Restart});
        visit(at + ".offset", f.offset,
              Knob{"m", -1e7f, 1e7f, "where the file's origin is", Restart});
        return;
    }
    if (f.shape == Shape::File) return;
    if (f.shape == Shape::Block || f.shape == Shape::Wedge) {
        visit(at + ".min", f.min, Knob{"m", -1e7f, 1e7f, "lower corner", Restart});
        visit(at + ".max", f.max, Knob{"m", -1e7f, 1e7f, "upper corner", Restart});
    } else {
        visit(at + ".center", f.center,
              Knob{"m", -1e7f, 1e7f, "centre; of a plane any of its points", Restart});
        if (f.shape == Shape::Plane) return;
        visit(at + ".radius", f.radius, Knob{"m", 1e-9f, 1e7f, "radius", Restart});
    }
    if (f.shape == Shape::Cylinder) {
        visit(at + ".height", f.height, Knob{"m", 1e-9f, 1e7f, "length along the axis", Restart});
        visit(at + ".axis", f.axis, Knob{"", 0, 0, "direction of the axis", Restart});
    }
}

// Visits the knobs of one member of a list; `at` is its path, e.g. "fluid.bodies[0]".
template <class B, class Visitor>
requires std::is_same_v<std::remove_const_t<B>, Body>
void visitMember(B& b, const std::string& at, Visitor&& visit) {
    visitForm(b, at, visit);
    visit(
        at + ".name", b.name,
        Knob{"", 0, 0, "of its fluid, in the legend of a mixture; without one its density names it",
             Restart});
    visit(at + ".rest_density", b.restDensity,
          Knob{"kg/m³", 0, 1e5f,
               "of this body's fluid, 0 = fluid.rest_density; with another one fluids lie above "
               "each other",
               Restart});
    visit(at + ".viscosity", b.viscosity,
          Knob{"Pa s", -1, 1000, "of this body's fluid, -1 = fluid.viscosity", Restart});
    if (b.shape == Shape::File) {
        visit(at + ".path", b.path,
              Knob{"", 0, 0,
                   "CSV with a header, or HDF5: x, y, z, and if there are any vx, vy, vz, rho, p, "
                   "mass, fluid; all of them are taken, also inside "
                   "other bodies. fluid: the entry of fluid.bodies, from 0 on, whose rest_density "
                   "and viscosity a particle has. Without mass each has that of spacing^3. As "
                   "output.particles "
                   "writes it; a relative path starts at the scene file",
                   Restart});
        visit(at + ".mass", b.mass,
              Knob{"kg", 0, 1e9f,
                   "of each particle, in two dimensions of a metre of depth; 0 = as the file says",
                   Restart});
        visit(at + ".relax", b.relax,
              Knob{"", 0, 0,
                   "pushes the particles apart until they lie evenly where they are, for those of "
                   "other programs, which may begin uneven; velocities and pressures stay",
                   Restart});
        return;
    }
    visit(at + ".velocity", b.velocity, Knob{"m/s", -1e3f, 1e3f, "initial velocity", Restart});
    visit(
        at + ".field", b.field,
        Knob{
            "", 0, 0,
            "velocity at the start: the same everywhere, or a flow of that amplitude: Taylor-Green "
            "vortices as wide as the domain; a sound wave as long as the domain that travels along "
            "x; a standing wave, as long as the domain, of the surface above the body's floor, "
            "deep "
            "water's; stretching along x, rotation or shear in x and y, "
            "about the body's centre, with that speed at the end of its largest half side",
            Restart});
    visit(at + ".pressure", b.pressure,
          Knob{"", 0, 0,
               "at the start, where density is carried: none, or of the column above in this body",
               Restart});
}
template <class S, class Visitor>
requires std::is_same_v<std::remove_const_t<S>, Solid>
void visitMember(S& s, const std::string& at, Visitor&& visit) {
    visitForm(s, at, visit);
    if (s.shape == Shape::Plane)
        visit(at + ".normal", s.normal,
              Knob{"", -1e4f, 1e4f, "of a plane, to the side where fluid is; of any length",
                   Restart});
    visit(at + ".name", s.name, Knob{"", 0, 0, "of its columns in time series", Restart});
    visit(at + ".velocity", s.velocity,
          Knob{"m/s", -1e3f, 1e3f, "with which it goes on and on; of one that floats at the start",
               Restart});
    visit(at + ".spin", s.spin, Knob{"degrees/s", -1e5f, 1e5f, "turns about its middle", Restart});
    visit(at + ".spin_axis", s.spinAxis,
          Knob{"", 0, 0, "direction of the axis that it turns about", Restart});
    if (s.shape != Shape::Plane)
        visit(at + ".turn", s.turn,
              Knob{"degrees", -360, 360,
                   "how far it is turned about that axis, through its middle, at the start; "
                   "keyframes turn it on from there",
                   Restart});
    visit(at + ".keyframes", s.keyframes,
          Knob{"", -1e7f, 1e7f,
               "where it is when: [[t, x, y, z], ...] or [[t, x, y, z, turn], ...] in s, m and "
               "degrees, relative to its place here; at rest before and after. On straight lines "
               "between, or where its velocity changes alike from one to the next on a smooth "
               "curve. [[t, x, y, z, turn, vx, vy, vz, spin], ...] say how fast it is as well",
               Restart});
    visit(at + ".motion", s.motion,
          Knob{"", 0, 0,
               "CSV with the keyframes, columns t, x, y, z or t, vx, vy, vz, and turn if it turns; "
               "s, m and degrees, or units of the header, as x [mm]; velocities change evenly "
               "between their rows",
               Restart});
    visit(at + ".density", s.density,
          Knob{"kg/m³", 0, 1e5f,
               "lets it float: fluid, gravity and what it touches move it, velocity and spin are "
               "those at the start; 0 = it moves as prescribed",
               Restart});
    visit(at + ".slip", s.slip,
          Knob{"m", -1, 1e6f,
               "Navier's slip length of its surface, 0 = fluid sticks to it, -1 = fluid slides "
               "freely",
               Restart});
    visit(at + ".friction", s.friction,
          Knob{"", 0, 10,
               "of what floats: Coulomb's coefficient where it touches walls and other solids; the "
               "lower one counts",
               Restart});
}

template <class O, class Visitor>
requires std::is_same_v<std::remove_const_t<O>, Object>
void visitMember(O& o, const std::string& at, Visitor&& visit) {
    visit(at + ".shape", o.shape,
          Knob{"", 0, 0,
               "block, sheet (flat along the axis on which min and max are the same), tube, open "
               "at both ends, or shell: triangles of a file",
               Restart});
    if (o.shape == ObjectShape::Tube) {
        visit(at + ".center", o.center, Knob{"m", -1e7f, 1e7f, "centre", Restart});
        visit(at + ".radius", o.radius,
              Knob{"m", 1e-9f, 1e7f, "to the middle of the wall", Restart});
        visit(at + ".height", o.height, Knob{"m", 1e-9f, 1e7f, "length along the axis", Restart});
        visit(at + ".axis", o.axis, Knob{"", 0, 0, "direction of the axis", Restart});
    } else if (o.shape == ObjectShape::Shell) {
        visit(at + ".path", o.path,
              Knob{"", 0, 0,
                   "closed surfaces of triangles or polygons, OBJ, STL, PLY or glTF; a relative "
                   "path starts at the scene file",
                   Restart});
        visit(at + ".scale", o.scale, Knob{"", 1e-6f, 1e6f, "m per unit of the file", Restart});
        visit(at + ".offset", o.offset,
              Knob{"m", -1e7f, 1e7f, "where the file's origin is", Restart});
    } else {
        visit(at + ".min", o.min, Knob{"m", -1e7f, 1e7f, "lower corner", Restart});
        visit(at + ".max", o.max, Knob{"m", -1e7f, 1e7f, "upper corner", Restart});
    }
    if (o.shape != ObjectShape::Block)
        visit(at + ".thickness", o.thickness,
              Knob{"m", 1e-9f, 1e7f,
                   "of its wall: one layer of particles, more where it is thicker than a spacing",
                   Restart});
    visit(at + ".spacing", o.spacing,
          Knob{"m", 0, 1e4f, "of its particles, 0 = simulation.spacing", Restart});
    visit(at + ".density", o.density, Knob{"kg/m³", 1e-3f, 1e5f, "of what it is made of", Restart});
    visit(at + ".youngs_modulus", o.youngsModulus,
          Knob{"Pa", 0, 1e12f, "how stiff it is; Poisson's ratio is 1/4, of a single layer 1/3",
               Restart});
    visit(at + ".damping", o.damping,
          Knob{"", 0, 2, "of its bonds, share of the critical one", Restart});
    visit(at + ".breaking_strain", o.breakingStrain,
          Knob{"", 0, 1e3f, "at which bonds break for good, 0 = never", Restart});
    visit(at + ".velocity", o.velocity, Knob{"m/s", -1e3f, 1e3f, "initial velocity", Restart});
}
template <class G, class Visitor>
requires std::is_same_v<std::remove_const_t<G>, Grip>
void visitMember(G& g, const std::string& at, Visitor&& visit) {
    visit(at + ".min", g.min, Knob{"m", -1e7f, 1e7f, "lower corner", Restart});
    visit(at + ".max", g.max, Knob{"m", -1e7f, 1e7f, "upper corner", Restart});
    visit(at + ".velocity", g.velocity,
          Knob{"m/s", -1e3f, 1e3f, "with which it goes on and on", Restart});
    visit(at + ".keyframes", g.keyframes,
          Knob{"", -1e7f, 1e7f,
               "where it is when, relative to its place here: [[t, x, y, z], ...] in s and m",
               Restart});
}
template <class C, class Visitor>
requires std::is_same_v<std::remove_const_t<C>, Cut>
void visitMember(C& c, const std::string& at, Visitor&& visit) {
    visit(at + ".time", c.time, Knob{"s", 0, 1e6f, "when it cuts", Restart});
    visit(at + ".min", c.min, Knob{"m", -1e7f, 1e7f, "lower corner", Restart});
    visit(at + ".max", c.max, Knob{"m", -1e7f, 1e7f, "upper corner", Restart});
}

template <class S, class Visitor>
requires std::is_same_v<std::remove_const_t<S>, Source>
void visitMember(S& s, const std::string& at, Visitor&& visit) {
    visit(at + ".mouth", s.mouth, Knob{"", 0, 0, "what fluid comes out of", Restart});
    visit(at + ".name", s.name, Knob{"", 0, 0, "in messages", Restart});
    visit(at + ".center", s.center, Knob{"m", -1e7f, 1e7f, "of the mouth", Restart});
    visit(at + ".normal", s.normal,
          Knob{"", -1e4f, 1e4f, "to where the fluid goes; of any length", Restart});
    if (s.mouth == Mouth::Rectangle) {
        visit(at + ".width", s.width,
              Knob{"m", 1e-9f, 1e7f, "across the normal and the height", Restart});
        visit(at + ".height", s.height,
              Knob{"m", 1e-9f, 1e7f,
                   "along z as far as the normal allows, along y of a mouth that looks along z; "
                   "not in two dimensions",
                   Restart});
    } else {
        visit(at + ".radius", s.radius, Knob{"m", 1e-9f, 1e7f, "radius", Restart});
    }
    visit(at + ".velocity", s.velocity, Knob{"m/s", 0, 1e3f, "mean over the mouth", Restart});
    visit(at + ".flow", s.flow,
          Knob{"m³/s", 0, 1e9f, "instead of a velocity; in two dimensions m²/s", Restart});
    visit(at + ".path", s.path,
          Knob{"", 0, 0,
               "instead of both: CSV with the columns t and velocity, or t and flow; they change "
               "evenly between its rows. A relative path starts at the scene file",
               Restart});
    visit(at + ".profile", s.profile,
          Knob{"", 0, 0,
               "of velocities in the mouth: uniform, or parabolic (Poiseuille): across the width "
               "of a rectangle, from the middle of a disc",
               Restart});
    visit(at + ".start", s.start, Knob{"s", 0, 1e6f, "when it is opened", Restart});
    visit(at + ".stop", s.stop, Knob{"s", 0, 1e6f, "and closed, 0 = never", Restart});
    visit(at + ".volume", s.volume,
          Knob{"m³", 0, 1e9f, "after which it is closed, 0 = no limit; in two dimensions m²",
               Restart});
}
template <class S, class Visitor>
requires std::is_same_v<std::remove_const_t<S>, Sink>
void visitMember(S& s, const std::string& at, Visitor&& visit) {
    visit(at + ".min", s.min, Knob{"m", -1e7f, 1e7f, "lower corner", Restart});
    visit(at + ".max", s.max, Knob{"m", -1e7f, 1e7f, "upper corner", Restart});
}

template <class P, class Visitor>
requires std::is_same_v<std::remove_const_t<P>, Probe>
void visitMember(P& p, const std::string& at, Visitor&& visit) {
    visit(at + ".kind", p.kind,
          Knob{"", 0, 0,
               "point and line: pressure, density and velocity of the fluid there; height: of the "
               "water, as a gauge "
               "along an axis sees it; front: how far 99.5 % of the fluid have come along an axis",
               Restart});
    const bool interpolates = p.kind == ProbeKind::Point || p.kind == ProbeKind::Line;
    visit(at + ".name", p.name,
          Knob{"", 0, 0, "begins the names of its columns: letters, digits, _ and -", Restart});
    if (p.kind == ProbeKind::Point || p.kind == ProbeKind::Height)
        visit(at + ".position", p.position,
              Knob{"m", -1e7f, 1e7f, "where it is; of a height across its axis", Restart});
    if (p.kind == ProbeKind::Point)
        visit(at + ".radius", p.radius,
              Knob{"m", 0, 1e7f,
                   "of a sensor that sees a mean: of a disc on a face of the domain, elsewhere of "
                   "a ball",
                   Restart});
    if (p.kind == ProbeKind::Line) {
        visit(at + ".from", p.from, Knob{"m", -1e7f, 1e7f, "first point", Restart});
        visit(at + ".to", p.to, Knob{"m", -1e7f, 1e7f, "last point", Restart});
        visit(at + ".count", p.count, Knob{"", 2, 10000, "points, evenly spaced", Restart});
    }
    if (!interpolates)
        visit(at + ".axis", p.axis, Knob{"", 0, 0, "direction in which it reads", Restart});
    if (interpolates)
        visit(at + ".order", p.order,
              Knob{"", 0, 0,
                   "mean: weighted mean of the particles near, never beyond their values: for "
                   "splashes and impacts; linear: "
                   "least squares, exact for linear fields up to the wall: for calm fluid",
                   Restart});
}

// Calls visit(path, list, what) for each list of objects that a scene has. The members' knobs are
// visitKnobs'.
template <class S, class Visitor>
requires std::is_same_v<std::remove_const_t<S>, Scene>
void visitLists(S& scene, Visitor&& visit) {
    visit("solids", scene.solids, "obstacles");
    visit("objects", scene.objects, "elastic objects");
    visit("grips", scene.grips, "what holds or moves parts of objects");
    visit("cuts", scene.cuts, "blades that cut objects");
    visit("sources", scene.sources, "taps and inlets, of which fluid comes");
    visit("sinks", scene.sinks, "drains and outlets, where fluid leaves");
    visit("fluid.bodies", scene.fluid.bodies, "bodies of fluid");
    visit("output.probes", scene.output.probes,
          "gauges whose readings are columns of the time series");
}

// One member for each shape, or kind: together they have every knob of their list.
inline Shape& kindOf(Form& f) { return f.shape; }
inline ProbeKind& kindOf(Probe& p) { return p.kind; }
inline ObjectShape& kindOf(Object& o) { return o.shape; }
inline Mouth& kindOf(Source& s) { return s.mouth; }
template <class Member> std::vector<Member> oneOfEachKind() {
    if constexpr (!requires(Member & m) { kindOf(m); })
        return std::vector<Member>(1);
    else {
        using Kind = std::decay_t<decltype(kindOf(std::declval<Member&>()))>;
        std::vector<Member> members(enumNames(Kind()).size());
        for (size_t k = 0; k < members.size(); ++k) kindOf(members[k]) = Kind(k);
        return members;
    }
}

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
// bool, std::string, Vec3, Vec3d, Keyframes and every enumeration above; values are references into
// the scene (const when it is).
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
