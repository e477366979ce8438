#include "measure/checkpoint.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "core/output_file.h"
#include "scene/formulation.h"
#include "scene/json.h"
#include "scene/sample_object.h"
#include "scene/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace spindrift {
namespace {

using hdf5::Handle, hdf5::Trouble, hdf5::require;

constexpr const char* Format = "spindrift checkpoint";
constexpr int64_t Version = 7;  // 2: densities, where they are carried; 3: bodies, of mixtures; 4:
                                // motions of solids, objects; 5: per metre of depth in two
                                // dimensions; 6: solved pressures; 7: sources and sinks

// --- numbers and texts as attributes of the file ---

void writeNumbers(hid_t file, const char* name, const std::vector<double>& values) {
    const hsize_t n = values.size();
    Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, name);
    Handle attribute(H5Acreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose, name);
    require(H5Awrite(attribute, H5T_NATIVE_DOUBLE, values.data()), name);
}
std::vector<double> readNumbers(hid_t file, const char* name, size_t count) {
    Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
    Handle space(H5Aget_space(attribute), H5Sclose, name);
    if (H5Sget_simple_extent_npoints(space) != hssize_t(count)) throw Trouble{name};
    std::vector<double> values(count);
    require(H5Aread(attribute, H5T_NATIVE_DOUBLE, values.data()), name);
    for (double v : values)
        if (!std::isfinite(v)) throw Trouble{name};
    return values;
}

// --- arrays ---

// [rows, columns], one row an element of T.
template <class T>
std::vector<T> readArray(hid_t file, const char* name, hid_t native, hsize_t columns) {
    const hdf5::Array array(file, name, 2);
    if (array.size[1] != columns) throw Trouble{name};
    std::vector<T> values(array.size[0] * columns / (sizeof(T) / H5Tget_size(native)));
    if (!values.empty())
        require(H5Dread(array.set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
    return values;
}
void writeFloats(hid_t file, const char* name, const std::string& unit, const void* data,
                 size_t rows, hsize_t columns) {
    hdf5::writeArray(file, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, data, {rows, columns});
    hdf5::writeUnit(file, name, unit);
}
void writeVectors(hid_t file, const char* name, const std::string& unit,
                  const std::vector<Vec3>& v) {
    writeFloats(file, name, unit, v.data(), v.size(), 3);
}
std::vector<Vec3> readVectors(hid_t file, const char* name) {
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    return readArray<Vec3>(file, name, H5T_NATIVE_FLOAT, 3);
}

// 13 numbers each.
std::vector<double> numbersOf(const std::vector<SolidMotion>& solids) {
    std::vector<double> out;
    for (const SolidMotion& m : solids) {
        for (const Vec3d& v : {m.centre + m.dragged, m.velocity, m.angularMomentum})
            out.insert(out.end(), {v.x, v.y, v.z});
        out.insert(out.end(), {m.turn.w, m.turn.x, m.turn.y, m.turn.z});
    }
    return out;
}
std::vector<SolidMotion> motionsOf(const Scene& scene, const std::vector<double>& numbers) {
    std::vector<SolidMotion> out;
    for (auto n = numbers.begin(); n != numbers.end(); n += 13) {
        SolidMotion m;
        (scene.solids[out.size()].floats() ? m.centre : m.dragged) = {n[0], n[1], n[2]};
        m.velocity = {n[3], n[4], n[5]}, m.angularMomentum = {n[6], n[7], n[8]};
        m.turn = {n[9], n[10], n[11], n[12]};
        out.push_back(m);
    }
    return out;
}

// A run that goes on needs no file of particles any more.
std::string sceneWithoutFiles(Scene scene) {
    const double volume = particleVolume(scene);
    for (Body& body : scene.fluid.bodies)
        if (body.shape == Shape::File) body.mass = float(restDensity(scene, body) * volume);
    return writeScene(scene);
}

void writeInts(hid_t file, const char* name, const std::vector<int>& values) {
    hdf5::writeArray(file, name, H5T_STD_I32LE, H5T_NATIVE_INT, values.data(), {values.size(), 1});
}

void writeSources(hid_t file, const RunState& s) {
    writeInts(file, "ids", s.particles.ids);
    writeInts(file, "held by", s.particles.heldBy);
    writeNumbers(file, "sources",
                 {s.sources.time, double(s.sources.came), double(s.sources.left),
                  double(s.sources.missed), double(s.sources.firstId)});
}

void writeAll(hid_t file, const Scene& scene, const RunState& s,
              const std::vector<CurvePoint>& curves) {
    const std::string text = sceneWithoutFiles(scene);
    hdf5::writeArray(file, Format, H5T_STD_U8LE, H5T_NATIVE_UCHAR, text.data(), {text.size(), 1});
    writeNumbers(file, "version", {double(Version)});
    writeNumbers(file, "clock", {s.clock.time, s.clock.dt, double(s.clock.steps)});
    writeNumbers(file, "start",
                 {s.start.low.x, s.start.low.y, s.start.low.z, s.start.high.x, s.start.high.y,
                  s.start.high.z, s.start.speed});
    writeVectors(file, "positions", "m", s.particles.positions);
    writeVectors(file, "velocities", "m/s", s.particles.velocities);
    writeVectors(file, "walls", "m", s.particles.walls);
    if (!s.particles.solidSizes.empty())
        writeNumbers(
            file, "solid sizes",
            std::vector<double>(s.particles.solidSizes.begin(), s.particles.solidSizes.end()));
    if (!s.particles.bodies.empty())
        hdf5::writeArray(file, "bodies", H5T_STD_U16LE, H5T_NATIVE_UINT16,
                         s.particles.bodies.data(), {s.particles.bodies.size(), 1});
    if (!s.solids.empty()) {
        writeNumbers(file, "solid motions", numbersOf(s.solids));
        std::vector<double> left;
        for (const SolidMotion& m : s.solids) left.push_back(m.left);
        writeNumbers(file, "keyframes left", left);
        std::vector<double> accelerations;
        for (const SolidMotion& m : s.solids)
            for (const Vec3d& a : {m.acceleration, m.spinRate})
                accelerations.insert(accelerations.end(), {a.x, a.y, a.z});
        writeNumbers(file, "solid accelerations", accelerations);
    }
    if (!s.objects.positions.empty()) {
        writeVectors(file, "object positions", "m", s.objects.positions);
        writeVectors(file, "object velocities", "m/s", s.objects.velocities);
        hdf5::writeArray(file, "broken bonds", H5T_STD_U8LE, H5T_NATIVE_UCHAR,
                         s.objects.broken.data(), {s.objects.broken.size(), 1});
    }
    const EnergyLedger& e = s.energy;
    if (e.begun)
        writeNumbers(file, "energy",
                     {e.start, e.gravity, e.walls, e.stirred, e.others, e.viscosity, e.artificial,
                      e.diffusion, e.shifting, e.wallPressure});
    if (comesAndGoes(scene)) writeSources(file, s);
    if (!curves.empty()) writeFloats(file, "curves", "", curves.data(), curves.size(), 4);
    if (!s.densities.empty())
        writeFloats(file, "densities", "kg/m³", s.densities.data(), s.densities.size(), 1);
    if (!s.pressures.empty()) {
        writeFloats(file, "pressures", "Pa m⁶/kg²", s.pressures.data(), s.pressures.size(), 1);
        writeNumbers(file, "step share", {s.clock.share});
    }
}

// Until version 4 what has a depth in two dimensions was of a slab one spacing thick.
void spreadOverMetre(Checkpoint& c) {
    if (c.scene.simulation.dimensions != 2) return;
    const float perMetre = 1 / c.scene.simulation.spacing;
    c.scene.fluid.particleMass *= perMetre, c.scene.contact.stiffness *= perMetre;
    for (SolidMotion& m : c.state.solids) m.angularMomentum = double(perMetre) * m.angularMomentum;
    for (CurvePoint& p : c.curves) p.kineticEnergy *= perMetre, p.potentialEnergy *= perMetre;
}

// How many of the walls belong to each solid.
void readSolidSizes(hid_t file, Checkpoint& c) {
    size_t all = 0;
    for (double size : readNumbers(file, "solid sizes", c.scene.solids.size())) {
        if (!(size >= 0 && size <= 1e9)) throw Trouble{"solid sizes"};
        c.state.particles.solidSizes.push_back(int(size));
        all += size_t(size);
    }
    if (all > c.state.particles.walls.size()) throw Trouble{"solid sizes"};
}

void readObjects(hid_t file, Checkpoint& c) {
    const ObjectSample objects = sampleObjects(c.scene);
    ObjectState& state = c.state.objects;
    state.positions = readVectors(file, "object positions");
    state.velocities = readVectors(file, "object velocities");
    state.broken = readArray<uint8_t>(file, "broken bonds", H5T_NATIVE_UCHAR, 1);
    if (state.positions.size() != objects.size() || state.velocities.size() != objects.size())
        throw Trouble{"object positions"};
    if (state.broken.size() != 2 * objects.bonds.size()) throw Trouble{"broken bonds"};
}

void readSolids(hid_t file, Checkpoint& c) {
    if (!c.scene.solids.empty()) readSolidSizes(file, c);
    const size_t solids = c.scene.solids.size();
    if (H5Aexists(file, "solid motions") > 0)
        c.state.solids = motionsOf(c.scene, readNumbers(file, "solid motions", 13 * solids));
    if (H5Aexists(file, "keyframes left") > 0) {  // none in older files
        const std::vector<double> left = readNumbers(file, "keyframes left", solids);
        for (size_t k = 0; k < c.state.solids.size(); ++k) c.state.solids[k].left = left[k];
    }
    if (H5Aexists(file, "solid accelerations") > 0) {  // nor these
        const std::vector<double> a = readNumbers(file, "solid accelerations", 6 * solids);
        for (size_t k = 0; k < c.state.solids.size(); ++k)
            c.state.solids[k].acceleration = {a[6 * k], a[6 * k + 1], a[6 * k + 2]},
            c.state.solids[k].spinRate = {a[6 * k + 3], a[6 * k + 4], a[6 * k + 5]};
    }
    const auto floats = [](const Solid& s) { return s.floats(); };
    if (c.state.solids.empty() && std::any_of(c.scene.solids.begin(), c.scene.solids.end(), floats))
        throw Trouble{"solid motions"};
}

// Of a run that didn't ask for it there is none: it begins anew.
void readEnergy(hid_t file, EnergyLedger& e) {
    if (H5Aexists(file, "energy") <= 0) return;
    const std::vector<double> n = readNumbers(file, "energy", 10);
    e = {true, n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9]};
}

void readSources(hid_t file, Checkpoint& c) {
    Placement& p = c.state.particles;
    p.ids = readArray<int>(file, "ids", H5T_NATIVE_INT, 1);
    p.heldBy = readArray<int>(file, "held by", H5T_NATIVE_INT, 1);
    const std::vector<double> s = readNumbers(file, "sources", 5);
    c.state.sources = {s[0], int64_t(s[1]), int64_t(s[2]), int64_t(s[3]), int(s[4])};
    size_t points = 0;
    for (const Source& source : c.scene.sources) points += latticeOf(c.scene, source).points.size();
    const size_t count = p.positions.size();
    if (p.ids.size() != count || (count > 0 && p.ids[0] < 0) ||
        !std::is_sorted(p.ids.begin(), p.ids.end(), std::less_equal<>()))
        throw Trouble{"ids"};
    const auto isPoint = [&](int point) { return point >= 0 && size_t(point) <= points; };
    if (p.heldBy.size() != count || !std::all_of(p.heldBy.begin(), p.heldBy.end(), isPoint))
        throw Trouble{"held by"};
}

// Each particle has one of each, and all of them can be.
void checkFluid(const Scene& scene, const RunState& state) {
    const size_t count = state.particles.positions.size();
    if ((count == 0 && !comesAndGoes(scene)) || state.particles.velocities.size() != count)
        throw Trouble{"velocities"};
    if (carriesDensity(scene) && state.densities.size() != count) throw Trouble{"densities"};
    for (float rho : state.densities)
        if (!(std::isfinite(rho) && rho > 0)) throw Trouble{"densities"};
    if (factsOf(scene).solvesPressure && state.pressures.size() != count)
        throw Trouble{"pressures"};
    for (float p : state.pressures)
        if (!(std::isfinite(p) && p >= 0)) throw Trouble{"pressures"};
    if (!(state.clock.share > 0 && state.clock.share <= 1)) throw Trouble{"step share"};
    if (isMultiFluid(scene) && state.particles.bodies.size() != count) throw Trouble{"bodies"};
    for (const uint16_t body : state.particles.bodies)
        if (body >= scene.fluid.bodies.size()) throw Trouble{"bodies"};
    for (const auto* field :
         {&state.particles.positions, &state.particles.velocities, &state.particles.walls,
          &state.objects.positions, &state.objects.velocities})
        for (const Vec3& v : *field)
            if (!std::isfinite(v.x + v.y + v.z)) throw Trouble{"numbers that are not finite"};
}

Checkpoint readAll(hid_t file, const std::string& path) {
    Checkpoint c;
    const std::vector<char> text = readArray<char>(file, Format, H5T_NATIVE_UCHAR, 1);
    const double version = readNumbers(file, "version", 1)[0];
    if (version > double(Version))
        throw Error(Failure::Scene, path + ": is of a newer version of the program; update it");
    c.scene = parseScene(std::string(text.begin(), text.end()), path);
    const std::vector<double> clock = readNumbers(file, "clock", 3);
    c.state.clock = {clock[0], clock[1], int64_t(clock[2])};
    const std::vector<double> start = readNumbers(file, "start", 7);
    c.state.start = {{start[0], start[1], start[2]}, {start[3], start[4], start[5]}, start[6]};
    c.state.particles.positions = readVectors(file, "positions");
    c.state.particles.velocities = readVectors(file, "velocities");
    c.state.particles.walls = readVectors(file, "walls");
    readSolids(file, c);
    readEnergy(file, c.state.energy);
    if (!c.scene.objects.empty()) readObjects(file, c);
    if (isMultiFluid(c.scene))
        c.state.particles.bodies = readArray<uint16_t>(file, "bodies", H5T_NATIVE_UINT16, 1);
    if (carriesDensity(c.scene))
        c.state.densities = readArray<float>(file, "densities", H5T_NATIVE_FLOAT, 1);
    if (factsOf(c.scene).solvesPressure) {
        c.state.pressures = readArray<float>(file, "pressures", H5T_NATIVE_FLOAT, 1);
        c.state.clock.share = readNumbers(file, "step share", 1)[0];
    }
    if (comesAndGoes(c.scene)) readSources(file, c);
    static_assert(sizeof(CurvePoint) == 4 * sizeof(float));
    if (H5Lexists(file, "curves", H5P_DEFAULT) > 0)
        c.curves = readArray<CurvePoint>(file, "curves", H5T_NATIVE_FLOAT, 4);
    checkFluid(c.scene, c.state);
    if (version < 5) spreadOverMetre(c);
    return c;
}

}  // namespace

void writeCheckpoint(const std::string& path, const Scene& scene, const RunState& state,
                     const std::vector<CurvePoint>& curves) {
    replaceFile(path, [&](const std::string& temporary) {
        return hdf5::writeFile(temporary,
                               [&](hid_t file) { writeAll(file, scene, state, curves); });
    });
}

bool isCheckpoint(const std::string& path) { return hdf5::isFile(path); }

Checkpoint readCheckpoint(const std::string& path) {
    try {
        const Handle file = hdf5::openFile(path);
        if (H5Lexists(file, Format, H5P_DEFAULT) <= 0)
            throw Error(Failure::Scene,
                        path +
                            ": is an HDF5 file, but no checkpoint of Spindrift; give "
                            "a scene or a checkpoint");
        return readAll(file, path);
    } catch (const Trouble& trouble) {
        throw Error(
            Failure::Scene,
            fmt::format("{}: the checkpoint is damaged or incomplete ({}); use an older one", path,
                        trouble.what));
    }
}

}  // namespace spindrift
