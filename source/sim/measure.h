// What a run says of itself: sums over its particles. Included by simulation_on.h.
#pragma once

namespace spindrift::LANES {

template <class Device> Measurement SimulationOn<Device>::measure() {
    const Totals t = device_.template sum<Totals>(fluid_.slots(),
                                                  SumUp{fluid_.view(), scene_.fluid.restDensity});
    const StepState state = clock();
    const double count = fluidCount_, n = t.mass,
                 mass = particleMass(scene_);  // n particles of the scene's fluid are as heavy
    const Vec3d center = (1 / n) * Vec3d{t.position[0], t.position[1], t.position[2]};
    Measurement m;
    m.dimensions = scene_.simulation.dimensions;
    m.time = state.time, m.dt = hasBlockTimeSteps() ? state.longest : state.dt,
    m.steps = state.steps;
    m.longestStep = std::max(state.longest, m.dt);
    m.evaluations = hasBlockTimeSteps() ? state.evaluations : count * double(state.steps);
    m.kineticEnergy = mass * t.speed2 / 2;
    m.potentialEnergy =
        mass * n * dot(-1.0 * toDouble(scene_.simulation.gravity), center) + 0.0;  // no minus zero
    const Vec3d middle = 0.5 * toDouble(scene_.domain.max - scene_.domain.min);
    const double pull = scene_.simulation.centralRate * double(scene_.simulation.centralRate);
    m.potentialEnergy +=
        pull * mass / 2 * (t.position2 - 2 * n * dot(center, middle) + n * dot(middle, middle));
    m.momentum = mass * Vec3d{t.velocity[0], t.velocity[1], t.velocity[2]};
    const Vec3d turning{t.turning[0], t.turning[1], t.turning[2]};
    m.angularMomentum = mass * turning - cross(middle, m.momentum);
    m.centerOfMass = center + toDouble(scene_.domain.min);
    m.meanDensity = t.density / count;
    m.densityError = t.compression / count;
    m.maxDensityError = t.maxRatio - 1;
    m.maxSpeed = std::sqrt(t.maxSpeed2);
    m.soundSpeed = parameters_.soundSpeed;
    m.finite = t.notFinite == 0;
    if (solids_.moves()) moveSolids();  // to where the fluid is since the last step
    const std::vector<SolidState> solids = solids_.download();
    if (solids_.count() > 0) findAllLoads(view());
    for (int s = 0; s < solids_.count(); ++s) {
        const SolidLoad load =
            device_.template sum<SolidLoad>(walls_.slots(), solids_.sumOf(view(), s));
        auto scaled = [&](const double* a) { return mass * Vec3d{a[0], a[1], a[2]}; };
        auto vec = [](Vector<real> a) { return Vec3d{a.x, a.y, a.z}; };
        const SolidState& state = solids[size_t(s)];
        const std::string& name = scene_.solids[size_t(s)].name;
        m.solids.push_back({name.empty() ? "solid" + std::to_string(s) : name,
                            vec(state.middle) + toDouble(scene_.domain.min), vec(state.velocity),
                            vec(state.spin), scaled(load.pressure), scaled(load.other),
                            scaled(load.torque)});
    }
    return m;
}

}  // namespace spindrift::LANES
