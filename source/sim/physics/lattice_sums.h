// What sums over neighbours come to on a lattice.
#pragma once

#include "scene/lattice.h"
#include "sim/physics/kernels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::LANES {

// sum of W dx^d over the points of a unit lattice layer at this height (in dx), seen from a lattice
// point: a plane, in two dimensions a line.
template <class Kernel> double latticeLayer(const Scene& s, int height) {
    const double ratio = s.simulation.support;
    const int n = int(ratio) + 1, d = s.simulation.dimensions, across = d == 3 ? n : 0;
    double sum = 0;
    for (int y = -across; y <= across; ++y)
        for (int x = -n; x <= n; ++x)
            sum +=
                double(Kernel::w(real(std::sqrt(double(x * x + y * y + height * height)) / ratio)));
    return sum * Kernel::norm(d) / std::pow(ratio, d);
}

// What sums over the neighbours of a lattice point give, which integrals would make 1: of W, of x
// dW/dx, and the Laplacian of x^2/2 in Morris's form of viscosity, which for most kernels is the
// second; that of y^2/2 in Monaghan's form as x flows, in units of dx^2. The mean of all axes,
// where steps along them differ.
struct LatticeSums {
    double kernel = 0, gradient = 0, viscous = 0, shear = 0;
    double surroundings = 0;  // of WeighViscosity
    double squares = 0;       // of (g r)^2, m^2 per spacing squared
};

template <class Kernel> LatticeSums latticeSums(const Scene& s) {
    const double ratio = s.simulation.support;
    const int d = s.simulation.dimensions;
    const Vec3d step = (1 / double(s.simulation.spacing)) * latticeStep(s);
    const bool own = hasOwnVolume(s);
    const double volume = own ? step.x * step.y * step.z : 1;
    const double nearest = own ? std::min({step.x, step.y, step.z}) : 1;
    const int n = int(ratio / nearest) + 1, across = d == 3 ? n : 0;
    const double norm = volume * Kernel::norm(d) / std::pow(ratio, d);
    LatticeSums sums;
    for (int z = -across; z <= across; ++z)
        for (int y = -n; y <= n; ++y)
            for (int x = -n; x <= n; ++x) {
                const Vec3d at{x * step.x, y * step.y, z * step.z};
                const double r2 = own ? dot(at, at) : double(x * x + y * y + z * z);
                const real q = real(std::sqrt(r2) / ratio);
                auto squared = [&](double a) { return own ? a * r2 / d : a * x * x; };
                sums.kernel += norm * double(Kernel::w(q));
                const double each = norm / (ratio * ratio) * Kernel::gradient(d);
                sums.gradient -= squared(each * double(Kernel::g(q)));
                sums.viscous -= squared(each * double(viscous<Kernel>(q)));
                sums.squares += r2 * double(Kernel::g(q)) * double(Kernel::g(q));
                sums.surroundings += q < 1 ? double(q * q * q * q * viscous<Kernel>(q)) : 0;
                const double squares = at.x * at.x * at.x * at.x + at.y * at.y * at.y * at.y +
                                       at.z * at.z * at.z * at.z;
                sums.shear -=
                    each * double(viscous<Kernel>(q)) * (r2 * r2 - squares) / (d * (d - 1));
            }
    return sums;
}

// The largest eigenvalue that Jacobi's iteration for pressures has on a lattice, found among waves
// along its axes and diagonals: |sum_j grad W sin(k.r)|^2 / sum_j |grad W|^2.
template <class Kernel> double largestEigenvalue(const Scene& s) {
    const double ratio = s.simulation.support;
    const int d = s.simulation.dimensions, n = int(ratio) + 1, across = d == 3 ? n : 0;
    std::vector<Vec3d> slopes, places;
    double squares = 0;
    for (int z = -across; z <= across; ++z)
        for (int y = -n; y <= n; ++y)
            for (int x = -n; x <= n; ++x) {
                const Vec3d at{double(x), double(y), double(z)};
                const double q = length(at) / ratio;
                if (q <= 0 || q >= 1) continue;
                places.push_back(at), slopes.push_back(double(Kernel::g(real(q))) * at);
                squares += dot(slopes.back(), slopes.back());
            }
    double largest = 0;
    for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{1, 1, 0}, Vec3d{1, 1, 1}})
        for (double k = 0.2; k < 3.2; k += 0.1) {
            Vec3d sum{};
            for (size_t j = 0; j < places.size(); ++j)
                sum = sum + std::sin(k / length(way) * dot(way, places[j])) * slopes[j];
            largest = std::max(largest, dot(sum, sum) / squares);
        }
    return largest;
}

// sum of w over the points of a lattice that fills a quarter, in three dimensions an eighth, of
// space, seen from the one in its corner.
template <class Kernel> double latticeCorner(const Scene& s) {
    const double ratio = s.simulation.support;
    const int n = int(ratio) + 1, across = s.simulation.dimensions == 3 ? n : 0;
    double sum = 0;
    for (int z = 0; z <= across; ++z)
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x)
                sum += double(Kernel::w(real(std::sqrt(double(x * x + y * y + z * z)) / ratio)));
    return sum;
}

}  // namespace spindrift::LANES
