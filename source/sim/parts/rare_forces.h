// Forces that few scenes have, each in passes of its own on top of the others.
#pragma once

#include "sim/step/flow.h"
#include "sim/parts/part.h"
#include "sim/physics/surface.h"

namespace spindrift::LANES {

template <class Device> class SurfaceTension : public Part {
public:
    explicit SurfaceTension(Flow<Device>& flow) : flow_(flow) {}
    void addForces(Plan& plan, Initial initial) {
        const char* none = flow_.scene.fluid.surfaceTension > 0 ? "" : "fluid.surface_tension is 0";
        plan.add(
            "normals", [this] { flow_.template onFluid<ComputeNormals>(); }, initial, none);
        plan.add(
            "surface tension", [this] { flow_.template onFluid<AddSurfaceTension>(); }, initial,
            none);
    }

private:
    Flow<Device>& flow_;
};

// Velocity transfer and buoyancy.
template <class Device> class MixingForces : public Part {
public:
    explicit MixingForces(Flow<Device>& flow) : flow_(flow) {}
    void addForces(Plan& plan, Initial initial) {
        using Pass = ComputeForces<MeanKernel, Lists::Inner, Mixing, Forces::Added>;
        plan.add(
            "mixing", [this] { flow_.template onPairsOrFluid<Pass>(); }, initial,
            hasMixingForces(flow_.scene) ? "" : "fluid.velocity_transfer and fluid.buoyancy are 0");
    }

private:
    Flow<Device>& flow_;
};

// What air and plain slowing down take.
template <class Device> class Resistance : public Part {
public:
    explicit Resistance(Flow<Device>& flow) : flow_(flow) {}
    void addForces(Plan& plan, Initial initial) {
        plan.add(
            "resistance", [this] { flow_.template onFluid<ResistMotion>(); }, initial,
            flow_.scene.fluid.dissipation + flow_.scene.fluid.airDensity > 0
                ? ""
                : "fluid.dissipation and fluid.air_density are 0");
    }

private:
    Flow<Device>& flow_;
};

}  // namespace spindrift::LANES
