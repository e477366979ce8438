#include "app/inside.h"

#include "render/renderer.h"

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace {

Vec3 domainSize(const Scene& scene) { return scene.domain.max - scene.domain.min; }

int axisOf(const Slice& slice) { return int(slice.axis) - int(Across::X); }
bool flat(const Scene& scene) { return scene.simulation.dimensions == 2; }

// m from the domain's lower corner; in two dimensions in the particles' layer.
float placeOf(const Scene& scene) {
    const int axis = axisOf(scene.view.slice);
    const float share = flat(scene) && axis == 2 ? 0.5f : scene.view.slice.position;
    return share * domainSize(scene)[axis];
}

// Two points a spacing, but never more than so many along a side.
constexpr float mostPoints = 256;
float stepOf(const Scene& scene, Vec3 size) {
    return std::max(0.5f * scene.simulation.spacing,
                    std::max({size.x, size.y, size.z}) / mostPoints);
}

}  // namespace

float slicePlace(const Scene& scene) {
    return scene.domain.min[axisOf(scene.view.slice)] + placeOf(scene);
}

SliceField sliceOf(const Scene& scene, const std::vector<Vertex>& fluid, const Sees& sees) {
    const Vec3 size = domainSize(scene);
    const int normal = axisOf(scene.view.slice), u = normal == 0 ? 2 : 0, v = normal == 1 ? 2 : 1;
    const float step = stepOf(scene, size);
    SliceField field;
    field.corner[normal] = placeOf(scene);
    field.across[u] = size[u], field.along[v] = size[v];
    field.columns = std::max(1, int(std::lround(size[u] / step)));
    field.rows = std::max(1, int(std::lround(size[v] / step)));
    std::vector<Vec3d> points;
    for (int row = 0; row < field.rows; ++row)
        for (int column = 0; column < field.columns; ++column)
            points.push_back(toDouble(
                field.corner + ((float(column) + 0.5f) / float(field.columns)) * field.across +
                ((float(row) + 0.5f) / float(field.rows)) * field.along));
    const double R = supportRadius(scene);
    std::vector<Sample> near;
    for (const Vertex& p : fluid) {
        const float at[] = {p.x, p.y, p.z};
        if (std::abs(at[normal] - field.corner[normal]) < R || scene.domain.periodic(normal))
            near.push_back({{p.x, p.y, p.z}, p.value});
    }
    Surroundings around = surroundings(scene, Surroundings::Mirror);
    around.high = around.high - around.low, around.low = {0, 0, 0};
    const double filled = filledBy(scene, R);
    for (const Smoothed& s : interpolate(near, PointsNear(points, R, around), sees))
        field.points.push_back({float(s.value), float(filled * s.weight)});
    return field;
}

float arrowStep(const Scene& scene) {
    const Vec3 size = domainSize(scene);
    const float longest =
        flat(scene) ? std::max(size.x, size.y) : std::max({size.x, size.y, size.z});
    return std::max(longest / float(std::max(scene.view.arrows.count, 1)),
                    scene.simulation.spacing);
}

std::vector<CellVelocity> velocitiesOf(const Scene& scene, const std::vector<Particle>& particles) {
    const Vec3 size = domainSize(scene);
    const float step = arrowStep(scene);
    const bool slices = scene.view.slice.axis != Across::None;
    const int normal = axisOf(scene.view.slice);
    const ClipBox box = clipBox(scene);
    int cells[3];
    Vec3 low, side;  // of the first cell; of all
    for (int k = 0; k < 3; ++k) {
        const bool alone = (slices && k == normal) || (flat(scene) && k == 2);
        cells[k] = alone ? 1 : std::max(1, int(std::lround(size[k] / step)));
        // Two layers of particles at least.
        side[k] = alone ? std::max(step, 2 * scene.simulation.spacing) : size[k] / float(cells[k]);
        low[k] = !alone ? 0 : (slices && k == normal ? placeOf(scene) : size[k] / 2) - side[k] / 2;
    }
    struct Sum {
        Vec3d velocity;
        int count = 0;
    };
    std::vector<Sum> sums(size_t(cells[0]) * size_t(cells[1]) * size_t(cells[2]));
    for (const Particle& p : particles) {
        const Vec3 x = toFloat(p.position) - scene.domain.min;
        int at[3];
        bool inside = box.holds(x) || slices;
        for (int k = 0; k < 3; ++k) {
            at[k] = int(std::floor((x[k] - low[k]) / side[k]));
            inside = inside && at[k] >= 0 && at[k] < cells[k];
        }
        if (!inside) continue;
        Sum& sum = sums[size_t((at[2] * cells[1] + at[1]) * cells[0] + at[0])];
        sum.velocity = sum.velocity + p.velocity, ++sum.count;
    }
    const double room = flat(scene) ? double(side.x) * double(side.y)
                                    : double(side.x) * double(side.y) * double(side.z);
    const double enough = 0.5 * room / particleVolume(scene);
    std::vector<CellVelocity> found;
    for (size_t c = 0; c < sums.size(); ++c) {
        if (sums[c].count < enough) continue;
        const int i = int(c),
                  at[] = {i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1]};
        Vec3 middle;
        for (int k = 0; k < 3; ++k) middle[k] = low[k] + (float(at[k]) + 0.5f) * side[k];
        found.push_back({middle, toFloat((1.0 / sums[c].count) * sums[c].velocity)});
    }
    return found;
}

bool ClipBox::holds(Vec3 at) const {
    for (int k = 0; k < 3; ++k)
        if (at[k] < low[k] || at[k] > high[k]) return false;
    return true;
}

ClipBox clipBox(const Scene& scene) {
    const Clip& clip = scene.view.clip;
    const Vec3 size = domainSize(scene);
    ClipBox box{{-nowhere, -nowhere, -nowhere}, {nowhere, nowhere, nowhere}};
    for (int k = 0; k < 3; ++k) {
        if (clip.min[k] > 0) box.low[k] = clip.min[k] * size[k];
        if (clip.max[k] < 1) box.high[k] = clip.max[k] * size[k];
    }
    return box;
}

}  // namespace spindrift
