// Scene -> what all passes share, and what terms and passes take their own parameters from.
#pragma once

#include "scene/formulation.h"
#include "scene/motion.h"
#include "scene/sources.h"
#include "sim/particles/view.h"
#include "sim/physics/lattice_sums.h"
#include "sim/run_state.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

// What a scene comes to. Terms and passes with parameters of their own have `of(const Model&)`.
struct Model {
    const Scene* scene;
    LatticeSums sums{};
    double mass = 0;               // kg, of a particle in sums; in two dimensions kg/m
    double sound = 0;              // m/s, in the heaviest fluid
    real alone = 0;                // w of the scene's kernel at no distance
    real atNeighbour = 0;          // and at a spacing
    double largestEigenvalue = 0;  // where pressures are solved for (lattice_sums.h)
    StepParameters shared{};

    double support() const { return supportRadius(*scene); }  // R, m
    double h() const { return support() / 2; }
    double restDensity() const { return scene->fluid.restDensity; }
    int dimensions() const { return scene->simulation.dimensions; }
    // m norm / R^d of MeanKernel, kg/m³.
    double meanScale() const {
        return mass * MeanKernel::norm(dimensions()) / std::pow(support(), dimensions());
    }
};

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

// Rest densities of the fluids / the scene's.
struct Ratios {
    double least = 1, most = 1;
};
inline Ratios densityRatios(const Scene& s) {
    Ratios r{1e30, 0};
    for (const Body& body : fluidsOf(s.fluid)) {
        const double ratio = double(restDensity(s, body)) / s.fluid.restDensity;
        r.least = std::min(r.least, ratio), r.most = std::max(r.most, ratio);
    }
    return r;
}

// Returns the speed of sound in the heaviest fluid, m/s.
inline double setEquationOfState(const Scene& s, const FluidExtent& fluid, StepParameters& c) {
    const double rho0 = s.fluid.restDensity;
    c.gamma = s.fluid.equationOfState == EquationOfState::Linear ? 1 : s.fluid.gamma;
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
    return sound;
}

inline void setBox(const Scene& s, StepParameters& c) {
    const Vec3 size = s.domain.max - s.domain.min;
    c.centralPull = real(s.simulation.centralRate * s.simulation.centralRate);
    c.center = toVector(0.5f * size);
    slideFace(s, size, c);
    letFacesSlip(s, c);
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
}

// Of knobs that may change while running as well as of those that don't.
template <class Kernel> Model makeModel(const Scene& s, const FluidExtent& fluid) {
    const double R = supportRadius(s), h = R / 2, rho0 = s.fluid.restDensity;
    Model m{&s};
    StepParameters& c = m.shared;
    c.kernel = s.simulation.kernel;
    c.support = real(R), c.support2 = real(R * R), c.inverseSupport2 = real(1 / (R * R));
    c.restDensity = real(rho0);
    // On its lattice a linear pressure has its exact gradient and a parabolic velocity its exact
    // Laplacian, as the lattice has the rest density; without this, at R = 2.6 dx, the one is 3 %,
    // the other 4 % too small.
    const LatticeSums& sums = m.sums =
        factsOf(s).isHistorical ? LatticeSums{1, 1, 1, 1, 1} : latticeSums<Kernel>(s);
    const double mass = m.mass = calibrateMasses<Kernel>(s, sums, c);
    const int d = s.simulation.dimensions;
    c.kernelScale = real(mass * Kernel::norm(d) / std::pow(R, d));
    c.gradientScale = real(mass * Kernel::gradient(d) * Kernel::norm(d) / std::pow(R, d + 2) *
                           sums.kernel / sums.gradient);

    m.sound = setEquationOfState(s, fluid, c);
    c.diffusion = real(2 * s.fluid.densityDiffusion * h * m.sound);
    m.alone = Kernel::w(real(0)), m.atNeighbour = Kernel::w(real(1 / s.simulation.support));
    c.dimensions = d, c.flatMoment = d == 2 ? 1 : 0;
    c.isViscous = isMultiFluid(s) || s.fluid.viscosity > 0;
    if (factsOf(s).solvesPressure) m.largestEigenvalue = largestEigenvalue<Kernel>(s);
    c.eta2 = real(0.01 * h * h);
    c.accelerationLimit =
        s.simulation.accelerationLimit > 0 ? real(s.simulation.accelerationLimit) : real(1e18);
    c.gravity = toVector(s.simulation.gravity);
    c.gravityRate = s.simulation.gravityRamp > 0 ? 1 / real(s.simulation.gravityRamp) : 0;
    setBox(s, c);
    c.rateAhead = s.time.integrator == Integrator::PredictorCorrector ? 0 : real(0.5);
    for (const Solid& solid : s.solids)
        c.solidSpeed = std::max(c.solidSpeed, real(spindrift::largestSpeed(solid)));
    const double most = s.time.maxStep > 0 ? double(s.time.maxStep) : 1e9;
    c.cfl = s.time.cfl, c.maxStep = real(most), c.restSpeed = s.time.restSpeed;
    c.fixedStep = s.time.mode == TimeMode::Fixed ? real(s.time.step) : real(0);
    return m;
}

inline Model makeModel(const Scene& s, const FluidExtent& fluid) {
    return withKernel(s.simulation.kernel,
                      [&](auto kernel) { return makeModel<decltype(kernel)>(s, fluid); });
}

}  // namespace spindrift::LANES
