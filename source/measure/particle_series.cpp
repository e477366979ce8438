#include "measure/particle_series.h"

#include "core/output_file.h"
#include "scene/output_fields.h"
#include "scene/sample_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace spindrift {

namespace fs = std::filesystem;

namespace {

// A value of each particle.
template <class Of> PointField field(const char* name, const char* unit, size_t n, const Of& of) {
    PointField f{name, unit, 1, std::vector<float>(n)};
    for (size_t i = 0; i < n; ++i) std::get<0>(f.values)[i] = float(of(i));
    return f;
}
template <class Of>
PointField vectorField(const char* name, const char* unit, size_t n, const Of& of) {
    PointField f{name, unit, 3, std::vector<float>(3 * n)};
    for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < 3; ++k) std::get<0>(f.values)[3 * i + k] = float(of(i)[int(k)]);
    return f;
}
PointField numberField(const char* name, std::vector<int32_t> numbers) {
    return {name, "", 1, std::move(numbers)};
}
std::vector<int32_t> firstNumbers(size_t n) {
    std::vector<int32_t> numbers(n);
    for (size_t i = 0; i < n; ++i) numbers[i] = int32_t(i);
    return numbers;
}

bool isSamePose(const SolidPose& a, const SolidPose& b) {
    const auto same = [](Vec3d p, Vec3d q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
    return same(a.middle, b.middle) && same(a.axis[0], b.axis[0]) && same(a.axis[1], b.axis[1]) &&
           same(a.axis[2], b.axis[2]);
}

}  // namespace

ParticleSeries::ParticleSeries(const Scene& scene, Simulation& simulation,
                               std::vector<SolidSurface> surfaces, const Measurement& now,
                               double interval)
    : path_(scene.output.series),
      folder_(fs::path(path_).replace_extension("").string()),
      format_(path_),
      corner_(toDouble(scene.domain.min)),
      fields_(fieldsOf(scene.output.fields)),
      surfaces_(std::move(surfaces)) {
    requireFolder(folder_);
    const std::vector<uint16_t> bodies = simulation.state().particles.bodies;
    fluids_.assign(bodies.begin(), bodies.end());
    fluids_.resize(size_t(simulation.fluidCount()), 0);
    for (size_t i = 0; i < fluids_.size(); ++i)
        masses_.push_back(
            float(particleVolume(scene) *
                  (bodies.empty() ? scene.fluid.restDensity
                                  : restDensity(scene, scene.fluid.bodies[bodies[i]]))));
    if (!scene.objects.empty()) objects_ = sampleObjects(scene).objects;
    if (now.steps == 0) return;
    // What the run before wrote, as far as it is there.
    const Piece fluid = fluidOf(simulation.particles()), solids = solidsAt(simulation.solidPoses()),
                objects = objectsOf(simulation.state());
    for (size_t k = 0; double(k) * interval <= now.time * (1 + 1e-9); ++k) {
        if (!fs::exists(fileOf("fluid", k))) break;
        times_.push_back(double(k) * interval);
        note(times_.back(), fluid, k);
        if (fs::exists(fileOf("solids", k))) posedNumber_ = k;
        if (hasSolids()) note(times_.back(), solids, posedNumber_);
        if (!objects_.empty()) note(times_.back(), objects, k);
    }
}

std::string ParticleSeries::fileOf(const std::string& piece, size_t number) const {
    return (fs::path(folder_) / fmt::format("{}_{:05}{}", piece, number, format_.extension()))
        .string();
}

Piece ParticleSeries::fluidOf(const std::vector<Particle>& particles) const {
    const size_t n = particles.size();
    Piece fluid{"fluid", {}, {numberField("id", firstNumbers(n))}, {}};
    for (const Particle& p : particles) fluid.points.push_back(p.position);
    for (const std::string& name : fields_) {
        const auto& p = particles;
        fluid.fields.push_back(
            name == "velocity"
                ? vectorField("velocity", "m/s", n, [&](size_t i) { return p[i].velocity; })
            : name == "acceleration" ? vectorField("acceleration", "m/s²", n,
                                                   [&](size_t i) { return p[i].acceleration; })
            : name == "density"
                ? field("density", "kg/m³", n, [&](size_t i) { return p[i].density; })
            : name == "pressure"
                ? field("pressure", "Pa", n, [&](size_t i) { return p[i].pressure; })
            : name == "mass" ? field("mass", "kg", n, [&](size_t i) { return masses_[i]; })
                             : numberField("fluid", fluids_));
    }
    return fluid;
}

Piece ParticleSeries::solidsAt(const std::vector<SolidPose>& poses) const {
    Piece solids{"solids", {}, {}, {}};
    std::vector<int32_t> numbers;
    for (size_t s = 0; s < surfaces_.size(); ++s) {
        const int32_t first = int32_t(solids.points.size());
        const SolidPose& pose = poses[s];
        for (const Vec3d& p : surfaces_[s].points) {
            solids.points.push_back(corner_ + pose.middle + p.x * pose.axis[0] +
                                    p.y * pose.axis[1] + p.z * pose.axis[2]);
            numbers.push_back(int32_t(s));
        }
        for (const auto& t : surfaces_[s].triangles)
            solids.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    solids.fields.push_back(numberField("solid", std::move(numbers)));
    return solids;
}

Piece ParticleSeries::objectsOf(const RunState& state) const {
    const ObjectState& now = state.objects;
    const size_t n = now.positions.size();
    Piece objects{"objects", {}, {numberField("object", objects_)}, {}};
    for (const Vec3& p : now.positions) objects.points.push_back(corner_ + toDouble(p));
    objects.fields.push_back(
        vectorField("velocity", "m/s", n, [&](size_t i) { return now.velocities[i]; }));
    return objects;
}

void ParticleSeries::note(double time, const Piece& piece, size_t number) {
    MomentFile m;
    m.time = time, m.name = piece.name, m.points = piece.points.size();
    m.triangles = piece.triangles.size();
    m.file = (fs::path(folder_).filename() / fs::path(fileOf(piece.name, number)).filename())
                 .generic_string();
    for (const PointField& f : piece.fields)
        m.fields.push_back({f.name, f.values.index() == 1 ? -f.components : f.components});
    files_.push_back(std::move(m));
}

void ParticleSeries::put(double time, Piece piece, size_t number) {
    note(time, piece, number);
    beside_.add([this, file = fileOf(piece.name, number), piece = std::move(piece)] {
        format_.write(file, piece);
    });
}

void ParticleSeries::add(Simulation& simulation, double time) {
    const size_t number = times_.size();
    put(time, fluidOf(simulation.particles()), number);
    if (hasSolids()) {
        const std::vector<SolidPose> poses = simulation.solidPoses();
        if (posed_.size() == poses.size() &&
            std::equal(poses.begin(), poses.end(), posed_.begin(), isSamePose)) {
            note(time, solidsAt(poses), posedNumber_);
        } else {
            posed_ = poses, posedNumber_ = number;
            put(time, solidsAt(poses), number);
        }
    }
    if (!objects_.empty()) put(time, objectsOf(simulation.state()), number);
    times_.push_back(time);
    writeIndex();
}

void ParticleSeries::writeIndex() {
    if (std::string text = format_.index(files_); !text.empty())
        beside_.add([this, text = std::move(text)] { writeText(path_, text); });
}

void ParticleSeries::dropAfter(double time) {
    std::erase_if(times_, [&](double t) { return t > time; });
    std::erase_if(files_, [&](const MomentFile& m) { return m.time > time; });
    posed_.clear();
    writeIndex();
}

}  // namespace spindrift
