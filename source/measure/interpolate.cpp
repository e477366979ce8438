#include "measure/interpolate.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// The first unknown of the normal equations for four right-hand sides at once: the field's value. Where all neighbours lie in a
// plane, a line or a point, the slopes across it are taken as 0.
constexpr int N = 4, Sides = 4;
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
        // About the neighbours' mean place the slopes' equations stand alone; then from the last slope to the first.
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

}  // namespace

std::vector<Fields> interpolate(const std::vector<Particle>& particles, const std::vector<Vec3d>& points, double radius,
                                Order order) {
    std::vector<Fields> out;
    for (const Vec3d& x : points) {
        Equations equations;
        int neighbours = 0;
        for (const Particle& p : particles) {
            const Vec3d r = (1 / radius) * (p.position - x);
            const double q = length(r);
            if (q >= 1) continue;
            ++neighbours;
            const double basis[N] = {1, r.x, r.y, r.z};
            const double values[Sides] = {p.velocity.x, p.velocity.y, p.velocity.z, p.pressure};
            equations.add(basis, values, std::pow(1 - q, 4) * (1 + 4 * q));
        }
        double f[Sides];
        equations.solve(f, order);
        out.push_back({{f[0], f[1], f[2]}, f[3], neighbours});
    }
    return out;
}

}  // namespace spindrift
