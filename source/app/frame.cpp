#include "app/frame.h"

#include "render/color_map.h"
#include "render/cuda_interop.h"

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace {

Vec3 domainSize(const Scene& scene) { return scene.domain.max - scene.domain.min; }

const char* rangeNote(RangeMode mode) {
    switch (mode) {
        case RangeMode::Frame:
            return "per frame";
        case RangeMode::Run:
            return "over the run";
        case RangeMode::Fixed:
            return "fixed";
    }
    return "";
}

}  // namespace

Scene onDrawingDevice(Scene scene) {
    if (scene.compute.device < 0 && scene.compute.backend != Backend::Cpu) scene.compute.device = drawingDevice();
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
            return {"density at rest", "x the scene's"};
        case ColorBy::Surface:
            return {"surface", ""};
        case ColorBy::Id:
            return {"particle id", ""};
    }
    return {"", ""};
}

OrbitCamera cameraOf(const Scene& scene, float aspect) {
    const Camera& c = scene.view.camera;
    const Vec3 size = domainSize(scene);
    OrbitCamera camera{0.5f * size, c.yaw, c.pitch, c.distance, c.fieldOfView};
    if (c.distance <= 0) camera.distance = fitDistance(camera, size, aspect);
    if (!c.automaticTarget) camera.target = c.target - scene.domain.min;
    return camera;
}

void keepCamera(Scene& scene, const OrbitCamera& camera) {
    scene.view.camera = {camera.yaw,         camera.pitch, camera.distance,
                         camera.fieldOfView, false,        camera.target + scene.domain.min};
}

Frame::Frame(int width, int height, int samples) : renderer_(width, height, samples) {}

void Frame::update(Simulation& simulation, const Scene& scene) {
    fluidCount_ = simulation.fluidCount();
    wallCount_ = scene.view.showWalls ? simulation.wallCount() : simulation.solidParticleCount();
    objectCount_ = simulation.objectParticleCount();
    vertices_.resize(fluidCount_ + wallCount_ + objectCount_);
    seen_ = write(simulation, scene.view.colorBy);
    if (scene.view.colorBy != writtenBy_) fresh_ = true;
    writtenBy_ = scene.view.colorBy;
    run_ = fresh_ ? seen_ : Range{std::min(run_.min, seen_.min), std::max(run_.max, seen_.max)};
    fresh_ = false;
}

Range Frame::write(Simulation& simulation, ColorBy by) {
    const VertexMemory memory = vertices_.map(simulation.cudaDevice());
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

Range Frame::range(const View& view) const {
    Range r = view.range == RangeMode::Frame ? seen_ : run_;
    if (view.range == RangeMode::Fixed) r = {view.rangeMin, view.rangeMax};
    // Fluid at rest must not show its round-off in all colours.
    const float least = 1e-5f * std::max({std::abs(r.min), std::abs(r.max), 1e-3f});
    if (!(r.max - r.min >= least)) r.max = r.min + least;
    return r;
}

void Frame::draw(const Scene& scene, std::vector<Ring> rings) {
    const View& view = scene.view;
    const Range r = range(view);
    const Quantity shown = quantity(view.colorBy);
    DrawSettings settings;
    settings.camera = cameraOf(scene, float(width()) / float(height()));
    settings.domainSize = domainSize(scene);
    settings.fluidCount = fluidCount_;
    settings.wallCount = wallCount_ + objectCount_;
    settings.outline = view.showOutline;
    settings.ground = view.showGround;
    settings.diameter = scene.simulation.spacing * view.particleScale;
    settings.minimumPixels = scene.window.pointSize;
    settings.plain = view.colorBy == ColorBy::Plain;
    settings.map = view.colorMap;
    settings.rangeMin = r.min;
    settings.rangeMax = r.max;
    settings.legend = LegendText{shown.name, shown.unit, rangeNote(view.range)};
    settings.rings = std::move(rings);
    renderer_.draw(vertices_, settings);
}

}  // namespace spindrift
