#include "app/surface_series.h"

#include "app/surface_file.h"
#include "core/error.h"
#include "scene/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace spindrift {
namespace {

// ".ply"
std::string extensionOf(const Scene& scene) {
    const std::string& path = scene.output.surface;
    const std::string extension = std::filesystem::path(path).extension().string();
    const auto& formats = surfaceFormats();
    if (std::find(formats.begin(), formats.end(), extension.substr(extension.empty() ? 0 : 1)) ==
        formats.end())
        throw Error(
            Failure::Output,
            fmt::format("{}: a surface is no \"{}\"; name it .ply, .obj or .vdb", path, extension));
    if (scene.simulation.dimensions == 2)
        throw Error(Failure::Scene,
                    "output.surface: a surface needs three dimensions; leave it out");
    requireFluidMeshes(path, SurfaceMethod{}.cell * scene.simulation.spacing);
    return extension;
}

}  // namespace

SurfaceSeries::SurfaceSeries(const Scene& scene, const Measurement& now, double interval)
    : folder_(scene.output.surface, extensionOf(scene), scene),
      spacing_(scene.simulation.spacing),
      volume_(particleVolume(scene)),
      interval_(interval) {
    method_.anisotropic = scene.output.surfaceAnisotropic;
    if (now.steps == 0) folder_.remove({"surface"});
    const auto last = size_t(now.time * (1 + 1e-9) / interval_);
    if (now.steps > 0 && folder_.has("surface", last)) endBefore_ = double(last) * interval_;
}

void SurfaceSeries::add(Simulation& simulation, double time) {
    std::vector<Vec3d> places;
    for (const Particle& p : simulation.particles()) places.push_back(p.position);
    const auto number = size_t(std::llround(time / interval_));
    numbers_.insert(number);
    beside_.add([this, file = folder_.file("surface", number), places = std::move(places)] {
        SurfaceFile(places, spacing_, volume_ * double(places.size()), method_).write(file);
    });
}

void SurfaceSeries::dropAfter(double time) {
    std::erase_if(numbers_, [&](size_t k) { return double(k) * interval_ > time; });
}

}  // namespace spindrift
