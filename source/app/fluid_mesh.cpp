#include "app/fluid_mesh.h"

#include "app/stretched_kernels.h"
#include "core/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointRasterizeSDF.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/LevelSetRebuild.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>

namespace spindrift {

bool canMeshFluid() { return true; }
// OpenVDB takes a transform whose determinant is below 3e-15 for one that can't be inverted.
void requireFluidMeshes(const std::string& what, double cell) {
    constexpr double smallest = 1.5e-5;
    if (cell < smallest)
        throw Error(Failure::Usage,
                    fmt::format("{}: its grid would have cells of {:.3g} m, and {:.3g} m are the "
                                "smallest; write particles, or give lengths in another unit",
                                what, cell, smallest));
}

struct FluidLevelSet::Grid {
    openvdb::FloatGrid::Ptr distances;
};

namespace {

constexpr double Band = 3;  // cells on either side of the surface that have distances

// Three numbers a point, as OpenVDB reads them.
std::vector<openvdb::Vec3d> pointsOf(const std::vector<Vec3d>& places) {
    std::vector<openvdb::Vec3d> points;
    points.reserve(places.size());
    for (const Vec3d& p : places) points.emplace_back(p.x, p.y, p.z);
    return points;
}

openvdb::FloatGrid::Ptr smoothSpheres(const std::vector<openvdb::Vec3d>& places, double spacing,
                                      double cell) {
    // Some eight particles a cell of their grid, as OpenVDB likes it.
    const auto points = openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                                             openvdb::points::PointDataGrid>(
        places, *openvdb::math::Transform::createLinearTransform(2 * spacing));
    const double radius = 0.8 * spacing, search = 2.2 * spacing;
    return openvdb::points::rasterizeSmoothSpheres(
        *points, radius, search, Band, openvdb::math::Transform::createLinearTransform(cell));
}

double volumeOf(const FluidMesh& mesh) {
    double six = 0;
    const Vec3d middle = mesh.points.empty() ? Vec3d{} : mesh.points[0];
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.points[size_t(t[0])] - middle, b = mesh.points[size_t(t[1])] - middle,
                    c = mesh.points[size_t(t[2])] - middle;
        six += dot(a, cross(b, c));
    }
    return six / 6;
}

double areaOf(const FluidMesh& mesh) {
    double two = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.points[size_t(t[0])];
        two += length(cross(mesh.points[size_t(t[1])] - a, mesh.points[size_t(t[2])] - a));
    }
    return two / 2;
}

int smoothingsOf(const SurfaceMethod& method) {
    if (method.smoothings >= 0) return method.smoothings;
    return method.anisotropic ? 1 : 3;
}

FluidMesh meshAt(const openvdb::FloatGrid& distances, double shift) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(distances, points, triangles, quads, shift);
    FluidMesh mesh;
    for (const openvdb::Vec3s& p : points) mesh.points.push_back({p.x(), p.y(), p.z()});
    // OpenVDB winds them with the clock.
    for (const openvdb::Vec3I& t : triangles)
        mesh.triangles.push_back({int32_t(t[0]), int32_t(t[2]), int32_t(t[1])});
    for (const openvdb::Vec4I& q : quads) {
        mesh.triangles.push_back({int32_t(q[0]), int32_t(q[2]), int32_t(q[1])});
        mesh.triangles.push_back({int32_t(q[0]), int32_t(q[3]), int32_t(q[2])});
    }
    mesh.volume = volumeOf(mesh);
    return mesh;
}

}  // namespace

FluidLevelSet::FluidLevelSet(const std::vector<Vec3d>& particles, double spacing,
                             const SurfaceMethod& method)
    : grid_(std::make_unique<Grid>()),
      farthest_(std::min(0.45, 0.9 * Band * method.cell) * spacing) {
    const double cell = method.cell * spacing;
    requireFluidMeshes("surface", cell);
    openvdb::initialize();
    const std::vector<openvdb::Vec3d> places = pointsOf(particles);
    grid_->distances = method.anisotropic ? stretchedKernels(places, spacing, cell)
                                          : smoothSpheres(places, spacing, cell);
    openvdb::tools::Filter<openvdb::FloatGrid> filter(*grid_->distances);
    if (const int times = smoothingsOf(method); times > 0) filter.mean(1, times);
}
FluidLevelSet::~FluidLevelSet() = default;

// The secant method; at first a shift changes the volume by the area.
FluidMesh FluidLevelSet::mesh(double volume, double& shift) const {
    shift = 0;
    FluidMesh mesh = meshAt(*grid_->distances, shift);
    double slope = areaOf(mesh);
    for (int k = 0; k < 6 && std::abs(mesh.volume - volume) > 1e-3 * volume && slope > 0; ++k) {
        const double next =
            std::clamp(shift + (volume - mesh.volume) / slope, -farthest_, farthest_);
        if (next == shift) break;
        const double before = mesh.volume;
        mesh = meshAt(*grid_->distances, next);
        slope = (mesh.volume - before) / (next - shift);
        shift = next;
    }
    return mesh;
}

bool FluidLevelSet::writeVdb(const std::string& path, double shift) const {
    const openvdb::FloatGrid::Ptr level =
        openvdb::tools::levelSetRebuild(*grid_->distances, float(shift), float(Band));
    level->setName("surface");
    try {
        openvdb::io::File file(path);
        file.write({level});
        file.close();
    } catch (const openvdb::Exception&) { return false; }
    return true;
}

}  // namespace spindrift
