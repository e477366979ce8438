// Forces of contact against their law, summed up pair by pair in double precision: particles of
// fluid at chosen places around a block.
#include "scene/json.h"
#include "scene/particles.h"
#include "scene/sample_object.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

constexpr double Stiffness = 50, Damping = 0.3, Shear = 0.2, Steepness = 2, Influence = 1.5;

Scene scene(Precision precision) {
    Scene s;
    s.compute.backend = Backend::Cpu, s.compute.precision = precision;
    s.simulation.spacing = 0.05f, s.simulation.gravity = {0, 0, 0};
    s.domain.max = {2, 2, 2};
    s.walls.kind = WallKind::Reflect;
    s.fluid.soundSpeed = 10, s.fluid.viscosity = 0, s.fluid.artificialViscosity = 0;
    setKnob(
        s,
        "fluid.bodies=[{\"shape\":\"block\",\"min\":[0,0,0],\"max\":[0.1,0.1,0.2]}]");  // sixteen,
                                                                                        // for other
                                                                                        // places
    setKnob(s,
            R"(objects=[{"shape":"block","min":[0.9,0.9,0.9],"max":[1.1,1.1,1.1],"spacing":0.04,)"
            R"("velocity":[0.5,0,-1]}])");
    s.contact = {Influence, Stiffness, Steepness, Damping, Shear};
    return s;
}

// Few enough that there is no pressure, at all depths of contact.
RunState placed(const Scene& s) {
    RunState state(placeParticles(s));
    for (size_t i = 0; i < state.particles.positions.size(); ++i) {
        const int side = int(i % 2), row = int(i / 2 % 2), column = int(i / 4 % 2),
                  face = int(i / 8 % 2);
        const float deep = 0.006f * float(i),
                    out = side ? 1.1f + 0.072f - 0.5f * deep : 0.9f - 0.072f + 0.5f * deep;
        const float u = row ? 1.085f : 0.913f, v = column ? 1.071f : 0.921f;
        state.particles.positions[i] =
            face ? Vec3{out, u, v}
                 : Vec3{u + (row ? 0.09f : -0.09f), out, v + (column ? 0.07f : -0.07f)};
        state.particles.velocities[i] = {0.1f * float(i), -0.3f, 0.05f * float(i * i)};
    }
    return state;
}

double distanceFunction(double share) {  // as it is tabulated
    const double at = share * 8, low = std::min(std::floor(at), 7.0);
    auto value = [](double n) { return std::exp(Steepness * (1 - n / 8)); };
    return value(low) + (at - low) * (value(low + 1) - value(low));
}

Vec3d expected(const Scene& s, const ObjectSample& o, const Particle& p, double damped,
               int& touched) {
    const double m = particleMass(s), critical = 2 * std::sqrt(Stiffness * m);
    Vec3d force;
    for (size_t j = 0; j < o.size(); ++j) {
        if (!o.atSurface[j]) continue;
        const Vec3d r = p.position - toDouble(o.positions[j]),
                    u = p.velocity - toDouble(s.objects[0].velocity);
        const double d = length(r), D = Influence * (0.025 + double(o.radii[j]));
        if (d >= D) continue;
        ++touched;
        const Vec3d n = (1 / d) * r, along = u - dot(u, n) * n;
        force = force + (Stiffness * distanceFunction(d / D) * (D - d)) * n -
                (damped * Damping * critical) * u - (damped * Shear * critical) * along;
    }
    return (1 / m) * force;
}

TEST(Contact, ForcesAreThoseOfTheLaw) {
    for (const auto& [precision, tolerance] :
         {std::pair{Precision::Float, 2e-5},
          std::pair{Precision::Double, 1e-6}})  // places are floats
        for (const bool torn : {false, true}) {
            const Scene s = scene(precision);
            const ObjectSample o = sampleObjects(s);
            auto simulation = makeSimulation(s, placed(s));
            if (torn) {
                RunState state = simulation->state();
                state.objects.broken.assign(state.objects.broken.size(), 1);
                simulation->restart(state);
            }
            int touched = 0;
            for (const Particle& p : simulation->particles()) {
                const Vec3d wanted = expected(s, o, p, torn ? 0 : 1, touched);
                EXPECT_LT(length(p.acceleration - wanted), tolerance * (length(wanted) + 1))
                    << p.id << (torn ? " torn" : "");
            }
            EXPECT_GT(touched, 30);
        }
}

}  // namespace
}  // namespace spindrift
