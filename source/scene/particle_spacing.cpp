#include "scene/particle_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace spindrift {
namespace {

// Places sorted into about as many cells as there are places.
class Cells {
public:
    explicit Cells(const std::vector<Vec3d>& places) : places_(places), low_(places[0]) {
        Vec3d high = places[0];
        for (const Vec3d& p : places)
            for (int k = 0; k < 3; ++k)
                low_[k] = std::min(low_[k], p[k]), high[k] = std::max(high[k], p[k]);
        const Vec3d size = high - low_;
        const double longest = std::max({size.x, size.y, size.z, 1e-30});
        // Flat sets of places have one layer of cells.
        auto count = [&](double width) {
            double cells = 1;
            for (int k = 0; k < 3; ++k) cells *= std::floor(size[k] / width) + 1;
            return cells;
        };
        for (width_ = longest; count(width_ / 2) <= double(places.size());) width_ /= 2;
        for (int k = 0; k < 3; ++k) cells_[k] = int64_t(size[k] / width_) + 1;
        start_.assign(size_t(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
        for (const Vec3d& p : places) ++start_[cellOf(p) + 1];
        for (size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
        std::vector<size_t> next = start_;
        sorted_.resize(places.size());
        for (size_t i = 0; i < places.size(); ++i) sorted_[next[cellOf(places[i])]++] = i;
    }
    double width() const { return width_; }
    // Calls f(index, way there) for the places within `radius` of x, x itself among them.
    template <class F> void near(Vec3d x, double radius, const F& f) const {
        int64_t from[3], to[3];
        for (int k = 0; k < 3; ++k) {
            from[k] = std::max<int64_t>(int64_t(std::floor((x[k] - radius - low_[k]) / width_)), 0);
            to[k] = std::min<int64_t>(int64_t(std::floor((x[k] + radius - low_[k]) / width_)),
                                      cells_[k] - 1);
        }
        for (int64_t z = from[2]; z <= to[2]; ++z)
            for (int64_t y = from[1]; y <= to[1]; ++y)
                for (int64_t c = from[0]; c <= to[0]; ++c) {
                    const size_t cell = size_t((z * cells_[1] + y) * cells_[0] + c);
                    for (size_t s = start_[cell]; s < start_[cell + 1]; ++s) {
                        const Vec3d way = places_[sorted_[s]] - x;
                        if (dot(way, way) < radius * radius) f(sorted_[s], way);
                    }
                }
    }

private:
    size_t cellOf(Vec3d p) const {
        int64_t at[3];
        for (int k = 0; k < 3; ++k)
            at[k] = std::min(int64_t((p[k] - low_[k]) / width_), cells_[k] - 1);
        return size_t((at[2] * cells_[1] + at[1]) * cells_[0] + at[0]);
    }

    const std::vector<Vec3d>& places_;
    Vec3d low_;
    double width_ = 1;
    int64_t cells_[3] = {1, 1, 1};
    std::vector<size_t> start_, sorted_;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + long(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// A regular share of the places, enough for a median.
template <class F> void forSample(const std::vector<Vec3d>& places, const F& f) {
    constexpr size_t Most = 10'000;
    for (size_t i = 0; i < places.size(); i += places.size() / Most + 1) f(i);
}

double nearestDistance(const std::vector<Vec3d>& places, const Cells& cells) {
    std::vector<double> distances;
    forSample(places, [&](size_t i) {
        double least = std::numeric_limits<double>::infinity();
        for (double radius = cells.width(); radius < 64 * cells.width() && std::isinf(least);
             radius *= 2)
            cells.near(places[i], radius, [&](size_t j, Vec3d way) {
                if (j != i) least = std::min(least, length(way));
            });
        if (std::isfinite(least)) distances.push_back(least);
    });
    return distances.empty() ? 0 : median(distances);
}

}  // namespace

std::vector<std::pair<size_t, size_t>> doubledParticles(const std::vector<Vec3d>& places,
                                                        double distance, Vec3d periods) {
    std::vector<std::pair<size_t, size_t>> found;
    if (places.empty()) return found;
    const Cells cells(places);
    for (size_t i = 0; i < places.size(); ++i) {
        size_t first = i;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    if ((x != 0 && periods.x <= 0) || (y != 0 && periods.y <= 0) ||
                        (z != 0 && periods.z <= 0))
                        continue;
                    const Vec3d image =
                        places[i] + Vec3d{x * periods.x, y * periods.y, z * periods.z};
                    cells.near(image, distance,
                               [&](size_t j, Vec3d) { first = std::min(first, j); });
                }
        if (first < i) found.push_back({i, first});
    }
    return found;
}

double spacingBetween(const std::vector<Vec3d>& places, int dimensions) {
    constexpr size_t Fewest = 20;
    if (places.size() < Fewest) return 0;
    const Cells cells(places);
    double spacing = nearestDistance(places, cells);
    // The sum of Wendland's kernel whose radius is two spacings is this large on a lattice; what is
    // not at the rim has all that it sees around it.
    const double onLattice = dimensions == 2 ? 1.0376 : 1.0338,
                 norm = dimensions == 2 ? 7 / std::numbers::pi : 10.5 / std::numbers::pi;
    for (int round = 0; round < 4 && spacing > 0; ++round) {
        const double radius = 2 * spacing;
        std::vector<double> sums;
        forSample(places, [&](size_t i) {
            double sum = 0;
            unsigned sectors = 0;
            cells.near(places[i], radius, [&](size_t, Vec3d way) {
                const double q = length(way) / radius;
                sum += std::pow(1 - q, 4) * (1 + 4 * q);
                const double least = 0.1 * spacing;
                if (std::abs(way.x) > least && std::abs(way.y) > least &&
                    (dimensions == 2 || std::abs(way.z) > least))
                    sectors |= 1u << ((way.x > 0) + 2 * (way.y > 0) +
                                      (dimensions == 2 ? 0 : 4 * (way.z > 0)));
            });
            if (sectors == (dimensions == 2 ? 0xfu : 0xffu)) sums.push_back(sum);
        });
        if (sums.size() < Fewest) return 0;
        const double density = median(sums) * norm / std::pow(radius, dimensions);
        spacing = std::pow(density / onLattice, -1.0 / dimensions);
    }
    return spacing;
}

}  // namespace spindrift
