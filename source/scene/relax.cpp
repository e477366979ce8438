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

// Of Wendland's kernel without its factor.
double weight(double q) {
    const double rest = 1 - q;
    return q < 1 ? rest * rest * rest * rest * (1 + 4 * q) : 0;
}

constexpr int Wide = 4;  // floats in a register that each processor has: starts are alike on all

// What repels: places and volumes in radii, sorted into cells half a radius wide or a bit more. The
// cells of a row along x lie one behind the other, so that a row is summed as one stretch. Floats
// are enough for a push, which has nothing to conserve, and twice as fast.
class Crowd {
public:
    Crowd(const Region& region, double radius) : flat_(region.dimensions == 2), radius_(radius) {
        for (int k = 0; k < 3; ++k) {
            periodic_[k] = region.periodic[k];
            const double around = periodic_[k] ? 0 : radius,
                         length = region.high[k] - region.low[k] + 2 * around;
            low_[k] = region.low[k] - around;
            size_[k] = length / radius;
            cells_[k] = flat_ && k == 2 ? 1 : std::max(int((k == 0 ? 4 : 1) * size_[k]), 1);
            width_[k] = size_[k] / cells_[k];
        }
    }
    void fill(const std::vector<Vec3d>& places, const std::vector<double>& volumes) {
        std::vector<int> cell(places.size());
        start_.assign(size_t(cells_[0]) * size_t(cells_[1]) * size_t(cells_[2]) + 1, 0);
        for (size_t i = 0; i < places.size(); ++i)
            ++start_[size_t(cell[i] = cellOf(inRadii(places[i]))) + 1];
        for (size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
        std::vector<int> next = start_;
        for (std::vector<float>* list : {&x_, &y_, &z_, &volume_})
            list->resize(places.size() + Wide - 1);
        for (size_t i = 0; i < places.size(); ++i) {
            const size_t to = size_t(next[size_t(cell[i])]++);
            const Vec3d at = inRadii(places[i]);
            x_[to] = float(at.x), y_[to] = float(at.y), z_[to] = float(at.z);
            volume_[to] = float(volumes[i] / std::pow(radius_, flat_ ? 2 : 3));
        }
    }
    // sum V r (1 - q)^3 in radii, which the gradient of Wendland's kernel is but for a factor: away
    // from what is near.
    Vec3d push(Vec3d place) const {
        Push sum;
        forStretches(place, [&](Vec3d x, int first, int end) { addStretch(x, first, end, sum); });
        return {total(sum.x), total(sum.y), total(sum.z)};
    }
    // sum V W, times R^d over the kernel's factor.
    double sum(Vec3d place) const {
        double sum = 0;
        forStretches(place, [&](Vec3d x, int first, int end) {
            for (size_t j = size_t(first); j < size_t(end); ++j)
                sum += double(volume_[j]) * weight(length(x - Vec3d{x_[j], y_[j], z_[j]}));
        });
        return sum;
    }

private:
    // Calls f(x, first, end) for stretches of places that may be within reach, as seen from x,
    // radii.
    template <class F> void forStretches(Vec3d place, const F& f) const {
        const Vec3d x = inRadii(place);
        const Reach zs = flat_ ? Reach{0, 0} : reachOf(x, 2, 1), ys = reachOf(x, 1, 1);
        for (int z = zs.first; z <= zs.last; ++z)
            for (int y = ys.first; y <= ys.last; ++y) {
                const double gapY = gapTo(x, 1, y), gapZ = flat_ ? 0 : gapTo(x, 2, z),
                             rest = 1 - gapY * gapY - gapZ * gapZ;
                if (rest > 0) forRow(x, y, z, std::sqrt(rest), f);
            }
    }
    struct Push {
        float x[Wide]{}, y[Wide]{}, z[Wide]{};
    };
    static double total(const float (&lanes)[Wide]) {
        return double(lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    }
    struct Reach {
        int first, last;  // cells; along a periodic axis beyond its ends, as images of others
    };
    Vec3d inRadii(Vec3d place) const { return (1 / radius_) * (place - low_); }
    Reach reachOf(Vec3d x, int k, double far) const {
        const int first = int(std::floor((x[k] - far) / width_[k])),
                  last = int(std::floor((x[k] + far) / width_[k]));
        return periodic_[k] ? Reach{first, last}
                            : Reach{std::max(first, 0), std::min(last, cells_[k] - 1)};
    }
    // From a coordinate to the nearer side of a cell, 0 inside it.
    double gapTo(Vec3d x, int k, int cell) const {
        return std::max({cell * width_[k] - x[k], x[k] - (cell + 1) * width_[k], 0.0});
    }
    int cellOf(Vec3d x) const {
        int at[3];
        for (int k = 0; k < 3; ++k)
            at[k] = std::clamp(int(std::floor(x[k] / width_[k])), 0, cells_[k] - 1);
        return (at[2] * cells_[1] + at[1]) * cells_[0] + at[0];
    }
    int periodOf(int cell, int k) const {
        return cell >= 0 ? cell / cells_[k] : -((cells_[k] - 1 - cell) / cells_[k]);
    }
    template <class F> void forRow(Vec3d x, int y, int z, double far, const F& f) const {
        const int periodY = periodOf(y, 1), periodZ = periodOf(z, 2), n = cells_[0];
        x.y -= periodY * size_.y, x.z -= periodZ * size_.z;
        const int row = ((z - periodZ * cells_[2]) * cells_[1] + y - periodY * cells_[1]) * n;
        const Reach xs = reachOf(x, 0, far);
        for (int period = periodOf(xs.first, 0); period <= periodOf(xs.last, 0); ++period) {
            const int first = std::max(xs.first - period * n, 0),
                      last = std::min(xs.last - period * n, n - 1);
            f(x - Vec3d{period * size_.x, 0, 0}, start_[size_t(row + first)],
              start_[size_t(row + last) + 1]);
        }
    }
    void addStretch(Vec3d at, int first, int end, Push& sum) const {
        const float x = float(at.x), y = float(at.y), z = float(at.z);
        for (int block = first; block < end; block += Wide) {
#pragma omp simd
            for (int lane = 0; lane < Wide; ++lane) {
                const size_t j = size_t(block + lane);
                const float rx = x - x_[j], ry = y - y_[j], rz = z - z_[j];
                const float inside = 1 - std::sqrt(rx * rx + ry * ry + rz * rz);
                const float rest = inside > 0 && block + lane < end ? inside : 0;
                const float push = volume_[j] * rest * rest * rest;
                sum.x[lane] += push * rx, sum.y[lane] += push * ry, sum.z[lane] += push * rz;
            }
        }
    }

    bool flat_, periodic_[3];
    double radius_;             // m
    Vec3d low_, size_, width_;  // m; radii
    int cells_[3];
    std::vector<int> start_;
    std::vector<float> x_, y_, z_, volume_;
};

// Calls f(middle of a cell, its sides) for the cells of a lattice over the box and a margin around
// its sides that are not periodic. Returns the volume of a cell.
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
                        first.z + double(z) * step.z},
                  step);
    return volume;
}

// The part of a cell that is not the region's: its share and where it is, from the cell's eighths
// (in two dimensions quarters).
struct Share {
    double size = 0;
    Vec3d centroid{0, 0, 0};
};
Share shareOutside(const Region& region, Vec3d middle, Vec3d sides) {
    Share all;
    const int parts = 1 << region.dimensions;
    for (int part = 0; part < parts; ++part) {
        Vec3d p = middle;
        for (int k = 0; k < region.dimensions; ++k)
            p[k] += (part >> k & 1 ? 0.25 : -0.25) * sides[k];
        const double width = sides.x / 2,
                     share =
                         (region.air ? region.air(p, width) : 1 - region.inside(p, width)) / parts;
        all.size += share, all.centroid = all.centroid + share * p;
    }
    if (all.size > 0) all.centroid = (1 / all.size) * all.centroid;
    return all;
}

// sum V W at a point of it, as Crowd sums.
double sumOnLattice(int dimensions) {
    const int deep = dimensions == 2 ? 0 : 2;
    double sum = 0;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -deep; z <= deep; ++z)
                sum += weight(std::sqrt(double(x * x + y * y + z * z)) / Radius);
    return std::pow(Radius, -dimensions) * sum;
}

}  // namespace

std::function<double(Vec3d)> densityAround(const std::vector<Vec3d>& places,
                                           const std::vector<double>& volumes, const Region& region,
                                           double spacing) {
    const auto crowd = std::make_shared<Crowd>(region, Radius * spacing);
    crowd->fill(places, volumes);
    return [crowd, lattice = sumOnLattice(region.dimensions)](Vec3d p) {
        return crowd->sum(p) / lattice;
    };
}

// Of Wendland's kernel, summed over planes through its middle: 5/4 in one dimension.
double steepnessAtEnds(double spacing) { return 1.25 / (Radius * spacing); }

double volumeOf(const Region& region, double spacing) {
    double cells = 0;
    const double width = spacing / 2;
    const double volume =
        forCells(region, width, 0, [&](Vec3d p, Vec3d) { cells += region.inside(p, width); });
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
    const double radius = Radius * spacing;
    std::vector<Vec3d> outside;
    std::vector<double> volumes;
    const double width = region.dimensions == 2 ? spacing / 2 : spacing;  // finer where it is cheap
    const double cell = forCells(region, width, radius, [&](Vec3d middle, Vec3d sides) {
        // What no particle can see is left out.
        if (region.isNear && !region.isNear(middle)) return;
        if (region.inside(middle, 2 * (radius + spacing)) <= 0) return;
        const Share share = shareOutside(region, middle, sides);
        if (share.size > 0) outside.push_back(share.centroid), volumes.push_back(share.size);
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
    // R^2 grad W = -20 norm / R^d r (1 - q)^3.
    const int d = region_.dimensions;
    const double norm = (d == 2 ? 7 : 10.5) / std::numbers::pi,
                 strength = 20 * norm * Strength * Radius * spacing_;
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
    const double lattice = sumOnLattice(region_.dimensions);
    fill(positions);
    std::vector<double> sums(positions.size());
#pragma omp parallel for schedule(dynamic, 256) num_threads(team_)
    for (size_t i = 0; i < positions.size(); ++i)
        sums[i] =
            (crowds_->crowd.sum(positions[i]) + crowds_->surroundings.sum(positions[i])) / lattice;
    return sums;
}

void relax(std::vector<Vec3d>& positions, const Region& region, double spacing, int threads) {
    const int steps = region.boundary.empty() ? Packing::Steps : Packing::StepsWithMomentum;
    Packing(region, spacing, threads).relax(positions, steps);
}

}  // namespace spindrift
