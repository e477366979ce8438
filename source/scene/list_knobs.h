#pragma once
// The knobs of what a scene has lists of: bodies, obstacles, elastic objects, sources, probes.
#include "scene/knob.h"

#include <string>
#include <type_traits>
#include <vector>

namespace spindrift {

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
    visit(at + ".velocities", s.velocities,
          Knob{"m/s", 0, 1e3f, "over time: [[t, velocity], ...], evenly between", Restart});
    visit(at + ".flows", s.flows,
          Knob{"m³/s", 0, 1e9f, "over time: [[t, flow], ...], evenly between", Restart});
    visit(at + ".path", s.path,
          Knob{"", 0, 0,
               "CSV with velocities or flows, columns t and velocity, or t and flow; a relative "
               "path starts at the scene file",
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

}  // namespace spindrift
