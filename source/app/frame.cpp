#include "app/frame.h"

#include "app/solid_shapes.h"
#include "render/color_map.h"
#include "core/error.h"
#include "render/cuda_interop.h"
#include "scene/color_file.h"
#include "scene/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {

namespace {

Vec3 domainSize(const Scene& scene) { return scene.domain.max - scene.domain.min; }

// A fluid's name and colour by its density, kg/m³, and viscosity, Pa s.
struct Look {
    const char* name;
    std::array<uint8_t, 3> color;
};
Look lookOf(float density, float viscosity) {
    if (density < 50) return {"gas", {214, 222, 232}};
    if (density < 960) return {"oil", {226, 168, 58}};
    if (density < 1060 && viscosity < 0.05f) return {"water", {58, 130, 214}};
    if (density < 2000) return {"syrup", {166, 92, 44}};
    return {"heavy fluid", {150, 156, 172}};
}

// The same, lighter or darker, for another fluid of that kind.
std::array<uint8_t, 3> shaded(std::array<uint8_t, 3> color, int turn) {
    for (uint8_t& c : color)
        c = uint8_t(turn % 2 ? c + (255 - c) * turn / (turn + 2) : c * 2 / (turn + 2));
    return color;
}

}  // namespace

Scene onDrawingDevice(Scene scene) {
    if (scene.compute.device < 0 && scene.compute.backend != Backend::Cpu)
        scene.compute.device = drawingDevice();
    return scene;
}

Quantity quantity(ColorBy by) {
    switch (by) {
        case ColorBy::Plain:
            return {"plain", ""};
        case ColorBy::Velocity:
            return {"velocity", "m/s"};
        case ColorBy::Pressure:
            return {"pressure", "Pa"};
        case ColorBy::Density:
            return {"density", "kg/m³"};
        case ColorBy::Acceleration:
            return {"acceleration", "m/s²"};
        case ColorBy::Fluid:
            return {"fluid", ""};
        case ColorBy::Surface:
            return {"surface", ""};
        case ColorBy::Id:
            return {"particle id", ""};
        case ColorBy::VelocityX:
            return {"velocity x", "m/s"};
        case ColorBy::VelocityY:
            return {"velocity y", "m/s"};
        case ColorBy::VelocityZ:
            return {"velocity z", "m/s"};
        case ColorBy::Vorticity:
            return {"vorticity", "1/s"};
        case ColorBy::ShearRate:
            return {"shear rate", "1/s"};
        case ColorBy::Divergence:
            return {"divergence", "1/s"};
        case ColorBy::Neighbours:
            return {"neighbours", ""};
        case ColorBy::TimeBin:
            return {"time bin", ""};
    }
    return {"", ""};
}

bool isNumber(ColorBy by) {
    return by != ColorBy::Plain && by != ColorBy::Fluid && by != ColorBy::Surface;
}

OrbitCamera cameraOf(const Scene& scene, float aspect) {
    const Camera& c = scene.view.camera;
    const Vec3 size = domainSize(scene);
    OrbitCamera camera{0.5f * size, c.yaw, c.pitch, c.distance, c.fieldOfView, upward(scene)};
    camera.orthographic = scene.view.projection == Projection::Orthographic;
    if (c.distance <= 0) camera.distance = fitDistance(camera, size, aspect);
    if (!c.automaticTarget) camera.target = c.target - scene.domain.min;
    // All of the domain is before the eye, and what has left it by not too much.
    camera.depth = 2 * length(size) + length(camera.target - 0.5f * size);
    return camera;
}

void keepCamera(Scene& scene, const OrbitCamera& camera) {
    scene.view.camera = {camera.yaw,         camera.pitch, camera.distance,
                         camera.fieldOfView, false,        camera.target + scene.domain.min};
}

Frame::Frame(int width, int height, int samples) : renderer_(width, height, samples) {}

void Frame::update(Simulation& simulation, const Scene& scene, bool looksBack) {
    fluidCount_ = simulation.fluidCount();
    now_ = simulation.clock().time;
    if (std::exchange(fresh_, false)) begin(scene), begin_ = now_;
    wallCount_ = scene.view.showWalls        ? simulation.wallCount()
                 : scene.view.solidParticles ? simulation.solidParticleCount()
                                             : 0;
    solids_.clear();
    if (!scene.view.solidParticles)
        for (const SolidPose& p : simulation.solidPoses())
            solids_.push_back(
                {toFloat(p.middle), {toFloat(p.axis[0]), toFloat(p.axis[1]), toFloat(p.axis[2])}});
    objectCount_ = simulation.objectParticleCount();
    vertices_.resize(fluidCount_ + wallCount_ + objectCount_);
    seen_ = write(simulation, scene.view.colorBy);
    if (fluidCount_ == 0 || seen_.max < seen_.min)
        seen_ = {0, 0};  // there is nothing to see yet
    else if (!looksBack)
        run_[scene.view.colorBy].add(now_, seen_);
    lookInside(simulation, scene);
    if (!looksBack) followPath(simulation, scene);
}

void Frame::followPath(Simulation& simulation, const Scene& scene) {
    constexpr size_t most = 20000;  // pieces; then every second place is forgotten
    const int id = scene.view.pathOf;
    if (std::exchange(pathOf_, id) != id) path_.clear();
    if (id < 0) return;
    const double now = simulation.clock().time;
    std::erase_if(path_, [&](const Place& p) { return p.time >= now; });  // the run went back
    const std::optional<Particle> particle = simulation.find(id);
    if (!particle) return;  // it has not come yet, or has left, and its path ends there
    path_.push_back({now, toFloat(particle->position) - scene.domain.min});
    if (path_.size() < most) return;
    for (size_t i = 0; i < path_.size() / 2; ++i) path_[i] = path_[2 * i + 1];
    path_.resize(path_.size() / 2);
}

void Frame::lookInside(Simulation& simulation, const Scene& scene) {
    slice_.reset(), arrows_.clear();
    if (scene.view.slice.axis != Across::None) {
        if (!sight_) sight_.emplace(scene);
        Sees sees;
        if (sight_->anyThin())
            sees = [past = sight_->past(simulation.solidPoses())](Vec3d particle, Vec3d from) {
                return past(particle, from) > 0.5;
            };
        slice_ = sliceOf(scene, vertices_.read(fluidCount_), sees);
    }
    if (scene.view.arrows.count > 0) arrows_ = velocitiesOf(scene, simulation.particles());
    for (const CellVelocity& c : arrows_) arrowSpeed_ = std::max(arrowSpeed_, length(c.velocity));
}

void Frame::begin(const Scene& scene) {
    run_.clear();
    sight_.reset(), arrowSpeed_ = 0;
    std::vector<SolidShape> shapes;
    for (const Solid& solid : scene.solids) shapes.push_back(shapeOf(scene, solid));
    renderer_.setSolids(std::move(shapes));
}

Range Frame::write(Simulation& simulation, ColorBy by) {
    const VertexMemory memory = vertices_.map(simulation.cudaDevice(), simulation.cudaStream());
    copied_ = memory.device != simulation.cudaDevice();
    try {
        const Range range = simulation.writeVertices(memory, by, wallCount_);
        vertices_.unmap();
        return range;
    } catch (...) {
        vertices_.unmap();
        throw;
    }
}

std::vector<Vec3> Frame::shownFluid(const Scene& scene) const {
    const Threshold& t = scene.view.threshold;
    const bool hides = t.on && isNumber(scene.view.colorBy);
    const ClipBox box = clipBox(scene);
    std::vector<Vec3> shown;
    for (const Vertex& v : vertices_.read(fluidCount_)) {
        const Vec3 place{v.x, v.y, v.z};
        if (box.holds(place) && (!hides || (v.value >= t.min && v.value <= t.max)))
            shown.push_back(place);
    }
    return shown;
}

Range Frame::range(const View& view) const {
    const auto run = run_.find(view.colorBy);
    Range r = view.range == RangeMode::Frame || run == run_.end() ? seen_ : run->second.range();
    if (view.range == RangeMode::Fixed) r = {view.rangeMin, view.rangeMax};
    // Fluid at rest must not show its round-off in all colours: it has the lowest one.
    const float least = 1e-5f * std::max({std::abs(r.min), std::abs(r.max), 1e-3f});
    if (!(r.max - r.min >= least)) r.max = r.min;
    if (view.colorScale == ColorScale::Linear || !isNumber(view.colorBy)) return r;
    // What has no logarithm has the lowest colour.
    constexpr float mostDecades = 1e4f, leastValue = 1e-30f;
    const bool asked = view.range == RangeMode::Fixed && r.min > 0;
    r.max = std::max(r.max, leastValue);
    r.min = asked ? r.min : std::max(r.min, r.max / mostDecades);
    return r;
}

std::string Frame::rangeNote(const View& view) const {
    if (view.range == RangeMode::Fixed) return "fixed";
    if (view.range == RangeMode::Frame) return "per frame";
    const auto run = run_.find(view.colorBy);
    if (run == run_.end()) return "per frame";  // the run is looked back at
    if (run->second.since() <= begin_) return "over the run";
    return fmt::format("since {:.3g} s", run->second.since());  // it was not looked at before
}

std::vector<Swatch> fluidsOf(const Scene& scene) {
    std::map<float, Swatch> fluids;  // by density
    std::map<std::string, int> seen;
    for (const Body& body : scene.fluid.bodies) {
        const float density = restDensity(scene, body);
        const Look look = lookOf(density, viscosity(scene, body));
        if (const auto known = fluids.find(density); known != fluids.end()) {
            if (!body.name.empty() && known->second.name.find(body.name) == std::string::npos)
                known->second.name = body.name + ", " + known->second.name;
            continue;
        }
        const std::string name =
            fmt::format("{}, {:g} kg/m³", body.name.empty() ? look.name : body.name, density);
        fluids[density] = {name, density / scene.fluid.restDensity,
                           shaded(look.color, seen[look.name]++)};
    }
    std::vector<Swatch> sorted;
    for (auto& [density, fluid] : fluids) sorted.push_back(std::move(fluid));
    return sorted;
}

void Frame::setColors(DrawSettings& settings, const Scene& scene) {
    const View& view = scene.view;
    Range r = range(view);
    std::vector<Swatch> swatches;
    if (view.colorBy == ColorBy::Fluid) swatches = fluidsOf(scene);
    if (view.colorBy == ColorBy::Surface)
        swatches = {{"inside", 0, {40, 78, 150}}, {"surface", 1, {240, 214, 120}}};
    if (!swatches.empty())
        r = {swatches.front().value,
             std::max(swatches.back().value, swatches.front().value + 1e-3f)};
    settings.plain = view.colorBy == ColorBy::Plain;
    settings.map = view.colorMap;
    std::string note = swatches.empty() ? rangeNote(view) : "";
    if (view.colorMap == ColorMap::File && colorFile_ != view.colorFile) {
        colorFile_ = view.colorFile, ownColors_.reset();
        try {
            ownColors_ = readColors(colorFile_);
        } catch (const Error&) {}  // the window goes on, and says so
    }
    if (view.colorMap == ColorMap::File && !ownColors_)
        settings.map = ColorMap::Viridis, note = "no such color_file";
    if (ownColors_) settings.ownColors = *ownColors_;
    settings.rangeMin = r.min;
    settings.rangeMax = r.max;
    settings.logarithmic = view.colorScale == ColorScale::Logarithmic && isNumber(view.colorBy);
    if (view.slice.axis != Across::None)
        note = fmt::format("{} = {:.4g} m", enumNames(view.slice.axis)[size_t(view.slice.axis)],
                           slicePlace(scene));
    const Quantity shown = quantity(view.colorBy);
    settings.legend = LegendText{shown.name, shown.unit, note};
    settings.swatches = std::move(swatches);
}

namespace {

// So many lines over the range, at round values, or powers of ten and parts of them.
float contourStep(const View& view, float min, float max, bool logarithmic) {
    const int count = view.slice.contours;
    if (count == 0 || !(max > min) || !isNumber(view.colorBy)) return 0;
    if (!logarithmic) return float(tickStep(double(max) - double(min), count));
    const float decades = std::log10(max / min), each = float(count) / decades;
    return std::log(10.0f) * (each >= 1 ? 1 / std::round(each) : std::ceil(decades / float(count)));
}

// What has gone out on one side has come in on the other.
bool goesAround(const Domain& domain, Vec3 step) {
    for (int k = 0; k < 3; ++k)
        if (domain.periodic(k) && std::abs(step[k]) > 0.5f * (domain.max - domain.min)[k])
            return true;
    return false;
}

}  // namespace

void Frame::setInside(DrawSettings& settings, const Scene& scene) {
    const View& view = scene.view;
    if (view.threshold.on && isNumber(view.colorBy))
        settings.shownMin = view.threshold.min, settings.shownMax = view.threshold.max;
    const ClipBox box = clipBox(scene);
    settings.clipLow = box.low, settings.clipHigh = box.high;
    settings.clipSolids = view.clip.solids;
    if (slice_) settings.slice = &*slice_;
    settings.fluid = !slice_ || view.slice.fluid;
    settings.contourStep =
        contourStep(view, settings.rangeMin, settings.rangeMax, settings.logarithmic);
    for (size_t i = 1; pathOf_ == view.pathOf && i < path_.size() && path_[i].time <= now_; ++i)
        if (!goesAround(scene.domain, path_[i].at - path_[i - 1].at))
            settings.path.push_back({path_[i - 1].at, path_[i].at});
    for (const CellVelocity& c : arrows_) {
        const float scale = view.arrows.length * arrowStep(scene) / std::max(arrowSpeed_, 1e-9f);
        settings.arrows.push_back({c.middle, c.middle + scale * c.velocity});
    }
}

void Frame::draw(const Scene& scene, std::vector<Ring> rings,
                 std::vector<std::array<Vec3, 2>> marks) {
    const View& view = scene.view;
    DrawSettings settings;
    settings.camera = cameraOf(scene, float(width()) / float(height()));
    settings.domainSize = domainSize(scene);
    settings.fluidCount = fluidCount_;
    settings.wallCount = wallCount_ + objectCount_;
    settings.outline = view.showOutline;
    settings.ground = view.showGround;
    settings.axes = view.showAxes;
    settings.scale = view.showScale;
    settings.theme = view.theme;
    settings.diameter = scene.simulation.spacing * view.particleScale;
    settings.minimumPixels = scene.window.pointSize;
    settings.surface = view.style == DrawStyle::Surface;
    settings.flat = scene.simulation.dimensions == 2;
    setColors(settings, scene);
    settings.path = std::move(marks);
    setInside(settings, scene);
    settings.rings = std::move(rings);
    settings.solids = solids_;
    renderer_.draw(vertices_, settings);
}

}  // namespace spindrift
