#include "scene/start_fields.h"

#include "scene/convex.h"
#include "scene/particles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

// Taylor and Green 1937, one wave length along each side of the domain.
Start taylorGreen(const Scene& scene, double amplitude, Vec3d p) {
    const Vec3d size = scene.domain.size();
    const double turn = 2 * std::numbers::pi, x = turn * p.x / size.x, y = turn * p.y / size.y;
    return {amplitude * Vec3d{-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y), 0},
            -0.25 * scene.fluid.restDensity * amplitude * amplitude *
                (std::cos(2 * x) + std::cos(2 * y))};
}

// Travelling along x, one wave length in the domain: u = U sin kx, p = rho0 c u.
Start soundWave(const Scene& scene, double amplitude, Vec3d p) {
    const double u = amplitude * std::sin(2 * std::numbers::pi * p.x / scene.domain.size().x);
    return {{u, 0, 0}, scene.fluid.restDensity * soundSpeed(scene, {}) * u};
}

// Deep or shallow water over a floor that it slides on, one wave length in the domain, when the
// surface is level: largest speed U up and down at the surface.
Start standingWave(const Scene& scene, const Body& body, double amplitude, Vec3d p, Vec3d r) {
    const double k = 2 * std::numbers::pi / scene.domain.size().x, half = halfExtent(body).y,
                 u = amplitude / std::sinh(2 * k * half), up = k * (r.y + half);
    return {u * Vec3d{std::sin(k * p.x) * std::cosh(up), -std::cos(k * p.x) * std::sinh(up), 0}};
}

// Linear in the distance from the body's centre. A stretching drop in a central force field has its
// exact pressure (Monaghan and Rafiee 2013), which is 0 on its surface.
Start linearField(const Scene& scene, const Body& body, double amplitude, Vec3d r) {
    const Vec3d half = halfExtent(body);
    const double reach = std::max(half.x, half.y), rate = amplitude / reach,
                 omega = scene.simulation.centralRate;
    if (body.field == Field::Rotation) return {rate * Vec3d{-r.y, r.x, 0}};
    if (body.field == Field::Shear) return {rate * Vec3d{r.y, 0, 0}};
    const double depth = reach * reach - r.x * r.x - r.y * r.y;  // m^2
    return {rate * Vec3d{r.x, -r.y, 0},
            0.5 * scene.fluid.restDensity * (rate * rate + omega * omega) * std::max(depth, 0.0)};
}

// Of the fluid above p in the same body, for a free surface at that body's upper end against
// gravity.
double hydrostatic(const Scene& scene, const Body& body, Vec3d r) {
    const Vec3d g = toDouble(scene.simulation.gravity), half = halfExtent(body);
    double head = 0;  // m^2/s^2
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        head += g[k] * r[k] + std::abs(g[k]) * half[k];
    return double(restDensity(scene, body)) * head;
}

Vec3d centerOf(const Scene& scene, const Body& body) {
    return convexOf(body, 3).middle - toDouble(scene.domain.min);
}

}  // namespace

Start startOf(const Scene& scene, const Body& body, Vec3d p) {
    const Vec3d r = p - centerOf(scene, body);
    const double amplitude = length(toDouble(body.velocity));
    Start start{toDouble(body.velocity)};
    if (body.field == Field::TaylorGreen)
        start = taylorGreen(scene, amplitude, p);
    else if (body.field == Field::SoundWave)
        start = soundWave(scene, amplitude, p);
    else if (body.field == Field::StandingWave)
        start = standingWave(scene, body, amplitude, p, r);
    else if (body.field != Field::Uniform)
        start = linearField(scene, body, amplitude, r);
    if (body.pressure == StartPressure::Hydrostatic) start.pressure += hydrostatic(scene, body, r);
    return start;
}

}  // namespace spindrift
