#include "app/surface_file.h"

#include "core/output_file.h"
#include "measure/moment_files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace spindrift {
namespace {

bool writeObj(const std::string& path, const FluidMesh& mesh) {
    std::string text = "# written by Spindrift, m\n";
    const auto out = std::back_inserter(text);
    for (const Vec3d& p : mesh.points) fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
    for (const auto& t : mesh.triangles)
        fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    std::ofstream file(path, std::ios::binary);
    file << text;
    return bool(file.flush());
}

}  // namespace

const std::vector<std::string>& surfaceFormats() {
    static const std::vector<std::string> all = {"ply", "obj", "vdb"};
    return all;
}

SurfaceFile::SurfaceFile(const std::vector<Vec3d>& places, double spacing, double volume,
                         const SurfaceMethod& method)
    : distances_(places, spacing, method), mesh_(distances_.mesh(volume, shift_)) {}

void SurfaceFile::write(const std::string& path) const {
    if (path.ends_with(".ply"))
        return MomentFormat(path).write(path, {"surface", mesh_.points, {}, mesh_.triangles});
    replaceFile(path, [&](const std::string& temporary) {
        return path.ends_with(".obj") ? writeObj(temporary, mesh_)
                                      : distances_.writeVdb(temporary, shift_);
    });
}

}  // namespace spindrift
