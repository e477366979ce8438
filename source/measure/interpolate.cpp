#include "measure/interpolate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

// The first unknown of the normal equations for five right-hand sides at once: the field's value.
// Where all neighbours lie in a plane, a line or a point, the slopes across it are taken as 0.
constexpr int N = 4, Sides = 5;
struct Equations {
    double a[N][N] = {}, b[N][Sides] = {};

    void add(const double (&basis)[N], const double (&values)[Sides], double weight) {
        for (int r = 0; r < N; ++r) {
            for (int c = 0; c < N; ++c) a[r][c] += weight * basis[r] * basis[c];
            for (int s = 0; s < Sides; ++s) b[r][s] += weight * basis[r] * values[s];
        }
    }
    void solve(double (&out)[Sides], Order order) {
        if (a[0][0] <= 0) {
            std::fill(out, out + Sides, 0.0);
            return;
        }
        // About the neighbours' mean place the slopes' equations stand alone; then from the last
        // slope to the first.
        for (int r = 1; r < N; ++r) eliminate(r, 0);
        for (int k = N - 1; k > 0 && order == Order::Linear; --k)
            if (a[k][k] > 1e-9 * a[0][0])
                for (int r = 0; r < k; ++r) eliminate(r, k);
        for (int s = 0; s < Sides; ++s) out[s] = b[0][s] / a[0][0];
    }

private:
    // Takes column k out of row r.
    void eliminate(int r, int k) {
        const double factor = a[r][k] / a[k][k];
        for (int c = 0; c < N; ++c) a[r][c] -= factor * a[k][c];
        for (int s = 0; s < Sides; ++s) b[r][s] -= factor * b[k][s];
    }
};

// Where a point and its images are along an axis: those that particles in the box can be near to.
std::vector<double> placesOf(double at, double radius, double low, double high,
                             Surroundings::Beyond beyond) {
    std::vector<double> places{at};
    if (beyond == Surroundings::Nothing) return places;
    const bool mirror = beyond == Surroundings::Mirror;
    if (at - radius < low) places.push_back(mirror ? 2 * low - at : at + (high - low));
    if (at + radius > high) places.push_back(mirror ? 2 * high - at : at - (high - low));
    return places;
}

}  // namespace

PointsNear::PointsNear(const std::vector<Vec3d>& points, double radius, const Surroundings& s)
    : points_(points.size()), radius_(radius), cell_(radius) {
    auto places = [&](Vec3d p, int k) {
        return placesOf(p[k], radius, s.low[k], s.high[k], s.beyond[k]);
    };
    for (size_t p = 0; p < points.size(); ++p)
        for (double x : places(points[p], 0))
            for (double y : places(points[p], 1))
                for (double z : places(points[p], 2)) sites_.push_back({{x, y, z}, int(p)});
    if (!sites_.empty()) makeCells();
}

void PointsNear::makeCells() {
    constexpr double MostCells = 4e6;  // cells are made larger before there are more
    Vec3d high = low_ = sites_[0].position;
    for (const Site& site : sites_)
        for (int k = 0; k < 3; ++k)
            low_[k] = std::min(low_[k], site.position[k]),
            high[k] = std::max(high[k], site.position[k]);
    low_ = low_ - Vec3d{radius_, radius_, radius_};
    auto along = [&](int k) { return std::floor((high[k] + radius_ - low_[k]) / cell_) + 1; };
    while (along(0) * along(1) * along(2) > MostCells) cell_ *= 1.5;
    for (int k = 0; k < 3; ++k) cells_[k] = int(along(k));
    start_.assign(size_t(cells_[0]) * size_t(cells_[1]) * size_t(cells_[2]) + 1, 0);
    for (const Site& site : sites_) forCellsOf(site, [&](size_t cell) { ++start_[cell + 1]; });
    for (size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    listed_.resize(size_t(start_.back()));
    std::vector<int> next = start_;
    for (size_t s = 0; s < sites_.size(); ++s)
        forCellsOf(sites_[s], [&](size_t cell) { listed_[size_t(next[cell]++)] = int(s); });
}

// All cells that reach nearer than a radius to a site, and perhaps a few more.
template <class F> void PointsNear::forCellsOf(const Site& site, const F& f) const {
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) {
        const double at = (site.position[k] - low_[k]) / cell_, reach = radius_ / cell_ + 1e-9;
        first[k] = std::max(int(std::floor(at - reach)), 0),
        last[k] = std::min(int(std::floor(at + reach)), cells_[k] - 1);
    }
    for (int z = first[2]; z <= last[2]; ++z)
        for (int y = first[1]; y <= last[1]; ++y)
            for (int x = first[0]; x <= last[0]; ++x)
                f((size_t(z) * size_t(cells_[1]) + size_t(y)) * size_t(cells_[0]) + size_t(x));
}

int PointsNear::cellOf(Vec3d x) const {
    int at[3];
    for (int k = 0; k < 3; ++k) {
        const double cell = (x[k] - low_[k]) / cell_;
        if (!(cell >= 0 && cell < cells_[k])) return -1;
        at[k] = int(cell);
    }
    return (at[2] * cells_[1] + at[1]) * cells_[0] + at[0];
}

std::vector<Fields> interpolate(const std::vector<Particle>& particles, const PointsNear& points,
                                Order order, const Sees& sees) {
    std::vector<Equations> equations(points.points());
    std::vector<Fields> out(points.points());
    for (const Particle& p : particles)
        points.visit(p.position, sees, [&](int point, Vec3d r, double q) {
            ++out[size_t(point)].neighbours;
            const double basis[N] = {1, r.x, r.y, r.z};
            const double values[Sides] = {p.velocity.x, p.velocity.y, p.velocity.z, p.pressure,
                                          p.density};
            equations[size_t(point)].add(basis, values, weightAt(q));
        });
    for (size_t i = 0; i < out.size(); ++i) {
        double f[Sides];
        equations[i].solve(f, order);
        out[i] = {{f[0], f[1], f[2]}, f[3], f[4], out[i].neighbours};
    }
    return out;
}

std::vector<Smoothed> interpolate(const std::vector<Sample>& samples, const PointsNear& points,
                                  const Sees& sees) {
    std::vector<Smoothed> out(points.points());
    for (const Sample& s : samples)
        points.visit(s.position, sees, [&](int point, Vec3d, double q) {
            Smoothed& o = out[size_t(point)];
            const double weight = weightAt(q);
            o.weight += weight, o.value += weight * s.value;
        });
    for (Smoothed& o : out)
        if (o.weight > 0) o.value /= o.weight;
    return out;
}

double weightAt(double q) {
    const double square = (1 - q) * (1 - q);
    return square * square * (1 + 4 * q);
}

double filledBy(const Scene& scene, double radius) {
    const double R = radius, volume = particleMass(scene) / scene.fluid.restDensity;
    return volume * (scene.simulation.dimensions == 2 ? 7 / (std::numbers::pi * R * R)
                                                      : 21 / (2 * std::numbers::pi * R * R * R));
}

Surroundings surroundings(const Scene& scene, Surroundings::Beyond wall) {
    Surroundings s{toDouble(scene.domain.min), toDouble(scene.domain.max)};
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        s.beyond[k] = scene.domain.periodic(k) ? Surroundings::Again : wall;
    return s;
}

std::vector<Fields> interpolate(const std::vector<Particle>& particles,
                                const std::vector<Vec3d>& points, double radius, Order order) {
    return interpolate(particles, PointsNear(points, radius), order);
}

}  // namespace spindrift
