// What a step consists of: the passes that a scene needs, in order. What it doesn't need isn't in
// the plan.
#pragma once

#include "scene/formulation.h"
#include "sim/parts/block_time_steps.h"
#include "sim/solver/pressure_solver.h"
#include "sim/physics/forces.h"
#include "sim/physics/transport.h"
#include "sim/physics/walls.h"
#include "sim/step/flow.h"
#include "sim/parts/part.h"
#include "sim/step/plan.h"
#include "sim/step/step_length.h"

#include <algorithm>
#include <string>
#include <utility>

namespace spindrift::LANES {

// `Parts`: a tuple of references, in the order in which they act.
template <class Device, class K, class Parts> class StepMaker {
public:
    StepMaker(Flow<Device>& flow, BlockTimeSteps<Device>& blocks, PressureSolver<Device>& solver,
              const Parts& parts)
        : flow_(flow), scene_(flow.scene), blocks_(blocks), solver_(solver), parts_(parts) {}

    Plan plan() {
        switch (scene_.time.integrator) {
            case Integrator::SymplecticEuler:
                solves()          ? incompressible()
                : blocks_.areOn() ? blockTimeSteps()
                                  : symplecticEuler();
                break;
            case Integrator::VelocityVerlet:
                velocityVerlet();
                break;
            case Integrator::PredictorCorrector:
                predictorCorrector();
                break;
            case Integrator::Split:
                split();
                break;
        }
        return std::move(plan_);
    }

private:
    using Pass = void (Flow<Device>::*)();
    static constexpr bool keepsLists = NeighbourSearch<Device>::keepsLists;
    static constexpr const char* noLists = "rows of cells are walked instead of lists";

    // --- integrators ---

    // v += a dt, x += v dt.
    void symplecticEuler() {
        evaluateForces(Initial::Yes);
        chooseStep();
        weigh(Moment::BeforeKick);
        move({2, true});
        advance<Kick, Drift>({"integrate", "kick", "drift"});
        end();
    }
    // Verlet 1967 with velocities: forces at the end of the step with the velocity foreseen there,
    // of which then half is taken back for half of the new acceleration.
    void velocityVerlet() {
        chooseStep();
        move({1, true});
        advance<HalfKick, Drift | KeepVelocity | KickOn>({"integrate", "kick", "drift"});
        evaluateForces(Initial::Yes);
        weigh(Moment::BeforeKick);
        move({1, false});
        add("second kick", onFluid<Integrate<Resume | HalfKick>>);
        end();
    }
    // Half a step ahead; from there the forces and then, with the mean velocity, the rates of the
    // whole step (Monaghan 1989; the mean of old and new velocity keeps oscillations from growing,
    // as in a leapfrog).
    void predictorCorrector() {
        evaluateForces(Initial::Yes);
        chooseStep();
        advance<0, Keep | HalfDrift | KickOn>({"predict", "", "predict"});
        evaluateForces(Initial::No);
        weigh(Moment::BeforeKick);
        bound([](auto& flow) { boundCorrection(flow); });
        move({2, true});
        advance<Resume | HalfKick, Resume | Drift | KickOn>({"correct", "second kick", "correct"});
        end();
    }
    // The rest of the step has the pressure of densities that viscosity and body forces lead to.
    void split() {
        evaluateForces(Initial::Yes);
        chooseStep();
        move({2, true});
        add("kick", onFluid<Integrate<Kick>>);
        addRate();
        add("foresee density", onFluid<Integrate<DriftDensity>>);
        add("equation of state", onFluid<ApplyEquationOfState>);
        add("walls", wallPass(), Initial::No, whyNoWallPressure());
        add("pressure", onFluid<ComputeForces<K, inner, TermList<PressureForce>, Forces::Alone>>);
        holdBack(Initial::No);
        bound([](auto& flow) { boundSplitMove(flow); });
        add("integrate", onFluid<Integrate<Kick | Drift>>);
        end();
    }
    // Symplectic Euler, with pressures that keep densities from growing by where it leads.
    void incompressible() {
        evaluateForces(Initial::Yes);
        weigh(Moment::ForcesKnown);
        add("gradients", onPairsOrFluid<SumGradients<K, inner>>);
        holdBack(Initial::No);
        chooseStep();
        weigh(Moment::BeforeKick);
        add("kick", onFluid<Integrate<Kick>>);
        add("source", onPairsOrFluid<FindSource<K, inner>>);
        plan_.add("begin solve", [&solver = solver_] { solver.begin(); });
        plan_.beginLoop();
        add("pressure forces", onPairsOrFluid<AccelerateByPressure<K, inner>>);
        holdBack(Initial::No);
        add("relax pressure", onPairsOrFluid<RelaxPressure<K, inner>>);
        plan_.add("error", [&solver = solver_] { solver.findError(); });
        plan_.endLoop([&solver = solver_] { return !solver.goesOn(); }, solver_.goesOnFlag());
        plan_.add("end solve", [&solver = solver_] { solver.end(); });
        add("scale pressures", onFluid<ScalePressures>);
        add("pressure kick", onFluid<Integrate<PressureKick>>);
        weigh(Moment::PressureSolved);
        addPartForces(Initial::No, true);
        move({2, true});
        bound([](auto& flow) { boundMove(flow); });
        add("drift", onFluid<Integrate<Drift>>);
        end();
    }
    // Symplectic Euler from one substep to the next, until all particles have ended their steps.
    void blockTimeSteps() {
        plan_.beginLoop();
        blocks_.begin(plan_);
        evaluateForces(Initial::Yes);
        blocks_.kick(plan_);
        stir();
        blocks_.chooseSubstep(plan_);
        if (!carriesDensity(scene_)) {
            add("drift", onFluid<Integrate<Drift>>);
        } else {
            addRate();
            add("drift", onFluid<Integrate<Drift | DriftDensity>>);
        }
        end();
        plan_.endLoop([&blocks = blocks_] { return blocks.atStepEnd(); });
    }

    // --- what integrators consist of ---

    // Acceleration of where the particles are.
    void evaluateForces(Initial initial) {
        forEachPart(parts_,
                    [&](auto& part) { part.place(plan_, initial, initial == Initial::No); });
        plan_.add(
            "sort",
            [&flow = flow_, &blocks = blocks_, parts = parts_] {
                if (flow.search.holds()) return;
                flow.search.renew(flow.scene.compute.skin, supportRadius(flow.scene),
                                  blocks.shareAwake());
                flow.search.sort(flow.fluid);
                forEachPart(parts, [](auto& part) { part.sorted(); });
                flow.search.invalidate(flow.view());
            },
            initial);
        forEachPart(parts_, [&](auto& part) { part.choose(plan_, initial); });
        plan_.add(
            "neighbours",
            [&flow = flow_, parts = parts_] {
                flow.findNeighbours();
                forEachPart(parts, [](auto& part) { part.findNeighbours(); });
            },
            initial, keepsLists ? "" : noLists);
        if (!carriesDensity(scene_)) add("density", densityPass(), initial);
        forEachPart(parts_, [&](auto& part) { part.borrowPressure(plan_, initial); });
        if (carriesDensity(scene_))
            add("equation of state", onFluid<ApplyEquationOfState>, initial);
        add("walls", wallPass(), initial, whyNoWallPressure());
        add("surroundings",
            carriesDensity(scene_) ? onFluid<WeighViscosity<K, Lists::All>>
                                   : onPairsOrFluid<WeighViscosity<K, inner>>,
            initial, whyViscosityIsNotWeighed(flow_));
        add("forces", forcePass(), initial);
        addPartForces(initial, false);
        if (!solves()) holdBack(initial);
    }
    void holdBack(Initial initial) {
        forEachPart(parts_, [&](auto& part) { part.holdBack(plan_, initial); });
    }
    // Of parts that feel the fluid's pressure when that is known: after it has been solved for.
    void addPartForces(Initial initial, bool isSolved) {
        forEachPart(parts_, [&](auto& part) {
            if ((solves() && part.feelsPressure) == isSolved) part.addForces(plan_, initial);
        });
    }
    void chooseStep() {
        const bool needed =
            keepsLists || shiftsParticles(scene_) || solves() || flow_.model.shared.fixedStep <= 0;
        plan_.add(
            "extremes",
            [&flow = flow_, parts = parts_] {
                factsOf(flow.scene).fillsSpace ? findExtremes<true>(flow)
                                               : findExtremes<false>(flow);
                forEachPart(parts, [](auto& part) { part.findSpeed(); });
            },
            Initial::No, needed ? "" : "the time step is fixed (time.mode)");
        plan_.add("time step", [&flow = flow_] { chooseTimeStep(flow); });
        stir();
    }
    void stir() {
        weigh(Moment::BeforeStir);
        add("stir", onFluid<StirFluid>, Initial::No,
            flow_.stir.radius > 0 ? "" : "nothing is stirred");
        weigh(Moment::Stirred);
    }
    void weigh(Moment moment) {
        forEachPart(parts_, [&](auto& part) { part.weigh(plan_, moment); });
    }
    template <class F> void bound(F f) {
        plan_.add(
            "extremes", [f, &flow = flow_] { f(flow); }, Initial::No, keepsLists ? "" : noLists);
    }
    // Solids and objects, by the forces that were found last; also those that the mouse drags.
    void move(ShareOfStep share) {
        forEachPart(parts_, [&](auto& part) { part.move(plan_, share); });
    }
    struct Names {
        const char *both, *kick, *drift;
    };
    // In one pass; where density is carried in two, between which its rate comes.
    template <unsigned kick, unsigned drift> void advance(Names names) {
        if (!carriesDensity(scene_)) return add(names.both, onFluid<Integrate<kick | drift>>);
        if constexpr (kick != 0) add(names.kick, onFluid<Integrate<kick>>);
        addRate();
        if constexpr (drift & Drift) weigh(Moment::BeforeDrift);
        add(names.drift, factsOf(scene_).fillsSpace
                             ? onFluid<Integrate<drift | DriftDensity | DriftShifted | KeepVolume>>
                         : shiftsParticles(scene_)
                             ? onFluid<Integrate<drift | DriftDensity | DriftShifted>>
                             : onFluid<Integrate<drift | DriftDensity>>);
    }
    void addRate() {
        forEachPart(parts_, [&](auto& part) { part.addRates(plan_); });
        add(shiftsParticles(scene_) ? "transport" : "density rate", ratePass());
        if (shiftsParticles(scene_)) holdBack(Initial::No);
    }
    void end() {
        noteTerms(Joined<OptionalTerms, Mixing>{});
        forEachPart(parts_, [&](auto& part) { part.collide(plan_); });
    }

    // --- passes of this scene ---

    template <class P> static constexpr Pass onFluid = &Flow<Device>::template onFluid<P>;
    template <class P> static constexpr Pass onPairsOrFluid =
        &Flow<Device>::template onPairsOrFluid<P>;
    // The first pass over the fluid's neighbours in a step makes inner lists for the others.
    static constexpr Lists inner = buildsInner ? Lists::Inner : Lists::All,
                           buildInner = buildsInner ? Lists::BuildInner : Lists::All;

    // The classic formulation has one kernel.
    Pass densityPass() const {
        return solves() ? onPairsOrFluid<ComputeDensity<K, true>>
               : factsOf(scene_).isHistorical
                   ? onPairsOrFluid<ComputeDensity<CubicSplineKernel, false>>
                   : onPairsOrFluid<ComputeDensity<K, false>>;
    }
    Pass wallPass() const { return shiftsParticles(scene_) ? wallPass<true>() : wallPass<false>(); }
    template <bool dense> Pass wallPass() const {
        return flow_.fluidSticks()
                   ? &Flow<Device>::template onWalls<ExtrapolateToWalls<K, true, dense>>
                   : &Flow<Device>::template onWalls<ExtrapolateToWalls<K, false, dense>>;
    }
    Pass forcePass() const {
        if (factsOf(scene_).fillsSpace)
            return chooseTerms(
                scene_, [](auto terms) { return forces<buildInner>(terms); },
                TermList<CorrectedPressureForce>{},
                TermList<LaminarViscosity<ViscosityForm::Morris>>{});
        if (factsOf(scene_).isHistorical)
            return chooseTerms(
                scene_, [](auto terms) { return classicForces(terms); }, TermList<PressureForce>{},
                TermList<ClassicViscosity>{});
        return withViscosityForm(scene_, [this](auto form) { return forcesOf<form.value>(); });
    }
    template <ViscosityForm form> Pass forcesOf() const {
        if (solves())
            return chooseTerms(
                scene_, [](auto terms) { return withoutPressure(terms); }, TermList<>{},
                Viscosities<form>{});
        if (scene_.time.integrator == Integrator::Split)
            return forces<buildInner>(Viscosities<form>{});
        if (isMultiFluid(scene_))
            return forcesBy(TermList<PressureForce, MixtureViscosity<form>>{});
        if (!carriesDensity(scene_) && scene_.simulation.pressureForm == PressureForm::Mean)
            return pairForces(
                TermList<MeanPressureForce, LaminarViscosity<form>, ArtificialViscosity>{});
        return chooseTerms(
            scene_, [this](auto terms) { return forcesBy(terms); }, TermList<PressureForce>{},
            Viscosities<form>{});
    }
    template <class Terms> Pass forcesBy(Terms terms) const {
        return carriesDensity(scene_) ? forces<buildInner>(terms) : pairForces(terms);
    }
    template <class Terms> static Pass pairForces(Terms) {
        return onPairsOrFluid<ComputeForces<K, inner, Terms>>;
    }
    static Pass withoutPressure(TermList<>) { return onFluid<ApplyBodyForce>; }
    template <class... Ts> static Pass withoutPressure(TermList<Ts...> terms) {
        return pairForces(terms);
    }
    template <class Terms> static Pass classicForces(Terms) {
        return onFluid<ComputeForces<CubicSplineKernel, inner, Terms>>;
    }
    template <Lists lists, class Terms> static Pass forces(Terms) {
        return onFluid<ComputeForces<K, lists, Terms>>;
    }
    Pass ratePass() const {
        if (factsOf(scene_).fillsSpace) return onFluid<ComputeTransport<K, false>>;
        return shiftsParticles(scene_) ? onFluid<ComputeTransport<K, true>>
                                       : onFluid<ComputeDensityRate<K>>;
    }
    bool solves() const { return factsOf(scene_).solvesPressure; }
    const char* whyNoWallPressure() const {
        if (flow_.wallCount == 0) return "there are no boundary particles";
        if (flow_.wallsCarryPressure()) return "";
        return solves() ? "walls mirror the fluid's pressure"
                        : "walls have no pressure in the classic formulation";
    }

    void add(const char* name, Pass pass, Initial initial = Initial::No, const char* skipped = "") {
        plan_.add(
            name, [&flow = flow_, pass] { (flow.*pass)(); }, initial, skipped);
    }
    template <class... Ts> void noteTerms(TermList<Ts...>) {
        (plan_.note(std::string("forces: ") + Ts::name, Ts::skipped(scene_)), ...);
    }

    Flow<Device>& flow_;
    const Scene& scene_;
    BlockTimeSteps<Device>& blocks_;
    PressureSolver<Device>& solver_;
    Parts parts_;
    Plan plan_;
};

}  // namespace spindrift::LANES
