// Scene -> the constants of a step, and the grid of cells.
#if defined(SPINDRIFT_SIM_CONSTANTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_CONSTANTS_H
#undef SPINDRIFT_SIM_CONSTANTS_H
#else
#define SPINDRIFT_SIM_CONSTANTS_H
#endif

#include "sim/kernels.h"
#include "sim/run_state.h"
#include "sim/view.h"

#include <algorithm>

namespace spindrift::LANES {

inline Vector<real> toVector(Vec3 a) { return {real(a.x), real(a.y), real(a.z)}; }

// sum of W dx^3 over the points of a unit lattice plane at height z (in dx), seen from a lattice point.
template <class Kernel> double latticePlane(const Scene& s, int z) {
    const double ratio = s.simulation.support;
    const int n = int(ratio) + 1;
    double sum = 0;
    for (int y = -n; y <= n; ++y)
        for (int x = -n; x <= n; ++x)
            sum += double(Kernel::w(real(std::sqrt(double(x * x + y * y + z * z)) / ratio)));
    return sum * Kernel::norm / (ratio * ratio * ratio);
}

// Fluid on its lattice must have exactly the rest density, in the bulk and in the layer next to a wall: the mass in
// sums (returned, kg) is scaled for the one, the boundary particles' mass for the other.
template <class Kernel> double calibrateMasses(const Scene& s, Constants& c) {
    const double scale = particleMass(s) / (double(s.fluid.restDensity) * std::pow(double(s.simulation.spacing), 3));
    if (s.simulation.formulation == Formulation::Classic) {
        c.selfWeight = 0;
        c.wallFactor = real(1.4);
        c.wallMassFloor = 0;
        return particleMass(s) / 8;   // its kernel is an eighth of the normalised cubic spline
    }
    double bulk = latticePlane<Kernel>(s, 0);
    for (int z = 1; z <= int(s.simulation.support); ++z) bulk += 2 * latticePlane<Kernel>(s, z);
    double wall = latticePlane<Kernel>(s, 0);
    if (s.simulation.support > 2) wall += latticePlane<Kernel>(s, 1);
    c.selfWeight = 1;
    c.wallMassFloor = 1;
    c.wallFactor = real(wall / bulk);
    return particleMass(s) / (scale * bulk);
}

// The speed that fluid can reach by falling through the domain, whichever way gravity points now, m/s.
inline double expectedSpeed(const Scene& s, const FluidExtent& fluid) {
    const Vec3d g = toDouble(s.simulation.gravity), size = toDouble(s.domain.max - s.domain.min);
    double fall = 0;   // m^2/s^2
    for (int k = 0; k < 3; ++k) fall += g[k] > 0 ? g[k] * (size[k] - fluid.low[k]) : -g[k] * fluid.high[k];
    return std::sqrt(fluid.speed * fluid.speed + 2 * fall);
}

// Knobs that may change while running as well as those that don't.
template <class Kernel> Constants makeConstants(const Scene& s, const FluidExtent& fluid) {
    const double R = supportRadius(s), h = R / 2, rho0 = s.fluid.restDensity;
    const bool linear = s.fluid.equationOfState == EquationOfState::Linear;
    Constants c{};
    c.support = real(R), c.support2 = real(R * R), c.inverseSupport2 = real(1 / (R * R));
    c.restDensity = real(rho0);
    const double mass = calibrateMasses<Kernel>(s, c);
    c.kernelScale = real(mass * Kernel::norm / std::pow(R, 3));
    c.gradientScale = real(mass * Kernel::gradientNorm / std::pow(R, 5));

    c.gamma = linear ? 1 : s.fluid.gamma;
    double sound = s.fluid.soundSpeed > 0 ? s.fluid.soundSpeed : s.fluid.speedRatio * std::max(expectedSpeed(s, fluid), 1e-3);
    if (s.fluid.stiffness > 0) sound = std::sqrt(s.fluid.stiffness * c.gamma / rho0);
    c.stiffness = real(rho0 * sound * sound / c.gamma);
    c.soundSpeed = real(sound);

    c.laminar = real(2 * s.fluid.viscosity);
    c.artificial = real(s.fluid.artificialViscosity * sound * h / 2);
    c.classicViscosity = real(s.fluid.viscosity * particleMass(s) / (rho0 * 3.14159265358979323846 * std::pow(R, 5)) / c.gradientScale);
    c.eta2 = real(0.01 * h * h);
    c.accelerationLimit = s.simulation.accelerationLimit > 0 ? real(s.simulation.accelerationLimit) : real(1e18);
    c.gravity = toVector(s.simulation.gravity);

    const Vec3 size = s.domain.max - s.domain.min;
    c.low = toVector(s.walls.margin * size);
    c.high = toVector((1 - s.walls.margin) * size);
    c.restitution = s.walls.restitution, c.friction = s.walls.friction;
    c.cfl = s.time.cfl, c.maxStep = s.time.maxStep;
    c.fixedStep = s.time.mode == TimeMode::Fixed ? real(s.time.step) : real(0);
    c.viscousStep = s.fluid.viscosity > 0 ? real(0.125 * h * h * rho0 / s.fluid.viscosity) : c.maxStep;
    return c;
}

// Rows two spacings wide, cells half a spacing long; larger when the box is so empty that cells would outnumber
// particles by far. One support radius more on each side than the domain, for boundary particles.
inline Grid makeGrid(const Scene& s, size_t particles) {
    const float dx = s.simulation.spacing, rim = supportRadius(s);
    const Vec3 size = s.domain.max - s.domain.min + Vec3{2 * rim, 2 * rim, 2 * rim};
    double length = 0.5 * dx, row = 2 * dx;
    auto cellsAlong = [](double extent, double cell) { return std::max(1.0, std::ceil(extent / cell)); };
    auto total = [&] { return cellsAlong(size.x, length) * cellsAlong(size.y, row) * cellsAlong(size.z, row); };
    const double most = std::clamp<double>(16.0 * double(particles), 4e6, 2e9);   // cells are counted in 32 bits
    while (total() > most) {
        length *= 2;
        if (length > row) row = length;
    }
    Grid g;
    g.low = toVector({-rim, -rim, -rim});
    g.perMetreX = real(1 / length);
    g.perMetreRow = real(1 / row);
    g.cells = {int(cellsAlong(size.x, length)), int(cellsAlong(size.y, row)), int(cellsAlong(size.z, row))};
    return g;
}

}  // namespace spindrift::LANES

#endif
