// Scene -> the constants of a step, and the grid of cells.
#pragma once

#include "scene/formulation.h"
#include "scene/lattice.h"
#include "scene/motion.h"
#include "sim/physics/kernels.h"
#include "sim/run_state.h"
#include "sim/particles/view.h"

#include <algorithm>

namespace spindrift::LANES {

inline Vector<real> toVector(Vec3 a) { return {real(a.x), real(a.y), real(a.z)}; }

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

// Fluid on its lattice must have exactly the rest density, in the bulk and in the layer next to a
// wall: the mass in sums (returned, kg, in two dimensions kg/m) is scaled for the one, the boundary
// particles' mass for the other.
template <class Kernel>
double calibrateMasses(const Scene& s, const LatticeSums& sums, StepParameters& c) {
    if (factsOf(s).isHistorical) {
        c.selfWeight = 0;
        c.wallFactor = real(1.4);
        c.wallMassFloor = 0;
        return particleMass(s) / 8;  // its kernel is an eighth of the normalised cubic spline
    }
    const double bulk = sums.kernel;
    double wall = latticeLayer<Kernel>(s, 0);
    if (s.simulation.support > 2) wall += latticeLayer<Kernel>(s, 1);
    c.selfWeight = 1;
    c.wallMassFloor = 1;
    c.wallFactor = real(wall / bulk);
    // Where a lattice is stretched a wall's particle has the volume of its own cell.
    const double dx = s.simulation.spacing;
    const Vec3d outside = wallStep(s), away = outside - Vec3d{dx, dx, dx};
    const double most = std::max({std::abs(away.x), std::abs(away.y), std::abs(away.z)});
    const double cell = outside.x * outside.y * (s.simulation.dimensions == 2 ? 1 : outside.z);
    if (hasOwnVolume(s) || most > 1e-4 * dx)
        c.wallFactor = 0, c.wallMassFloor = real(cell / particleVolume(s));
    return double(s.fluid.restDensity) * particleVolume(s) / bulk;
}

inline void slideFace(const Scene& s, Vec3 size, StepParameters& c) {
    Vec3 below{-1e9f, -1e9f, -1e9f}, above{1e9f, 1e9f, 1e9f};
    if (s.walls.movingFace != Face::None) {
        const int face = int(s.walls.movingFace) - 1, axis = face / 2;
        if (face % 2)
            above[axis] = size[axis];
        else
            below[axis] = 0;
    }
    c.slidesBelow = toVector(below), c.slidesAbove = toVector(above);
    c.slideVelocity = toVector(s.walls.velocity);
}

// A slip length of -1 stands for fluid that slides freely: one beside which all others are small.
inline real slipLength(float length) { return length < 0 ? real(1e9) : real(length); }
inline void letFacesSlip(const Scene& s, StepParameters& c) {
    auto lengths = [&](Vec3 own) -> Vector<real> {
        const real all = slipLength(s.walls.slip);
        return {std::max(all, slipLength(own.x)), std::max(all, slipLength(own.y)),
                std::max(all, slipLength(own.z))};
    };
    c.slipBelow = lengths(s.walls.slipMin), c.slipAbove = lengths(s.walls.slipMax);
}

// Forces that few scenes have. Their sums are of a particle's mass in sums, multiplied with
// gradientScale in the end; means are of the smoothest kernel, whichever the scene's is.
inline void addRareForces(const Scene& s, double mass, StepParameters& c) {
    const int d = s.simulation.dimensions;
    const double R = supportRadius(s), rho0 = s.fluid.restDensity, dx = s.simulation.spacing,
                 pi = 3.14159265358979323846;
    c.surfaceTension = real(2 * s.fluid.surfaceTension / rho0);
    c.normalScale =
        real(mass / rho0 * MeanKernel::gradient(d) * MeanKernel::norm(d) / std::pow(R, d + 2));
    c.leastCompany = real(0.8 * latticeCorner<MeanKernel>(s));
    c.leastNormal = real(0.15 / R);  // a tenth of that of a flat surface
    const double mean = mass * MeanKernel::norm(d) / std::pow(R, d);
    c.velocityTransfer = real(s.fluid.velocityTransfer * mean / 2 / c.gradientScale);
    c.buoyancy = real(s.fluid.buoyancy * mean / (rho0 * rho0) / c.gradientScale);
    c.dissipation = real(s.fluid.dissipation);
    const Vec3d step = latticeStep(s);
    const double volume = hasOwnVolume(s) ? step.x * step.y * step.z : dx * dx * dx,
                 across = pi * std::pow(3 * volume / (4 * pi), 2.0 / 3);
    c.airDrag = real(s.fluid.airDensity * s.fluid.dragCoefficient * across / (2 * rho0 * volume));
    c.wind = toVector(s.fluid.wind);
}

// Rest densities of the fluids / the scene's.
struct Ratios {
    double least = 1, most = 1;
};
inline Ratios densityRatios(const Scene& s) {
    Ratios r{1e30, 0};
    for (const Body& body : s.fluid.bodies) {
        const double ratio = double(restDensity(s, body)) / s.fluid.restDensity;
        r.least = std::min(r.least, ratio), r.most = std::max(r.most, ratio);
    }
    return r;
}

// What forces but pressure allow, s: viscosity (Morris 1997; what acts along the line of two
// particles damps waves along their way faster, on the lattice up to twice, in three dimensions
// 1.7 times as fast), surface tension (Brackbill 1992), exchanged velocity.
inline double longestStep(const Scene& s) {
    const Fluid& f = s.fluid;
    const double d = s.simulation.dimensions,
                 along = viscosityForm(s) == ViscosityForm::Monaghan ? d / (d + 2) : 1;
    const double h = supportRadius(s) / 2, rho0 = f.restDensity, pi = 3.14159265358979323846;
    double step = 1e9;
    for (const Body& body : f.bodies)
        if (viscosity(s, body) > 0)
            step = std::min(step, along * 0.125 * h * h * restDensity(s, body) /
                                      (viscosity(s, body) * (isMultiFluid(s) ? 2 : 1)));
    if (f.surfaceTension > 0)
        step = std::min(step, 0.25 * std::sqrt(rho0 * h * h * h / (2 * pi * f.surfaceTension)));
    if (f.velocityTransfer > 0) step = std::min(step, 0.5 / f.velocityTransfer);
    return step;
}

// Knobs that may change while running as well as those that don't.
template <class Kernel>
StepParameters makeStepParameters(const Scene& s, const FluidExtent& fluid) {
    const double R = supportRadius(s), h = R / 2, rho0 = s.fluid.restDensity;
    const bool linear = s.fluid.equationOfState == EquationOfState::Linear;
    StepParameters c{};
    c.kernel = s.simulation.kernel;
    c.support = real(R), c.support2 = real(R * R), c.inverseSupport2 = real(1 / (R * R));
    c.restDensity = real(rho0);
    // On its lattice a linear pressure has its exact gradient and a parabolic velocity its exact
    // Laplacian, as the lattice has the rest density; without this, at R = 2.6 dx, the one is 3 %,
    // the other 4 % too small.
    const LatticeSums sums =
        factsOf(s).isHistorical ? LatticeSums{1, 1, 1, 1, 1} : latticeSums<Kernel>(s);
    const double mass = calibrateMasses<Kernel>(s, sums, c);
    const int d = s.simulation.dimensions;
    c.kernelScale = real(mass * Kernel::norm(d) / std::pow(R, d));
    c.aloneDensity = real(c.kernelScale * Kernel::w(real(0)) / rho0);
    c.gradientScale = real(mass * Kernel::gradient(d) * Kernel::norm(d) / std::pow(R, d + 2) *
                           sums.kernel / sums.gradient);

    c.gamma = linear ? 1 : s.fluid.gamma;
    // All fluids have one stiffness, so that pressure is the same on both sides of where they meet;
    // the heaviest has the scene's speed of sound.
    const Ratios ratios = densityRatios(s);
    const double sound =
        soundSpeed(s, fluid) * (s.fluid.stiffness > 0 ? 1 : std::sqrt(ratios.most));
    c.stiffness = real(rho0 * sound * sound / c.gamma);
    c.fastestSound = real(sound / std::sqrt(ratios.least));
    c.backgroundPressure = real(s.fluid.backgroundPressure);
    c.soundSpeed = real(sound);
    // Nothing waits for sound. But steps have an end where nothing moves; and what floats meets
    // what it hits with springs that are as stiff as the longest step can bear.
    if (factsOf(s).solvesPressure) {
        const bool floats = std::any_of(s.solids.begin(), s.solids.end(),
                                        [](const Solid& solid) { return solid.floats(); });
        c.fastestSound = 0, c.leastSpeed = real((floats ? 0.1 : 0.02) * sound);
    }

    c.leastPressure = carriesDensity(s) ? real(-1e30) : real(0);
    c.diffusion = real(2 * s.fluid.densityDiffusion * h * sound);
    c.shifting = real(s.fluid.shifting * 2 * h);
    c.shiftWeight = 1 / Kernel::w(real(1 / s.simulation.support));
    c.dimensions = d, c.flatMoment = d == 2 ? 1 : 0;
    const double dx = s.simulation.spacing;
    c.laminar =
        real(2 * (isMultiFluid(s) ? 1 : double(s.fluid.viscosity)) * sums.gradient /
             (viscosityForm(s) == ViscosityForm::Morris ? sums.viscous : sums.shear * dx * dx));
    c.perSurroundings = real(1 / sums.surroundings);
    c.artificial = real(s.fluid.artificialViscosity * sound * h / 2);
    c.classicViscosity = real(s.fluid.viscosity * particleMass(s) /
                              (rho0 * 3.14159265358979323846 * std::pow(R, 5)) / c.gradientScale);
    addRareForces(s, mass, c);
    c.densityShare = s.solver.densityShare, c.relaxation = 0;
    if (factsOf(s).solvesPressure)
        c.relaxation = real(s.solver.relaxation / largestEigenvalue<Kernel>(s));
    c.latticeSquares = real(sums.squares * dx * dx) * c.gradientScale * c.gradientScale;
    c.eta2 = real(0.01 * h * h);
    c.accelerationLimit =
        s.simulation.accelerationLimit > 0 ? real(s.simulation.accelerationLimit) : real(1e18);
    c.gravity = toVector(s.simulation.gravity);
    c.gravityRate = s.simulation.gravityRamp > 0 ? 1 / real(s.simulation.gravityRamp) : 0;

    const Vec3 size = s.domain.max - s.domain.min;
    c.centralPull = real(s.simulation.centralRate * s.simulation.centralRate);
    c.center = toVector(0.5f * size);
    slideFace(s, size, c);
    letFacesSlip(s, c);
    c.rateAhead = s.time.integrator == Integrator::PredictorCorrector ? 0 : real(0.5);
    for (const Solid& solid : s.solids)
        c.solidSpeed = std::max(c.solidSpeed, real(spindrift::largestSpeed(solid)));
    c.gap = real(std::max(1e-4 * double(s.simulation.spacing),
                          5e-7 * double(std::max({size.x, size.y, size.z}))));
    c.low = toVector(s.walls.margin * size);
    c.high = toVector((1 - s.walls.margin) * size);
    c.periodic = s.domain.periodicX || s.domain.periodicY || s.domain.periodicZ;
    const Vec3 period{s.domain.periodicX ? size.x : 0, s.domain.periodicY ? size.y : 0,
                      s.domain.periodicZ ? size.z : 0};
    c.period = toVector(period);
    auto inverse = [](float length) { return length > 0 ? real(1 / double(length)) : real(0); };
    c.inversePeriod = {inverse(period.x), inverse(period.y), inverse(period.z)};
    c.restitution = s.walls.restitution, c.friction = s.walls.friction;
    const double most = s.time.maxStep > 0 ? double(s.time.maxStep) : 1e9;
    double longest = std::min(most, longestStep(s));
    if (factsOf(s).solvesPressure && s.fluid.artificialViscosity > 0)
        longest = std::min(longest, h / (s.fluid.artificialViscosity * sound));
    c.cfl = s.time.cfl, c.maxStep = real(longest), c.restSpeed = s.time.restSpeed;
    c.fixedStep = s.time.mode == TimeMode::Fixed ? real(s.time.step) : real(0);
    return c;
}

inline StepParameters makeStepParameters(const Scene& s, const FluidExtent& fluid) {
    return withKernel(s.simulation.kernel,
                      [&](auto kernel) { return makeStepParameters<decltype(kernel)>(s, fluid); });
}

// Rows two spacings wide, cells half a spacing long; larger when the box is so empty that cells
// would outnumber particles by far. One support radius more on each side than the domain, for
// boundary particles; along a periodic axis just the domain, in whole cells.
inline Grid makeGrid(const Scene& s, size_t particles) {
    const float dx = s.simulation.spacing;
    Vec3 rim, size = s.domain.max - s.domain.min;
    for (int k = 0; k < 3; ++k) {
        rim[k] = s.domain.periodic(k) ? 0 : supportRadius(s);
        size[k] += 2 * rim[k];
    }
    double length = 0.5 * dx, row = 2 * dx;
    auto cellsAlong = [](double extent, double cell) {
        return std::max(1.0, std::ceil(extent / cell));
    };
    auto total = [&] {
        return cellsAlong(size.x, length) * cellsAlong(size.y, row) * cellsAlong(size.z, row);
    };
    const double most =
        std::clamp<double>(16.0 * double(particles), 4e6, 2e9);  // cells are counted in 32 bits
    while (total() > most) {
        length *= 2;
        if (length > row) row = length;
    }
    Grid g;
    g.low = toVector(Vec3{} - rim);
    g.cells = {int(cellsAlong(size.x, length)), int(cellsAlong(size.y, row)),
               int(cellsAlong(size.z, row))};
    g.perMetre = {real(1 / length), real(1 / row), real(1 / row)};
    if (s.simulation.dimensions == 2) g.cells.z = 1, g.perMetre.z = real(1 / size.z);
    g.wraps = {s.domain.periodicX, s.domain.periodicY, s.domain.periodicZ};
    if (g.wraps.x) g.perMetre.x = real(g.cells.x / size.x);
    if (g.wraps.y) g.perMetre.y = real(g.cells.y / size.y);
    if (g.wraps.z) g.perMetre.z = real(g.cells.z / size.z);
    return g;
}

}  // namespace spindrift::LANES
