// What fluid does to the particles of solids and of the domain's faces.
#pragma once

#include "scene/formulation.h"
#include "sim/parts/energy_passes.h"
#include "sim/parts/solid_load_passes.h"
#include "sim/step/flow.h"

namespace spindrift::LANES {

template <class Device> class SolidLoads {
public:
    explicit SolidLoads(Flow<Device>& flow) : flow_(flow) {}

    // By the terms that act on the fluid. (Corrected gradients have no opposite: their pressure is
    // taken as it is without.)
    template <class Kernel> void choose() {
        auto chosen = [this](auto terms) {
            compute_ = &SolidLoads::template compute<ComputeWallLoads<Kernel, decltype(terms)>>;
        };
        computeArtificial_ =
            &SolidLoads::template compute<ComputeWallLoads<Kernel, TermList<ArtificialViscosity>>>;
        const Scene& scene = flow_.scene;
        withViscosityForm(scene, [&](auto form) {
            if (isMultiFluid(scene))
                return chosen(TermList<PressureForce, MixtureViscosity<form.value>>{});
            if (factsOf(scene).solvesPressure)
                return chooseTerms(scene, chosen, TermList<MirroredPressureForce>{},
                                   Viscosities<form.value>{});
            return chooseTerms(scene, chosen, TermList<PressureForce>{}, Viscosities<form.value>{});
        });
    }
    void reserve(int slots) {
        for (auto* field : {&pressure_, &other_, &seen_, &seenAtRest_})
            field->resize(vectorSize(slots));
        for (auto* field : {&own_, &artificial_})
            if (flow_.scene.output.energyBalance) field->resize(vectorSize(slots));
        gap_.resize(1), around_.resize(1);
    }
    // `bodies`: of those that float. With their feet in the domain's walls, or without.
    void find(const WallsAtHome& home, const RigidBody* bodies, bool withFeet) {
        const View v = flow_.view();
        reserve(v.walls.slots);
        if (withFeet) foot_.resize(v.walls.slots);
        bearers_ = {home, withFeet ? foot_.data() : nullptr, flow_.asksForWallLoads()};
        if (withFeet)
            flow_.device.forEach(
                v.walls.slots,
                FindFeet{v, home, bodies, real(flow_.scene.simulation.spacing), foot_.data()});
        (this->*compute_)(v, field(pressure_), field(other_));
        for (int s = 0; s < v.solidCount; ++s)
            if (flow_.scene.solids[size_t(s)].floats())
                pressFromGaps(
                    {v, home, bodies, s, field(pressure_), field(seen_), field(seenAtRest_)});
    }
    // Likewise what walls do to the fluid, with what forces of viscosity there are. `noPressure`: 0
    // of each particle of fluid, with which what is left is the walls' own pressure.
    SumWallPower findPower(const WallsAtHome& home, bool isViscous, bool isArtificial,
                           ScalarField noPressure) {
        View v = flow_.view();
        reserve(v.walls.slots);
        bearers_ = {home, nullptr, true};
        const VectorField pressure = field(pressure_), other = field(other_), own = field(own_),
                          artificial = field(artificial_);
        if (isViscous && isArtificial) (this->*computeArtificial_)(v, own, artificial);
        v.fluid.pressureOverRho2 = noPressure;
        (this->*compute_)(v, own, other);
        (this->*compute_)(flow_.view(), pressure, other);
        return {v, pressure, own, other,
                !isArtificial ? VectorField{}
                : isViscous   ? artificial
                              : other};
    }
    SumFaceLoads sumOfFaces(const View& v, int axis) {
        return {v, field(pressure_), field(other_), bearers_, axis};
    }
    SumSolidLoad sumOf(const View& v, int solid) {
        return {v, field(pressure_), field(other_), bearers_, solid};
    }

private:
    static VectorField field(const Buffer<real, Device>& b) { return VectorField{b.data()}; }
    template <class Pass> void compute(const View& v, VectorField pressure, VectorField other) {
        flow_.device.forEach(
            v.walls.slots, Pass{v, Pass::Parameters::of(flow_.model), pressure, other, field(seen_),
                                field(seenAtRest_), bearers_});
    }
    void pressFromGaps(const BesideGround& beside) {
        const int slots = beside.v.walls.slots;
        flow_.device.reduce(slots, FindGap{beside}, gap_.data());
        flow_.device.reduce(slots, FindPressureAround{beside, gap_.data()}, around_.data());
        flow_.device.forEach(slots, PressFromGaps{beside, gap_.data(), around_.data()});
    }

    Flow<Device>& flow_;
    using Compute = void (SolidLoads::*)(const View&, VectorField, VectorField);
    Compute compute_ = nullptr, computeArtificial_ = nullptr;
    Bearers bearers_{};
    Buffer<int, Device> foot_{flow_.device};
    Buffer<real, Device> pressure_{flow_.device}, other_{flow_.device}, seen_{flow_.device},
        seenAtRest_{flow_.device}, own_{flow_.device}, artificial_{flow_.device};
    Buffer<Gap, Device> gap_{flow_.device};
    Buffer<PressureAround, Device> around_{flow_.device};
};

}  // namespace spindrift::LANES
