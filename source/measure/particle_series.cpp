#include "measure/particle_series.h"

#include "core/error.h"
#include "core/output_file.h"
#include "scene/output_fields.h"
#include "scene/sample_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
std::vector<int32_t> idsOf(const std::vector<Particle>& particles) {
    std::vector<int32_t> ids;
    for (const Particle& p : particles) ids.push_back(p.id);
    return ids;
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
      format_(path_),
      folder_(path_, format_.extension(), scene),
      corner_(toDouble(scene.domain.min)),
      fields_(fieldsOf(scene.output.fields)),
      mass_(particleMass(scene)),
      surfaces_(std::move(surfaces)),
      interval_(interval) {
    // Where particles come and go there is one fluid.
    if (!comesAndGoes(scene))
        for (const uint16_t body : simulation.state().particles.bodies) {
            fluids_.push_back(body);
            masses_.push_back(mass_ * restDensity(scene, scene.fluid.bodies[body]) /
                              scene.fluid.restDensity);
        }
    if (!scene.objects.empty()) objects_ = sampleObjects(scene).objects;
    if (now.steps == 0)
        folder_.remove({"fluid", "solids", "objects"});
    else
        goOn(now.time * (1 + 1e-9));
}

// With what the run before wrote until this time, s.
void ParticleSeries::goOn(double time) {
    entries_ = format_.readIndex(path_);
    std::erase_if(entries_, [&](const IndexEntry& e) { return e.time > time; });
    if (!entries_.empty()) endBefore_ = entries_.back().time;
    const auto last = size_t(time / interval_);
    if (!format_.hasIndex() && folder_.has("fluid", last)) endBefore_ = double(last) * interval_;
}

Piece ParticleSeries::fluidOf(const std::vector<Particle>& particles) const {
    const size_t n = particles.size();
    Piece fluid{"fluid", {}, {numberField("id", idsOf(particles))}, {}};
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
            : name == "mass"
                ? field("mass", "kg", n,
                        [&](size_t i) { return masses_.empty() ? mass_ : masses_[i]; })
                : numberField("fluid", fluids_.empty() ? std::vector<int32_t>(n) : fluids_));
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

PieceFile ParticleSeries::describe(const Piece& piece, size_t number) const {
    PieceFile file;
    file.name = piece.name, file.points = piece.points.size();
    file.triangles = piece.triangles.size();
    file.file = (fs::path(folder_.path()).filename() /
                 fs::path(folder_.file(piece.name, number)).filename())
                    .generic_string();
    for (const PointField& f : piece.fields)
        file.fields.push_back({f.name, f.values.index() == 1 ? -f.components : f.components});
    return file;
}

PieceFile ParticleSeries::put(Piece piece, size_t number) {
    PieceFile file = describe(piece, number);
    beside_.add([this, path = folder_.file(piece.name, number), piece = std::move(piece)] {
        format_.write(path, piece);
    });
    return file;
}

void ParticleSeries::add(Simulation& simulation, double time) {
    const auto number = size_t(std::llround(time / interval_));
    std::vector<PieceFile> pieces = {put(fluidOf(simulation.particles()), number)};
    if (hasSolids()) {
        const std::vector<SolidPose> poses = simulation.solidPoses();
        const bool stayed = posed_.size() == poses.size() &&
                            std::equal(poses.begin(), poses.end(), posed_.begin(), isSamePose);
        if (!stayed) posed_ = poses, posedFile_ = put(solidsAt(poses), number);
        pieces.push_back(posedFile_);
    }
    if (!objects_.empty()) pieces.push_back(put(objectsOf(simulation.state()), number));
    entries_.push_back(format_.entry(time, pieces));
    const auto now = Clock::now();
    if (now - indexed_ >= std::chrono::seconds(1)) indexed_ = now, writeIndex();
}

void ParticleSeries::finish() {
    writeIndex();
    beside_.wait();
}

void ParticleSeries::writeIndex() {
    if (format_.hasIndex())
        beside_.add([this, text = format_.index(entries_)] { writeText(path_, text); });
}

void ParticleSeries::dropAfter(double time) {
    std::erase_if(entries_, [&](const IndexEntry& e) { return e.time > time; });
    posed_.clear();
    writeIndex();
}

}  // namespace spindrift
