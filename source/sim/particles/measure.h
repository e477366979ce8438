// What a run says of itself: sums over its particles.
#pragma once

#include "sim/step/flow.h"
#include "sim/particles/output_passes.h"
#include "sim/parts/source_passes.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

// All but the solids, the counts of steps, and what has come and left.
template <class Device> Measurement measureFluid(Flow<Device>& flow, int particles) {
    const Scene& scene = flow.scene;
    const Totals t = flow.device.template sum<Totals>(
        flow.fluid.slots(), SumUp{flow.fluid.view(), scene.fluid.restDensity});
    const double count = std::max(particles, 1), n = std::max(t.mass, 1e-9),  // none may be left

        mass = particleMass(scene);  // n particles of the scene's fluid are as heavy
    const Vec3d center = (1 / n) * Vec3d{t.position[0], t.position[1], t.position[2]};
    Measurement m;
    m.dimensions = scene.simulation.dimensions;
    m.kineticEnergy = mass * t.speed2 / 2;
    m.potentialEnergy =
        mass * n * dot(-1.0 * toDouble(scene.simulation.gravity), center) + 0.0;  // no minus zero
    const Vec3d middle = 0.5 * toDouble(scene.domain.max - scene.domain.min);
    const double pull = scene.simulation.centralRate * double(scene.simulation.centralRate);
    m.potentialEnergy +=
        pull * mass / 2 * (t.position2 - 2 * n * dot(center, middle) + n * dot(middle, middle));
    m.momentum = mass * Vec3d{t.velocity[0], t.velocity[1], t.velocity[2]};
    const Vec3d turning{t.turning[0], t.turning[1], t.turning[2]};
    m.angularMomentum = mass * turning - cross(middle, m.momentum);
    m.centerOfMass = center + toDouble(scene.domain.min);
    m.meanDensity = t.density / count;
    m.densityError = t.compression / count;
    m.maxDensityError = t.maxRatio - 1;
    m.maxSpeed = std::sqrt(t.maxSpeed2);
    m.soundSpeed = flow.model.shared.soundSpeed;
    m.finite = t.notFinite == 0;
    return m;
}

// With block time steps a step is that of calm fluid, and most particles are evaluated more often.
inline void countSteps(Measurement& m, const StepState& clock, bool blockTimeSteps, int particles) {
    m.time = clock.time, m.steps = clock.steps;
    m.dt = blockTimeSteps ? clock.longest : clock.dt;
    m.longestStep = std::max(clock.longest, m.dt);
    m.evaluations = blockTimeSteps ? clock.evaluations : particles * double(clock.steps);
}

inline void countComers(Measurement& m, const Scene& scene, const Tally& t) {
    const double mass = particleMass(scene);
    m.comesAndGoes = comesAndGoes(scene);
    m.massIn = mass * double(t.came), m.massOut = mass * double(t.left);
    m.massMissed = mass * double(t.missed);
}

}  // namespace spindrift::LANES
