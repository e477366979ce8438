#include "app/stretched_kernels.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/PointIndexGrid.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

using openvdb::Coord, openvdb::Vec3d, openvdb::Vec3f;
using Matrix = openvdb::math::Mat3<double>;

constexpr double Reach = 4;        // spacings: of neighbours, and of a kernel's longest axis
constexpr double Smoothing = 0.9;  // how far a particle goes to where those around it are
constexpr double Flattest = 0.25;  // shortest / longest axis
constexpr double Alone = 0.3;      // axes of a drop / those in the middle of fluid,
constexpr size_t Few = 10;         // which is fewer particles than this within reach
// Where so many are within reach, of 268 in the middle of fluid, and lie so evenly around it, as a
// share of what they do at a plane, the surface is too far away to see a particle's kernel, which
// is round and small then.
constexpr size_t Full = 200;
constexpr double Deep = 0.1, Inside = 0.55;

// Places as OpenVDB reads them.
struct Points {
    using PosType = Vec3d;
    const std::vector<Vec3d>& places;
    size_t size() const { return places.size(); }
    void getPos(size_t n, Vec3d& place) const { place = places[n]; }
};
using Index = openvdb::tools::PointIndexGrid;

// Calls f(i, near) for each particle, several at a time; near(g) calls g(j, way there, weight) for
// those within `reach`, itself among them.
template <class F>
void forNeighbours(const std::vector<Vec3d>& places, double reach, const Index& index, const F& f) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, places.size(), 1024), [&](const auto& range) {
        const Points points{places};
        openvdb::tools::PointIndexFilter<Points> search(points, index.tree(), index.transform());
        for (size_t i = range.begin(); i < range.end(); ++i)
            f(i, [&](const auto& g) {
                struct Found {
                    const decltype(g)& act;
                    const std::vector<Vec3d>& places;
                    Vec3d x;
                    double reach;
                    void operator()(double squared, size_t j) const {
                        const double q = std::sqrt(squared) / reach;
                        act(j, places[j] - x, 1 - q * q * q);
                    }
                } found{g, places, places[i], reach};
                search.searchAndApply(places[i], reach, found);
            });
    });
}

// How the particles around one lie.
struct Around {
    Vec3d way = Vec3d(0.0);          // to their middle, m
    Matrix spread = Matrix::zero();  // covariance, m^2
    size_t count = 0;
};

template <class Near> Around lookAround(const Near& near) {
    Around around;
    double weight = 0, sums[6] = {};
    near([&](size_t, const Vec3d& d, double w) {
        weight += w, around.way += w * d, ++around.count;
        sums[0] += w * d[0] * d[0], sums[1] += w * d[1] * d[1], sums[2] += w * d[2] * d[2];
        sums[3] += w * d[0] * d[1], sums[4] += w * d[0] * d[2], sums[5] += w * d[1] * d[2];
    });
    around.way /= weight;
    around.spread =
        Matrix(sums[0], sums[3], sums[4], sums[3], sums[1], sums[5], sums[4], sums[5], sums[2]) *
        (1 / weight);
    for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q) around.spread(p, q) -= around.way[p] * around.way[q];
    return around;
}

// (1 - x.Ax)^3 of a volume that it has in all.
struct Kernel {
    Vec3f place, extent;           // m; half of the box around it
    float xx, yy, zz, xy, xz, yz;  // A, 1/m^2
    float most;
};

Kernel kernelOf(const Vec3d& place, const Matrix& axes, const Vec3d& lengths, double spacing) {
    Matrix a = Matrix::zero();
    Vec3d extent(0.0);
    for (int k = 0; k < 3; ++k) {
        const Vec3d axis = axes.col(k);
        for (int p = 0; p < 3; ++p) {
            extent[p] += std::pow(lengths[k] * axis[p], 2);
            for (int q = 0; q < 3; ++q) a(p, q) += axis[p] * axis[q] / (lengths[k] * lengths[k]);
        }
    }
    // 64 pi / 315 is the integral over the unit ball.
    const double most = std::pow(spacing, 3) / (lengths[0] * lengths[1] * lengths[2]) * 315 /
                        (64 * std::numbers::pi);
    return {Vec3f(place),
            Vec3f(float(std::sqrt(extent[0])), float(std::sqrt(extent[1])),
                  float(std::sqrt(extent[2]))),
            float(a(0, 0)),
            float(a(1, 1)),
            float(a(2, 2)),
            float(a(0, 1)),
            float(a(0, 2)),
            float(a(1, 2)),
            float(most)};
}

Kernel roundKernel(const Vec3d& place, double length, double spacing) {
    return kernelOf(place, Matrix::identity(), Vec3d(length), spacing);
}

// As the particles around it lie.
Kernel stretchedKernel(const Vec3d& place, const Around& around, double spacing) {
    const double reach = Reach * spacing,
                 usual = 0.15 * reach * reach;  // spread along each axis in the middle of fluid
    if (around.count < Few) return roundKernel(place, Alone * reach, spacing);
    Matrix axes;
    Vec3d lengths;
    openvdb::math::diagonalizeSymmetricMatrix(around.spread, axes, lengths);
    for (int k = 0; k < 3; ++k)
        lengths[k] = reach * std::min(std::sqrt(std::max(lengths[k], 0.0) / usual), 1.0);
    const double least = Flattest * std::max({lengths[0], lengths[1], lengths[2]});
    for (int k = 0; k < 3; ++k) lengths[k] = std::max(lengths[k], least);
    return kernelOf(place, axes, lengths, spacing);
}

// Each particle goes to where those around it are, as Yu and Turk have it, but less what its like,
// as near to the surface as it is, do in the mean: otherwise all of the surface would go inwards.
std::vector<Kernel> kernelsOf(const std::vector<Vec3d>& places, double spacing) {
    const double reach = Reach * spacing;
    const Index::Ptr index = openvdb::tools::createPointIndexGrid<Index>(Points{places}, reach / 2);
    std::vector<Around> around(places.size());
    forNeighbours(places, reach, *index,
                  [&](size_t i, const auto& near) { around[i] = lookAround(near); });
    const double flat = 0.32 * reach;  // the way to the middle of what is on one side of a plane
    std::vector<Kernel> kernels(places.size());
    forNeighbours(places, reach, *index, [&](size_t i, const auto& near) {
        const double own = around[i].way.length();
        if (own < Deep * flat && around[i].count > Full) {
            kernels[i] = roundKernel(places[i], Inside * reach, spacing);
            return;
        }
        Vec3d mean(0.0);
        double weight = 0;
        near([&](size_t j, const Vec3d&, double w) {
            const double unlike = (around[j].way.length() - own) / flat;
            w /= 1 + 4 * unlike * unlike;
            mean += w * around[j].way, weight += w;
        });
        const Vec3d way = around[i].way - mean / weight;
        kernels[i] = stretchedKernel(places[i] + Smoothing * way, around[i], spacing);
    });
    return kernels;
}

using Leaf = openvdb::FloatTree::LeafNodeType;

// What of a kernel lies in a leaf.
void add(const Kernel& k, double cell, Leaf& leaf) {
    const Coord origin = leaf.origin();
    int from[3], to[3];
    for (int p = 0; p < 3; ++p) {
        const double middle = double(k.place[p]) / cell - origin[p],
                     half = double(k.extent[p]) / cell;
        from[p] = std::max(int(std::ceil(middle - half)), 0);
        to[p] = std::min(int(std::floor(middle + half)), int(Leaf::DIM) - 1);
    }
    const auto way = [&](int p, int at) { return float(cell * (origin[p] + at)) - k.place[p]; };
    for (int x = from[0]; x <= to[0]; ++x)
        for (int y = from[1]; y <= to[1]; ++y) {
            const float dx = way(0, x), dy = way(1, y);
            const float constant = k.xx * dx * dx + k.yy * dy * dy + 2 * k.xy * dx * dy,
                        linear = 2 * (k.xz * dx + k.yz * dy);
            float* row = leaf.buffer().data() + Leaf::DIM * (Leaf::DIM * size_t(x) + size_t(y));
            for (int z = from[2]; z <= to[2]; ++z) {
                const float dz = way(2, z);
                const float rest = std::max(1 - constant - (linear + k.zz * dz) * dz, 0.0f);
                row[z] += k.most * rest * rest * rest;
            }
        }
}

// Leaves wherever a kernel is.
void makeRoom(const std::vector<Kernel>& kernels, double cell, openvdb::FloatGrid& grid) {
    openvdb::FloatGrid::Accessor accessor = grid.getAccessor();
    constexpr int size = Leaf::DIM;
    for (const Kernel& k : kernels) {
        Coord from, to;
        for (int p = 0; p < 3; ++p) {
            from[p] = int(std::floor(double(k.place[p] - k.extent[p]) / cell)) & ~(size - 1);
            to[p] = int(std::ceil(double(k.place[p] + k.extent[p]) / cell));
        }
        for (int x = from.x(); x <= to.x(); x += size)
            for (int y = from.y(); y <= to.y(); y += size)
                for (int z = from.z(); z <= to.z(); z += size) accessor.touchLeaf({x, y, z});
    }
}

}  // namespace

openvdb::FloatGrid::Ptr stretchedKernels(const std::vector<Vec3d>& places, double spacing,
                                         double cell) {
    const std::vector<Kernel> kernels = kernelsOf(places, spacing);
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(cell));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    makeRoom(kernels, cell, *grid);
    std::vector<Vec3d> middles;
    for (const Kernel& k : kernels) middles.push_back(Vec3d(k.place));
    const Index::Ptr index = openvdb::tools::createPointIndexGrid<Index>(Points{middles}, 8 * cell);
    // No kernel is wider than its neighbours are far.
    const Vec3d reach(Reach * spacing);
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(grid->tree());
    leaves.foreach ([&](Leaf& leaf, size_t) {
        const Vec3d low = cell * leaf.origin().asVec3d(),
                    high = low + Vec3d(cell * (Leaf::DIM - 1));
        Index::ConstAccessor near = index->getConstAccessor();
        openvdb::tools::PointIndexIterator<Index::TreeType> found;
        found.searchAndUpdate(
            openvdb::CoordBBox(index->transform().worldToIndexCellCentered(low - reach),
                               index->transform().worldToIndexCellCentered(high + reach)),
            near);
        for (; found; ++found) add(kernels[*found], cell, leaf);
        for (size_t v = 0; v < Leaf::SIZE; ++v) {
            float& value = leaf.buffer().data()[v];
            value = float(spacing) * (0.5f - value);
        }
        leaf.setValuesOn();
    });
    openvdb::tools::changeBackground(grid->tree(), 0.5f * float(spacing));
    return grid;
}

}  // namespace spindrift
