#pragma once
// The classic formulation in plain double precision, straight from its formulas, one pair at a time
// and with none of the program's kernels, terms or passes: the yardstick for sim/. Only the
// particles' places come from the program.
#include "core/vec.h"
#include "scene/particles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::reference {

struct Classic {
    double dt, R, mass, rho0, nu, k, gravity, side;
    std::vector<Vec3d> x, v, walls;
    std::vector<double> rho, wallMass;
    static constexpr double pi = 3.14159265358979323846;

    Classic(const Scene& s, const Placement& p)
        : dt(s.time.step),
          R(supportRadius(s)),
          mass(s.fluid.particleMass),
          rho0(s.fluid.restDensity),
          nu(s.fluid.viscosity),
          k(s.fluid.stiffness),
          gravity(s.simulation.gravity.y),
          side(s.domain.max.x) {
        for (Vec3 a : p.positions) x.push_back(toDouble(a));
        for (Vec3 a : p.walls) walls.push_back(toDouble(a));
        v.resize(x.size());
        rho.resize(x.size());
        fill(wallCells_, walls);
        for (size_t i = 0; i < walls.size(); ++i) {
            double sum = 0;
            near(wallCells_, walls, walls[i],
                 [&](size_t j, Vec3d r) { sum += j != i ? W(length(r)) : 0; });
            wallMass.push_back(1.4 * rho0 / sum);
        }
    }

    double W(double d) const {
        const double q = 2 * d / R;
        if (q > 2) return 0;
        return 0.25 / (pi * R * R * R) *
               (q > 1 ? (2 - q) * (2 - q) * (2 - q) : q * q * (3 * q - 6) + 4);
    }
    double gradient(double d) const {  // grad W = gradient(d) x_ij
        const double q = 2 * d / R;
        if (q > 2 || q == 0) return 0;
        return (q > 1 ? q * (12 - 3 * q) - 12 : (9 * q - 12) * q) / (pi * q * R * R * R * R * R);
    }

    void step() {
        const size_t n = x.size();
        fill(cells_, x);
        std::vector<Vec3d> next = v;
        const double exchange = dt * nu * mass / rho0 / (pi * std::pow(R, 6));
#pragma omp parallel for
        for (size_t i = 0; i < n; ++i) {
            double density = 0;
            near(cells_, x, x[i], [&](size_t j, Vec3d r) {
                const double d = length(r);
                if (j != i) density += mass * W(d);
                next[i] = next[i] + (exchange * (R - d)) * (v[j] - v[i]);
            });
            near(wallCells_, walls, x[i],
                 [&](size_t b, Vec3d r) { density += wallMass[b] * W(length(r)); });
            rho[i] = density;
            next[i].y += gravity * dt;
        }
        v = next;
        std::vector<double> term(n);
        for (size_t i = 0; i < n; ++i)
            term[i] = rho[i] > 0
                          ? std::max(0.0, k * (std::pow(rho[i] / rho0, 7) - 1)) / (rho[i] * rho[i])
                          : 0;
        std::vector<Vec3d> a(n);
#pragma omp parallel for
        for (size_t i = 0; i < n; ++i) {
            near(cells_, x, x[i], [&](size_t j, Vec3d r) {
                if (j != i) a[i] = a[i] - (mass * (term[i] + term[j]) * gradient(length(r))) * r;
            });
            near(wallCells_, walls, x[i], [&](size_t b, Vec3d r) {
                a[i] = a[i] - (wallMass[b] * term[i] * gradient(length(r))) * r;
            });
            if (length(a[i]) > 1000) a[i] = (1000 / length(a[i])) * a[i];
        }
        for (size_t i = 0; i < n; ++i) {
            v[i] = v[i] + dt * a[i];
            x[i] = x[i] + dt * v[i];
            for (int c = 0; c < 3; ++c) {
                const double inside = std::clamp(x[i][c], 0.001 * side, 0.999 * side);
                if (inside != x[i][c]) v[i][c] = -v[i][c];
                x[i][c] = inside;
            }
        }
    }

    double kineticEnergy() const {
        double sum = 0;
        for (const Vec3d& u : v) sum += mass * dot(u, u) / 2;
        return sum;
    }
    Vec3d centerOfMass() const {
        Vec3d sum;
        for (const Vec3d& a : x) sum = sum + a;
        return (1.0 / double(x.size())) * sum;
    }
    double meanDensity() const {
        double sum = 0;
        for (double r : rho) sum += r;
        return sum / double(rho.size());
    }

private:
    using Cells = std::vector<std::vector<size_t>>;
    int perSide() const { return int(side / R) + 1; }
    int coordinate(double a) const { return std::clamp(int(a / R), 0, perSide() - 1); }

    void fill(Cells& cells, const std::vector<Vec3d>& points) const {
        const int n = perSide();
        cells.assign(size_t(n) * n * n, {});
        for (size_t i = 0; i < points.size(); ++i) {
            const Vec3d& p = points[i];
            cells[(size_t(coordinate(p.z)) * n + coordinate(p.y)) * n + coordinate(p.x)].push_back(
                i);
        }
    }
    template <class F>
    void near(const Cells& cells, const std::vector<Vec3d>& points, Vec3d at, F f) const {
        const int n = perSide(), cx = coordinate(at.x), cy = coordinate(at.y),
                  cz = coordinate(at.z);
        for (int z = std::max(0, cz - 1); z <= std::min(n - 1, cz + 1); ++z)
            for (int y = std::max(0, cy - 1); y <= std::min(n - 1, cy + 1); ++y)
                for (int x_ = std::max(0, cx - 1); x_ <= std::min(n - 1, cx + 1); ++x_)
                    for (size_t j : cells[(size_t(z) * n + y) * n + x_]) {
                        const Vec3d r = at - points[j];
                        if (dot(r, r) <= R * R) f(j, r);
                    }
    }
    Cells cells_, wallCells_;
};

}  // namespace spindrift::reference
