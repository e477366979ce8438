// Where the fluid's energy comes from and goes to, step by step: output.energy_balance. Each power
// is that of the terms that act, found once more one by one, so that nothing here knows a formula
// of theirs.
#pragma once

#include "scene/formulation.h"
#include "sim/parts/energy_passes.h"
#include "sim/parts/part.h"
#include "sim/parts/solids.h"
#include "sim/physics/forces.h"
#include "sim/physics/transport.h"

#include <string>

namespace spindrift::LANES {

template <class Device> class EnergyBalance : public Part {
public:
    EnergyBalance(Flow<Device>& flow, Solids<Device>& solids) : flow_(flow), solids_(solids) {}

    void refresh() {
        if (!isOn()) return;
        withCompiledKernel(flow_.scene.simulation.kernel,
                           [&](auto kernel) { findTerms<decltype(kernel)>(); });
        power_.resize(1), rates_.resize(1), before_.resize(1), after_.resize(1), ledger_.resize(1);
        walls_.fill(std::vector<WallPower>(1));
    }
    void restart(const RunState& s) {
        if (isOn()) ledger_.fill(std::vector<EnergyLedger>{s.energy});
    }
    void save(RunState& s) {
        if (isOn()) s.energy = ledger_.download()[0];
    }
    // Room for a recorded step.
    void sorted() {
        if (!isOn()) return;
        for (auto* field :
             {&pressure_, &ofWalls_, &viscosity_, &artificial_, &unshiftedAcceleration_})
            field->resize(vectorSize(flow_.fluid.slots()));
        for (auto* field : {&undiffused_, &withWallsOwn_, &unshifted_})
            field->resize(size_t(flow_.fluid.slots()));
        const size_t slots = size_t(flow_.fluid.slots());
        if (noPressure_.size() != slots) noPressure_.fill(std::vector<real>(slots));
        solids_.reserveLoads();
    }
    void weigh(Plan& plan, Moment moment) {
        const char* off = isOn() ? "" : "output.energy_balance is off";
        auto add = [&](const char* name, auto run, const char* skipped) {
            plan.add(name, std::move(run), Initial::No, *off ? off : skipped);
        };
        switch (moment) {
            case Moment::BeforeStir:
                return add(
                    "energy before", [this] { sumKinetic(before_); }, whyNotStirred());
            case Moment::Stirred:
                return add(
                    "work of stirring", [this] { bookStirring(); }, whyNotStirred());
            case Moment::ForcesKnown:
                return add(
                    "forces without pressure", [this] { keepForces(); },
                    solves() ? "" : "pressure is among the forces");
            case Moment::BeforeKick:
                return add(
                    "work of forces", [this] { bookForces(); }, "");
            case Moment::PressureSolved:
                return add(
                    "work of solved pressure", [this] { bookSolvedPressure(); },
                    solves() ? "" : "pressure is not solved for");
            case Moment::BeforeDrift:
                return add(
                    "work of rates", [this] { bookRates(); }, rate_ ? "" : "density is summed up");
        }
    }
    void measure(Measurement& m) {
        if (!isOn()) return;
        const EnergyLedger l = ledger_.download()[0];
        EnergyMeasurement e{compression(), l.gravity,    l.walls,     l.stirred,  l.others,
                            l.viscosity,   l.artificial, l.diffusion, l.shifting, l.wallPressure};
        const double dissipated =
            l.viscosity + l.artificial + l.diffusion + l.shifting + l.wallPressure;
        e.unexplained = thereOf(m) + e.compression - l.start + dissipated - l.walls - l.stirred -
                        l.others - (hasPotential() ? 0 : l.gravity);
        m.energy = e;
    }
    // At the beginning of a run, of what is there.
    void begin(const Measurement& m) {
        if (!isOn()) return;
        EnergyLedger l = ledger_.download()[0];
        if (l.begun) return;
        l.begun = true, l.start = thereOf(m) + compression();
        ledger_.fill(std::vector<EnergyLedger>{l});
    }
    bool isOn() const { return flow_.scene.output.energyBalance; }

private:
    using Field = Buffer<real, Device>;
    static constexpr Lists inner = buildsInner ? Lists::Inner : Lists::All;

    bool solves() const { return factsOf(flow_.scene).solvesPressure; }
    const char* whyNotStirred() const { return flow_.stir.radius > 0 ? "" : "nothing is stirred"; }
    bool wallsMove() const {
        return flow_.wallCount > 0 &&
               (solids_.moves() || flow_.scene.walls.movingFace != Face::None);
    }
    // Energy of place has no meaning where gravity drives a flow round and round, or grows.
    bool hasPotential() const {
        const Scene& s = flow_.scene;
        for (int k = 0; k < 3; ++k)
            if (s.domain.periodic(k) &&
                (s.simulation.gravity[k] != 0 || s.simulation.centralRate > 0))
                return false;
        return s.simulation.gravityRamp <= 0;
    }
    double thereOf(const Measurement& m) const {
        return m.kineticEnergy + (hasPotential() ? m.potentialEnergy : 0);
    }
    double compression() {
        const Scene& s = flow_.scene;
        if (solves()) return 0;
        const View v = flow_.view();
        const double sum = flow_.device.template sum<Total>(v.fluid.slots, SumCompression{v}).sum;
        // Gradients are exact on the lattice, densities too, and so they differ by a factor where
        // both are sums.
        const double scale =
            carriesDensity(s) ? 1 : flow_.model.sums.kernel / flow_.model.sums.gradient;
        return scale * particleMass(s) * sum;
    }

    // --- the terms that act, each alone ---

    template <class Kernel> void findTerms() {
        const Scene& s = flow_.scene;
        pressurePass_ = viscosityPass_ = artificialPass_ = nullptr;
        if (factsOf(s).fillsSpace)
            pressurePass_ = alone<Kernel, TermList<CorrectedPressureForce>>();
        else if (factsOf(s).meansPressure && s.simulation.pressureForm == PressureForm::Mean)
            pressurePass_ = alone<Kernel, TermList<MeanPressureForce>>();
        else if (!factsOf(s).solvesPressure)
            pressurePass_ = alone<Kernel, TermList<PressureForce>>();
        withViscosityForm(s, [&](auto form) {
            if (isMultiFluid(s))
                viscosityPass_ = alone<Kernel, TermList<MixtureViscosity<form.value>>>();
            else if (!*LaminarViscosity<form.value>::skipped(s))
                viscosityPass_ = alone<Kernel, TermList<LaminarViscosity<form.value>>>();
        });
        // Its sum is corrected by moments that go with the pressure's.
        if (factsOf(s).fillsSpace && viscosityPass_)
            viscosityPass_ =
                alone<Kernel,
                      TermList<CorrectedPressureForce, LaminarViscosity<ViscosityForm::Morris>>>();
        if (!*ArtificialViscosity::skipped(s))
            artificialPass_ = alone<Kernel, TermList<ArtificialViscosity>>();
        rate_ = !carriesDensity(s)      ? nullptr
                : factsOf(s).fillsSpace ? &EnergyBalance::findRates<ComputeTransport<Kernel, false>>
                : shiftsParticles(s)    ? &EnergyBalance::findRates<ComputeTransport<Kernel, true>>
                                        : &EnergyBalance::findRates<ComputeDensityRate<Kernel>>;
    }
    using ForcePass = void (EnergyBalance::*)(View, Field&);
    template <class Kernel, class Terms> static ForcePass alone() {
        return &EnergyBalance::find<ComputeForces<Kernel, inner, Terms, Forces::Alone>>;
    }
    // The sum of a pass's terms, in a field of its own.
    template <class Pass> void find(View v, Field& out) {
        v.fluid.acceleration = VectorField{out.data()};
        const Pass pass{v, Pass::Parameters::of(flow_.model)};
        if constexpr (Pass::needs & Moments)
            flow_.device.forEach(v.fluid.slots, pass);
        else
            flow_.runOnPairsOrFluid(pass);
    }
    VectorField found(ForcePass pass, Field& out) {
        if (!pass) return {};
        (this->*pass)(flow_.view(), out);
        return field(out);
    }
    // Rates without diffusion, with walls' own velocity, and without shifting.
    template <class Pass> void findRates() {
        View v = flow_.view();
        v.fluid.shiftVelocity = field(pressure_);  // what that was is not needed any more
        v.fluid.shiftAcceleration = field(unshiftedAcceleration_);
        const auto find = [&](View with, Field& out, bool shifts) {
            with.fluid.densityRate = ScalarField{out.data()};
            if constexpr (requires { typename Pass::Parameters; }) {
                auto own = Pass::Parameters::of(flow_.model);
                if (!shifts) own.shifting = 0;
                flow_.device.forEach(v.fluid.slots, Pass{with, own});
            } else {
                flow_.device.forEach(v.fluid.slots, Pass{with});
            }
        };
        View other = v;
        other.c.diffusion = 0;
        find(other, undiffused_, true);
        other = v, other.walls.flowVelocity = {};
        if (v.walls.flowVelocity.data) find(other, withWallsOwn_, true);
        if (shiftsParticles(flow_.scene)) find(v, unshifted_, false);
    }

    // --- what rows do ---

    void sumKinetic(Buffer<Total, Device>& out) {
        flow_.device.reduce(flow_.fluid.slots(), SumKinetic{flow_.fluid.view()}, out.data());
    }
    void bookStirring() {
        sumKinetic(after_);
        flow_.device.forEach(1,
                             BookStirring{ledger_.data(), before_.data(), after_.data(), mass()});
    }
    double mass() const { return particleMass(flow_.scene); }
    void sumWalls() {
        if (!wallsMove()) return;
        flow_.device.reduce(flow_.walls.slots(),
                            solids_.findPower(viscosityPass_, artificialPass_, noPressure()),
                            walls_.data());
    }
    ScalarField noPressure() const { return ScalarField{noPressure_.data()}; }
    void keepForces() {
        flow_.device.forEach(flow_.fluid.slots(), KeepAcceleration{flow_.view(), field(pressure_)});
    }
    static VectorField field(const Field& f) { return VectorField{f.data()}; }
    // The part of pressure forces that is there where only walls have any.
    VectorField foundOfWalls() {
        if (!pressurePass_ || flow_.wallCount == 0) return {};
        View v = flow_.view();
        v.fluid.pressureOverRho2 = noPressure();
        (this->*pressurePass_)(v, ofWalls_);
        return field(ofWalls_);
    }
    void bookForces() {
        const VectorField pressure = found(pressurePass_, pressure_), ofWalls = foundOfWalls(),
                          viscosity = found(viscosityPass_, viscosity_),
                          artificial = found(artificialPass_, artificial_);
        const View v = flow_.view();
        const VectorField all = solves() ? field(pressure_) : v.fluid.acceleration;
        flow_.device.reduce(
            v.fluid.slots,
            SumPower{v, all, pressure, ofWalls, viscosity, artificial, shareOfKick()},
            power_.data());
        sumWalls();
        flow_.device.forEach(1, BookForces{ledger_.data(), power_.data(), walls_.data(), v.state,
                                           mass(), solves(), pressureIsInViscosity()});
    }
    real shareOfKick() const {
        return flow_.scene.time.integrator == Integrator::SymplecticEuler ? real(0.5) : real(0);
    }
    bool pressureIsInViscosity() const { return factsOf(flow_.scene).fillsSpace && viscosityPass_; }
    // With the velocities that it has led to, with which places change.
    void bookSolvedPressure() {
        const View v = flow_.view();
        flow_.device.reduce(v.fluid.slots, SumPower{v, {}, {}, {}, {}, {}, real(0)}, power_.data());
        sumWalls();
        flow_.device.forEach(
            1, BookSolvedPressure{ledger_.data(), power_.data(), walls_.data(), v.state, mass()});
    }
    void bookRates() {
        (this->*rate_)();
        const View v = flow_.view();
        const auto found = [](const Field& f, bool isThere) {
            return isThere ? ScalarField{f.data()} : ScalarField{};
        };
        flow_.device.reduce(v.fluid.slots,
                            SumRatePower{v, found(undiffused_, true),
                                         found(withWallsOwn_, v.walls.flowVelocity.data),
                                         found(unshifted_, shiftsParticles(flow_.scene)),
                                         field(unshiftedAcceleration_), hasPotential()},
                            rates_.data());
        flow_.device.forEach(1, BookRates{ledger_.data(), rates_.data(), v.state, mass()});
    }

    Flow<Device>& flow_;
    Solids<Device>& solids_;
    ForcePass pressurePass_ = nullptr, viscosityPass_ = nullptr, artificialPass_ = nullptr;
    void (EnergyBalance::*rate_)() = nullptr;
    Field pressure_{flow_.device}, viscosity_{flow_.device}, artificial_{flow_.device},
        ofWalls_{flow_.device}, unshiftedAcceleration_{flow_.device}, noPressure_{flow_.device},
        undiffused_{flow_.device}, withWallsOwn_{flow_.device}, unshifted_{flow_.device};
    Buffer<Power, Device> power_{flow_.device};
    Buffer<WallPower, Device> walls_{flow_.device};
    Buffer<RatePower, Device> rates_{flow_.device};
    Buffer<Total, Device> before_{flow_.device}, after_{flow_.device};
    Buffer<EnergyLedger, Device> ledger_{flow_.device};
};

}  // namespace spindrift::LANES
