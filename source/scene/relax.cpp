#include "scene/relax.h"

#include "core/task.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

// Of the kernel, Wendland's C2, in spacings.
constexpr double Radius = 2.6;
// The way of a step is so much R^2 grad C (0.2 is unstable), and never more than so many spacings.
constexpr double Strength = 0.1, Longest = 0.2;
// The share of a step's way that the next one goes on with (Polyak 1964), beside boundary
// particles: what is uneven over many spacings fades several times faster, forces that push
// particles from their places by four. Drops in free space, so packed, lie in rows and swing 8.5
// instead of 4.8 % too slowly.
constexpr double Momentum = 0.8;

// Of Wendland's kernel without its factor, and that.
double weight(double q) {
    const double rest = 1 - q;
    return q < 1 ? rest * rest * rest * rest * (1 + 4 * q) : 0;
}
double normOf(int d, double radius) {
    return d == 2 ? 7 / (std::numbers::pi * radius * radius)
                  : 21 / (2 * std::numbers::pi * radius * radius * radius);
}

// What repels: places and volumes, sorted into cells that are at least a radius wide.
class Crowd {
public:
    Crowd(const Region& region, double radius)
        : region_(region), radius_(radius), size_(region.high - region.low) {
        for (int k = 0; k < 3; ++k) {
            const bool flat = region.dimensions == 2 && k == 2;
            const double around = region.periodic[k] ? 0 : radius, length = size_[k] + 2 * around;
            low_[k] = region.low[k] - around;
            cells_[k] = flat ? 1 : std::max(int(length / radius), 1);
            width_[k] = flat ? 1e30 : length / cells_[k];
        }
    }
    void fill(const std::vector<Vec3d>& places, const std::vector<double>& volumes) {
        std::vector<int> cell(places.size());
        start_.assign(size_t(cells_[0]) * size_t(cells_[1]) * size_t(cells_[2]) + 1, 0);
        for (size_t i = 0; i < places.size(); ++i)
            ++start_[size_t(cell[i] = cellOf(places[i])) + 1];
        for (size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
        std::vector<int> next = start_;
        places_.resize(places.size()), volumes_.resize(places.size());
        for (size_t i = 0; i < places.size(); ++i) {
            const size_t to = size_t(next[size_t(cell[i])]++);
            places_[to] = places[i], volumes_[to] = volumes[i];
        }
    }
    // sum V r (1 - q)^3, which the gradient of Wendland's kernel is but for a factor: away from
    // those who are near.
    Vec3d push(Vec3d x) const {
        Vec3d sum{0, 0, 0};
        forCellsNear(x, [&](int cell, Vec3d seen) { sum = sum + pushOf(cell, seen); });
        return sum;
    }
    // sum V W, without the kernel's factor.
    double sum(Vec3d x) const {
        double sum = 0;
        forCellsNear(x, [&](int cell, Vec3d seen) {
            for (int j = start_[size_t(cell)]; j < start_[size_t(cell) + 1]; ++j)
                sum += volumes_[size_t(j)] * weight(length(seen - places_[size_t(j)]) / radius_);
        });
        return sum;
    }

private:
    template <class F> void forCellsNear(Vec3d x, const F& f) const {
        int at[3], reach[3];
        for (int k = 0; k < 3; ++k)
            at[k] = indexOf(x, k), reach[k] = region_.dimensions == 2 && k == 2 ? 0 : 1;
        for (int z = -reach[2]; z <= reach[2]; ++z)
            for (int y = -reach[1]; y <= reach[1]; ++y)
                for (int dx = -reach[0]; dx <= reach[0]; ++dx) {
                    Vec3d seen = x;  // from the cell's own image of the domain
                    const int cell = neighbour(at, dx, y, z, seen);
                    if (cell >= 0) f(cell, seen);
                }
    }
    int indexOf(Vec3d x, int k) const {
        return std::clamp(int(std::floor((x[k] - low_[k]) / width_[k])), 0, cells_[k] - 1);
    }
    int cellOf(Vec3d x) const {
        return (indexOf(x, 2) * cells_[1] + indexOf(x, 1)) * cells_[0] + indexOf(x, 0);
    }
    int neighbour(const int (&at)[3], int x, int y, int z, Vec3d& seen) const {
        int cell[3] = {at[0] + x, at[1] + y, at[2] + z};
        for (int k = 0; k < 3; ++k) {
            if (cell[k] >= 0 && cell[k] < cells_[k]) continue;
            if (!region_.periodic[k]) return -1;
            const int n = cell[k] < 0 ? cells_[k] : -cells_[k];
            cell[k] += n, seen[k] += n > 0 ? size_[k] : -size_[k];
        }
        return (cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0];
    }
    Vec3d pushOf(int cell, Vec3d x) const {
        Vec3d sum{0, 0, 0};
        for (int j = start_[size_t(cell)]; j < start_[size_t(cell) + 1]; ++j) {
            const Vec3d r = x - places_[size_t(j)];
            const double q2 = dot(r, r) / (radius_ * radius_);
            if (q2 >= 1) continue;
            const double rest = 1 - std::sqrt(q2);
            sum = sum + (volumes_[size_t(j)] * rest * rest * rest) * r;
        }
        return sum;
    }

    const Region& region_;
    double radius_;
    Vec3d size_, low_, width_;  // m
    int cells_[3];
    std::vector<int> start_;
    std::vector<Vec3d> places_;
    std::vector<double> volumes_;
};

// Calls f(middle of a cell) for the cells of a lattice over the box and a margin around its sides
// that are not periodic. Returns the volume of a cell.
template <class F> double forCells(const Region& region, double width, double margin, const F& f) {
    int64_t n[3];
    Vec3d first, step;
    double volume = 1;
    for (int k = 0; k < 3; ++k) {
        const double around = region.periodic[k] ? 0 : margin,
                     length = region.high[k] - region.low[k] + 2 * around;
        const bool flat = region.dimensions == 2 && k == 2;
        n[k] = flat ? 1 : std::max<int64_t>(1, std::llround(length / width));
        step[k] = flat ? 0 : length / double(n[k]);
        first[k] =
            flat ? 0.5 * (region.low[k] + region.high[k]) : region.low[k] + 0.5 * step[k] - around;
        volume *= flat ? 1 : step[k];
    }
    for (int64_t z = 0; z < n[2]; ++z)
        for (int64_t y = 0; y < n[1]; ++y)
            for (int64_t x = 0; x < n[0]; ++x)
                f(Vec3d{first.x + double(x) * step.x, first.y + double(y) * step.y,
                        first.z + double(z) * step.z});
    return volume;
}

}  // namespace

double volumeOf(const Region& region, double spacing) {
    double cells = 0;
    const double width = spacing / 2;
    const double volume =
        forCells(region, width, 0, [&](Vec3d p) { cells += region.inside(p, width); });
    return cells * volume;
}

struct Packing::Crowds {
    Crowd surroundings, crowd;
};

Packing::Packing(const Region& region, double spacing, int threads)
    : region_(region),
      spacing_(spacing),
      team_(threads > 0 ? threads : omp_get_max_threads()),
      crowds_(new Crowds{{region, Radius * spacing}, {region, Radius * spacing}}) {
    const double radius = Radius * spacing, width = spacing / 2;
    std::vector<Vec3d> outside;
    std::vector<double> volumes;
    const double cell = forCells(region, width, radius, [&](Vec3d p) {
        if (region.isNear && !region.isNear(p)) return;
        const double share = region.air ? region.air(p, width) : 1 - region.inside(p, width);
        // What no particle can see is left out.
        if (share > 0 && region.inside(p, 2 * (radius + spacing)) > 0)
            outside.push_back(p), volumes.push_back(share);
    });
    for (double& v : volumes) v *= cell;
    outside.insert(outside.end(), region.boundary.begin(), region.boundary.end());
    volumes.insert(volumes.end(), region.boundaryVolumes.begin(), region.boundaryVolumes.end());
    crowds_->surroundings.fill(outside, volumes);
}
Packing::~Packing() = default;

Vec3d Packing::into(Vec3d x) const {
    if (region_.out) x = region_.out(x);
    for (int k = 0; k < region_.dimensions; ++k) {
        const double low = region_.low[k], high = region_.high[k], size = high - low;
        x[k] = region_.periodic[k] ? x[k] - size * std::floor((x[k] - low) / size)
                                   : std::clamp(x[k], std::min(low + spacing_ / 4, high),
                                                std::max(high - spacing_ / 4, low));
    }
    return x;
}

void Packing::fill(const std::vector<Vec3d>& positions) {
    const double own = std::pow(spacing_, region_.dimensions);
    crowds_->crowd.fill(positions, std::vector<double>(positions.size(), own));
}

void Packing::relax(std::vector<Vec3d>& positions, int steps) {
    // grad W = -20 norm / R^2 r (1 - q)^3.
    const int d = region_.dimensions;
    const double strength = 20 * normOf(d, Radius * spacing_) * Strength;
    std::vector<Vec3d> next(positions.size());
    std::vector<Vec3d> ways(positions.size());  // of the step before
    const double momentum = region_.boundary.empty() ? 0 : Momentum;
    auto moved = [&](Vec3d x, Vec3d& before) {
        const Vec3d push = crowds_->crowd.push(x) + crowds_->surroundings.push(x);
        Vec3d way = strength * push + momentum * before;
        if (d == 2) way.z = 0;
        const double far = length(way), most = Longest * spacing_;
        way = (far > most ? most / far : 1) * way;
        before = way;
        return into(x + way);
    };
    for (Vec3d& x : positions) x = into(x);
    for (int step = 0; step < steps; ++step) {
        tell("packing particles", double(step) / steps);
        fill(positions);
#pragma omp parallel for schedule(dynamic, 256) num_threads(team_)
        for (size_t i = 0; i < positions.size(); ++i) next[i] = moved(positions[i], ways[i]);
        positions.swap(next);
    }
}

std::vector<double> Packing::densities(const std::vector<Vec3d>& positions) {
    const int d = region_.dimensions;
    const double own = std::pow(spacing_, d);
    double lattice = 0;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = d == 2 ? 0 : -2; z <= (d == 2 ? 0 : 2); ++z)
                lattice += own * weight(std::sqrt(double(x * x + y * y + z * z)) / Radius);
    fill(positions);
    std::vector<double> sums(positions.size());
#pragma omp parallel for schedule(dynamic, 256) num_threads(team_)
    for (size_t i = 0; i < positions.size(); ++i)
        sums[i] =
            (crowds_->crowd.sum(positions[i]) + crowds_->surroundings.sum(positions[i])) / lattice;
    return sums;
}

void relax(std::vector<Vec3d>& positions, const Region& region, double spacing, int threads) {
    Packing(region, spacing, threads).relax(positions, Packing::Steps);
}

}  // namespace spindrift
