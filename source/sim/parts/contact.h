// Contact forces between fluid and elastic objects, and between objects: a discrete element method.
#pragma once

#include "sim/neighbours/neighbours.h"
#include "sim/physics/model.h"

#include <cmath>

namespace spindrift::LANES {

// Those at the surface, sorted by cell as fluid is.
struct ObjectSurface {
    int slots;
    const int* id;
    VectorField position, velocity, home;
    ScalarField radius, object, torn;
    VectorField force;  // N, of contacts
};

// The law of contact (Cundall & Strack 1979): -k f(d / D) (D - d) along the line, damping of
// relative velocity, more of it along the surface. f is tabulated, linear between values at equal
// distances from 0 to D, and kept as the first value and how much steeper it gets at each.
struct ContactLaw {
    static constexpr int pieces = 8;
    real stiffness, damping, shear;  // N/m, N s/m
    real first, bends[pieces];
    real influence;    // D of fluid and object / sum of the radii
    real fluidRadius;  // m
    real perMass;      // 1/kg, of a fluid particle
};

// N/m: unless the knob says so, fluid is as hard as its sound makes it.
inline double contactStiffness(const Model& model) {
    const Scene& scene = *model.scene;
    const double rate = 0.4 * double(model.shared.soundSpeed) / model.h();
    return scene.contact.stiffness > 0 ? double(scene.contact.stiffness)
                                       : particleMass(scene) * rate * rate;
}
inline ContactLaw contactLaw(const Model& model) {
    const Contact& knobs = model.scene->contact;
    const double m = particleMass(*model.scene), k = contactStiffness(model),
                 critical = 2 * std::sqrt(k * m);
    ContactLaw law{};
    law.stiffness = real(k), law.damping = real(knobs.damping * critical),
    law.shear = real(knobs.shear * critical);
    auto closer = [&](int n) {
        return std::exp(knobs.steepness * (1 - double(n) / ContactLaw::pieces));
    };
    law.first = real(closer(0));
    for (int n = 0; n < ContactLaw::pieces; ++n)
        law.bends[n] = real(closer(n + 1) - closer(n) - (n > 0 ? closer(n) - closer(n - 1) : 0));
    law.influence = knobs.influence, law.fluidRadius = model.scene->simulation.spacing / 2,
    law.perMass = real(1 / m);
    return law;
}

// What contact passes see. The view's support is the longest reach of a contact, by which
// neighbours are found.
struct ContactView {
    View v;
    ObjectSurface surface;
    Neighbourhood objectsNearFluid, fluidNearObjects, objectsNearObjects;
    ContactLaw law;
};

// On the first particle, N. `damped`: 1, or 0 where a bond is broken.
template <class R> HD inline Vector<R> contactForce(const ContactLaw& law, const Pair<R>& p,
                                                    R reach, Vector<R> velocity, R damped) {
    const R zero = 0, one = 1, d = squareRoot(p.distance2), overlap = reach - d,
            pieces = real(ContactLaw::pieces), at = min(pieces * d / reach, pieces);
    R closer = law.first;
    for (int k = 0; k < ContactLaw::pieces; ++k)
        closer = mulAdd(R(law.bends[k]), max(at - R(real(k)), zero), closer);
    const Vector<R> n = (one / max(d, R(real(1e-12)))) * p.r;
    const Vector<R> along = subtractScaled(velocity, dot(velocity, n), n);
    const Vector<R> force = subtractScaled(subtractScaled((R(law.stiffness) * closer * overlap) * n,
                                                          damped * R(law.damping), velocity),
                                           damped * R(law.shear), along);
    const R touches = select(overlap > zero, one, zero);
    return touches * force;
}

// Adds what objects do to the fluid to its acceleration.
struct PushFluid {
    using Index = ICluster;
    using R = Real<ICluster>;
    ContactView c;
    HD void operator()(ICluster i) const {
        const Particles& fluid = c.v.fluid;
        const Vector<R> x = load(fluid.position, i), u = load(fluid.velocity, i);
        Vector<R> sum{R(0), R(0), R(0)};
        forNeighbours<Lists::All>(
            c.v, c.objectsNearFluid, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R reach =
                    R(c.law.influence) * (R(c.law.fluidRadius) + load(c.surface.radius, j));
                sum = sum + contactForce(c.law, p, reach, u - load(c.surface.velocity, j),
                                         R(1) - load(c.surface.torn, j));
            });
        const R perMass = R(c.law.perMass) / massRatio(fluid, i);
        store(fluid.acceleration, i, addScaled(load(fluid.acceleration, i), perMass, total(sum)));
    }
};

// What fluid and other objects do to an object's surface. Of itself it meets only what was not near
// at the start.
struct PushObjects {
    using Index = ICluster;
    using R = Real<ICluster>;
    ContactView c;
    HD void operator()(ICluster i) const {
        const ObjectSurface& s = c.surface;
        const Vector<R> x = load(s.position, i), u = load(s.velocity, i), home = load(s.home, i);
        const R radius = load(s.radius, i), object = load(s.object, i),
                whole = R(1) - load(s.torn, i), none = 0;
        Vector<R> sum{none, none, none};
        forNeighbours<Lists::All>(
            c.v, c.fluidNearObjects, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                sum = sum + contactForce(c.law, p,
                                         R(c.law.influence) * (R(c.law.fluidRadius) + radius),
                                         u - load(c.v.fluid.velocity, j), whole);
            });
        forNeighbours<Lists::All>(
            c.v, c.objectsNearObjects, i, x, [&](const auto& p, JCluster j) LANE_CALL {
                const R reach = radius + load(s.radius, j), other = load(s.object, j) - object,
                        two = 2;
                const Vector<R> apart = home - load(s.home, j);
                const R near = select(dot(apart, apart) < two * two * reach * reach, R(1), none),
                        same = select(other * other < R(real(0.25)), R(1), none);
                const R meets = R(1) - near * same;
                sum = sum + meets * contactForce(c.law, p, reach, u - load(s.velocity, j),
                                                 min(whole, R(1) - load(s.torn, j)));
            });
        store(s.force, i, total(sum));
    }
};

}  // namespace spindrift::LANES
