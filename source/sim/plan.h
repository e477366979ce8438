// What a step consists of. Included by simulation_on.h.
#pragma once

namespace spindrift::LANES {

// The passes that this scene needs, in order. What it doesn't need isn't in the list.
template <class Device> template <class K> void SimulationOn<Device>::makePlan() {
    using S = SimulationOn;
    plan_.clear();
    rows_.clear();
    switch (scene_.time.integrator) {
        // v += a dt, x += v dt.
        case Integrator::SymplecticEuler:
            if (hasBlockTimeSteps()) {
                stepLocally<K>();
                break;
            }
            evaluateForces<K>(Initial::Yes);
            chooseStep();
            moveThings(&S::template moveFloating<2, true>);
            advance<K, Kick, Drift>({"integrate", "kick", "drift"});
            break;
        // Verlet 1967 with velocities: forces at the end of the step with the velocity foreseen
        // there, of which then half is taken back for half of the new acceleration.
        case Integrator::VelocityVerlet:
            chooseStep();
            moveThings(&S::template moveFloating<1, true>);
            advance<K, HalfKick, Drift | KeepVelocity | KickOn>({"integrate", "kick", "drift"});
            evaluateForces<K>(Initial::Yes);
            addPass("floating solids", &S::template moveFloating<1, false>, Initial::No,
                    whyNothingFloats());
            addPass("second kick", &S::template onFluid<Integrate<Resume | HalfKick>>);
            break;
        // Half a step ahead; from there the forces and then, with the mean velocity, the rates of
        // the whole step (Monaghan 1989; the mean of old and new velocity keeps oscillations from
        // growing, as in a leapfrog).
        case Integrator::PredictorCorrector:
            evaluateForces<K>(Initial::Yes);
            chooseStep();
            advance<K, 0, Keep | HalfDrift | KickOn>({"predict", "", "predict"});
            evaluateForces<K>(Initial::No);
            addPass("extremes", &S::countCorrection, Initial::No, keepsLists ? "" : noLists);
            moveThings(&S::template moveFloating<2, true>);
            advance<K, Resume | HalfKick, Resume | Drift | KickOn>(
                {"correct", "second kick", "correct"});
            break;
        // Viscosity and external forces lead to the densities of whose pressure the rest of the
        // step is.
        case Integrator::Split:
            evaluateForces<K>(Initial::Yes);
            chooseStep();
            moveThings(&S::template moveFloating<2, true>);
            addPass("kick", &S::template onFluid<Integrate<Kick>>);
            addRate<K>();
            addPass("foresee density", &S::template onFluid<Integrate<DriftDensity>>);
            addPass("equation of state", &S::template onFluid<ApplyEquationOfState>);
            addPass("walls", wallPass<K>(), Initial::No, whyNoWallPressure());
            addPass("pressure",
                    &S::template onFluid<
                        ComputeForces<K, Lists::Inner, TermList<PressureForce>, Forces::Alone>>);
            addPass("extremes", &S::countPressure, Initial::No, keepsLists ? "" : noLists);
            addPass("integrate", &S::template onFluid<Integrate<Kick | Drift>>);
            break;
    }
    noteTerms(OptionalTerms{});
    noteTerms(Mixing{});
    addPass("solid collisions", &S::keepOutOfSolids, Initial::No,
            solids_.count() > 0 ? "" : "there are no solids");
    findLoads_ = loadPass<K>();
    sortsInStep_ = int(std::count_if(plan_.begin(), plan_.end(),
                                     [](const Row& row) { return row.run == &S::sort; }));
    for (Row& row : plan_) row.time = timeOf(row.name);
}

// Acceleration of where the particles are.
template <class Device> template <class K>
void SimulationOn<Device>::evaluateForces(Initial initial) {
    using S = SimulationOn;
    addPass("solids", initial == Initial::Yes ? &S::moveSolids : &S::moveSolidsHalfWay, initial,
            solids_.moves()       ? ""
            : solids_.count() > 0 ? "no solid moves"
                                  : "there are no solids");
    addPass("sort", &S::sort, initial);
    addPass("rest", &S::findResting, initial,
            !hasBlockTimeSteps()        ? allAlike
            : parameters_.restSpeed > 0 ? ""
                                        : "nobody rests (time.rest_speed)");
    addPass("due", &S::findActive, initial, hasBlockTimeSteps() ? "" : allAlike);
    addPass("neighbours", &S::findNeighbours, initial, keepsLists ? "" : noLists);
    carriesDensity(scene_)
        ? addPass("equation of state", &S::template onFluid<ApplyEquationOfState>, initial)
        : addPass("density", pairPass<ComputeDensity<K>>(), initial);
    addPass("walls", wallPass<K>(), initial, whyNoWallPressure());
    addPass("surroundings",
            carriesDensity(scene_) ? &S::template onFluid<WeighViscosity<K, Lists::All>>
                                   : pairPass<WeighViscosity<K, Lists::Inner>>(),
            initial, whyViscosityIsNotWeighed());
    addPass("forces", forcePass<K>(), initial);
    const char* noTension = scene_.fluid.surfaceTension > 0 ? "" : "fluid.surface_tension is 0";
    addPass("normals", &S::template onFluid<ComputeNormals>, initial, noTension);
    addPass("surface tension", &S::template onFluid<AddSurfaceTension>, initial, noTension);
    addPass("mixing", pairPass<ComputeForces<MeanKernel, Lists::Inner, Mixing, Forces::Added>>(),
            initial,
            hasMixingForces(scene_) ? "" : "fluid.velocity_transfer and fluid.buoyancy are 0");
    addPass("solid forces", &S::findSolidForces, initial, whyNothingFloats());
    addPass("contact", &S::touchObjects, initial, whyNoObjects());
    addPass("resistance", &S::template onFluid<ResistMotion>, initial,
            scene_.fluid.dissipation + scene_.fluid.airDensity > 0
                ? ""
                : "fluid.dissipation and fluid.air_density are 0");
}

// Solids and objects, by the forces that were found last; also those that the mouse drags.
template <class Device> void SimulationOn<Device>::moveThings(PassFunction moveSolids) {
    using S = SimulationOn;
    addPass("floating solids", moveSolids, Initial::No, hold_.solid >= 0 ? "" : whyNothingFloats());
    addPass("objects", &S::moveObjects, Initial::No, whyNoObjects());
}

// Symplectic Euler from one moment to the next at which anybody is due.
template <class Device> template <class K> void SimulationOn<Device>::stepLocally() {
    using S = SimulationOn;
    addPass("step", &S::beginStep);
    evaluateForces<K>(Initial::Yes);
    addPass("kick", &S::template onFluid<KickActive>);
    addPass("stir", &S::template onFluid<StirFluid>, Initial::No,
            stir_.radius > 0 ? "" : "nobody stirs");
    addPass("moment", &S::chooseSubstep);
    if (!carriesDensity(scene_)) return addPass("drift", &S::template onFluid<Integrate<Drift>>);
    addRate<K>();
    addPass("drift", &S::template onFluid<Integrate<Drift | DriftDensity>>);
}

template <class Device> void SimulationOn<Device>::chooseStep() {
    using S = SimulationOn;
    addPass("extremes", fillsSpace() ? &S::findExtremes<true> : &S::findExtremes<false>,
            Initial::No,
            keepsLists || shifts() || parameters_.fixedStep <= 0
                ? ""
                : "the time step is fixed (time.mode)");
    addPass("time step", &S::chooseTimeStep);
    addPass("stir", &S::template onFluid<StirFluid>, Initial::No,
            stir_.radius > 0 ? "" : "nobody stirs");
}

// In one pass; where density is carried in two, between which its rate comes.
template <class Device> template <class K, unsigned kick, unsigned drift>
void SimulationOn<Device>::advance(Names names) {
    using S = SimulationOn;
    if (!carriesDensity(scene_))
        return addPass(names.both, &S::template onFluid<Integrate<kick | drift>>);
    if constexpr (kick != 0) addPass(names.kick, &S::template onFluid<Integrate<kick>>);
    addRate<K>();
    addPass(names.drift,
            fillsSpace()
                ? &S::template onFluid<Integrate<drift | DriftDensity | DriftShifted | KeepVolume>>
            : shifts() ? &S::template onFluid<Integrate<drift | DriftDensity | DriftShifted>>
                       : &S::template onFluid<Integrate<drift | DriftDensity>>);
}

// Of the velocities that forces have led to, also of what floats: a step late light ones would
// swing against the fluid that they press together.
template <class Device> template <class K> void SimulationOn<Device>::addRate() {
    using S = SimulationOn;
    addPass("velocity of walls", &S::tellWallsVelocity, Initial::No, whyNothingFloats());
    addPass("flow at walls", &S::template onWalls<ContinueFlowIntoWalls<K>>, Initial::No,
            whyFlowEndsAtWalls());
    addPass(shifts() ? "transport" : "density rate", ratePass<K>());
}

template <class Device> template <class K> auto SimulationOn<Device>::wallPass() const
    -> PassFunction {
    using S = SimulationOn;
    if (shifts())
        return fluidSticks() ? &S::template onWalls<ExtrapolateToWalls<K, true, true>>
                             : &S::template onWalls<ExtrapolateToWalls<K, false, true>>;
    return fluidSticks() ? &S::template onWalls<ExtrapolateToWalls<K, true, false>>
                         : &S::template onWalls<ExtrapolateToWalls<K, false, false>>;
}

// The first pass over the fluid's neighbours in a step prunes the lists.
template <class Device> template <class K> auto SimulationOn<Device>::forcePass() const
    -> PassFunction {
    if (fillsSpace())
        return chooseTerms(
            scene_, [](auto terms) { return forces<K, Lists::BuildInner>(terms); },
            TermList<CorrectedPressureForce>{},
            TermList<LaminarViscosity<ViscosityForm::Morris>>{});
    if (scene_.simulation.formulation == Formulation::Classic)
        return chooseTerms(
            scene_, [](auto terms) { return forces<K, Lists::Inner>(terms); },
            TermList<PressureForce>{}, TermList<ClassicViscosity>{});
    return withViscosityForm(scene_, [this](auto form) { return forcesOf<K, form.value>(); });
}

template <class Device> template <class K, ViscosityForm form>
auto SimulationOn<Device>::forcesOf() const -> PassFunction {
    if (scene_.time.integrator == Integrator::Split)
        return forces<K, Lists::BuildInner>(Viscosities<form>{});
    if (isMultiFluid(scene_)) {
        using Terms = TermList<PressureForce, MixtureViscosity<form>>;
        return carriesDensity(scene_) ? forces<K, Lists::BuildInner>(Terms{})
                                      : pairPass<ComputeForces<K, Lists::Inner, Terms>>();
    }
    if (carriesDensity(scene_))
        return chooseTerms(
            scene_, [](auto terms) { return forces<K, Lists::BuildInner>(terms); },
            TermList<PressureForce>{}, Viscosities<form>{});
    if (scene_.simulation.pressureForm == PressureForm::Mean)
        return pairPass<ComputeForces<
            K, Lists::Inner,
            TermList<MeanPressureForce, LaminarViscosity<form>, ArtificialViscosity>>>();
    return chooseTerms(
        scene_,
        [this](auto terms) { return pairPass<ComputeForces<K, Lists::Inner, decltype(terms)>>(); },
        TermList<PressureForce>{}, Viscosities<form>{});
}

// What fluid does to solids, by the terms that act on the fluid. (Corrected gradients have no
// opposite: their pressure is taken as it is without.)
template <class Device> template <class K> auto SimulationOn<Device>::loadPass() const
    -> PassFunction {
    auto pass = [](auto terms) {
        return PassFunction(
            &SimulationOn::template findLoads<ComputeWallLoads<K, decltype(terms)>>);
    };
    return withViscosityForm(scene_, [&](auto form) {
        if (isMultiFluid(scene_))
            return pass(TermList<PressureForce, MixtureViscosity<form.value>>{});
        return chooseTerms(scene_, pass, TermList<PressureForce>{}, Viscosities<form.value>{});
    });
}

template <class Device> template <class K> auto SimulationOn<Device>::ratePass() const
    -> PassFunction {
    if (fillsSpace()) return &SimulationOn::template onFluid<ComputeTransport<K, false>>;
    return shifts() ? &SimulationOn::template onFluid<ComputeTransport<K, true>>
                    : &SimulationOn::template onFluid<ComputeDensityRate<K>>;
}

}  // namespace spindrift::LANES
