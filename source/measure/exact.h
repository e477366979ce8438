#pragma once
// Flows whose solution is known. SI units, or any consistent ones.
#include "core/vec.h"
#include "scene/scene.h"

#include <complex>

namespace spindrift {

// Vortices in a periodic square of side L, largest speed U at t = 0, rho0 the density: Taylor and
// Green 1937.
struct TaylorGreenFlow {
    double L = 1, U = 1, nu = 0.01, rho0 = 1;
    Vec3d velocity(Vec3d x, double t) const;   // m/s, x in m from a corner
    double pressure(Vec3d x, double t) const;  // Pa, mean 0
    double decay(double t) const;              // of the velocity
};

// Flow between plates at y = 0 and y = L from rest: driven by a body force F (m/s²) along x, or by
// the upper plate that slides with V (m/s). Morris, Fox and Zhu 1997, eq. 21 and 22.
double poiseuilleFlow(double y, double t, double L, double nu, double F);
double couetteFlow(double y, double t, double L, double nu, double V);

// A disc of radius 1 stretched along x with rate s0 = 1/s at the start, pulled to its centre by
// -Omega^2 r, Omega = 1/s: an ellipse at all times (Monaghan and Rafiee 2013, appendix A).
struct OscillatingDrop {
    double a = 1, rate = 1;                     // m, semi-axis along x; 1/s, its relative growth
    static constexpr double period = 4.827343;  // s, of both
    void advance(double dt);                    // s
};

// Small free oscillations of viscous fluid, as exp(st), s in 1/s: the root near the inviscid one.
// Standing waves of wave number k (1/m) on fluid of some depth (m) that slides on its floor, in
// gravity g (m/s²): (s + 2 nu k^2)^2 + g k tanh kH = 4 nu^2 k^3 K tanh kH / tanh KH, K^2 = k^2 + s
// / nu (Lamb 1932, paragraph 349, for deep water).
std::complex<double> viscousWave(double k, double depth, double g, double nu);
// A disc of radius R (m) pulled to its centre by -Omega^2 r, its radius as cos(n theta): potential
// flow and vorticity I_n(r sqrt(s / nu)), without stress on the surface.
std::complex<double> viscousDrop(int n, double R, double Omega, double nu);

// A sphere that sinks from rest and takes half the mass of the fluid in its place along; its drag
// grows as that of Schiller and Naumann 1933, to its weight at the speed `terminal`. Without what
// is left of earlier motion (Basset's force), which delays it a little.
struct SettlingSphere {
    double diameter, density, fluidDensity, viscosity, gravity,
        terminal;                 // m, kg/m³, Pa s, m/s², m/s
    double depth = 0, speed = 0;  // m, m/s
    void advance(double dt);      // s
};

// A body in the middle of a closed box that is full of fluid at rest, once it accelerates along x.
// The box's walls are mirrors, in which far images are dipoles (Lamb 1932, paragraph 71). `own` is
// its added mass over the fluid's density in fluid without an end, `volume` its volume: m^2 in two
// dimensions, else m^3. Added masses without a box, by Newman 1977, table 4.3: of a circular
// cylinder pi a^2, of a square with sides 2a 4.754 a^2, of a sphere 2/3 pi a^3.
struct BodyInBox {
    double addedMass, faster;  // as `own`; how many times as fast fluid slides past it
};
BodyInBox bodyInBox(double own, double volume, Vec3d box, int dimensions);
// s^(3/2) m/s² of a body whose acceleration grows to A (m/s²) in `onset` seconds and stays there:
// the integral of a(s) / sqrt(t - s) that drag by the layers of Stokes 1851 goes with (Basset
// 1888).
double bassetIntegral(double A, double onset, double t);

// What sums over a kernel's neighbours make of a wave sin(kx) along x on a lattice: k and k^2 as
// they see them, times dx and dx^2. R / dx is the support.
struct LatticeWave {
    double k, k2;
};
LatticeWave latticeWave(Kernel kernel, int dimensions, double support, double kdx);

}  // namespace spindrift
