// Forces that few scenes have, each in passes of its own on top of the others.
#pragma once

#include "sim/step/flow.h"
#include "sim/parts/part.h"
#include "sim/physics/forces.h"
#include "sim/physics/surface.h"

#include <cmath>

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
    // Brackbill 1992.
    double longestStep() const {
        const Fluid& f = flow_.scene.fluid;
        const double h = flow_.model.h(), pi = 3.14159265358979323846;
        return f.surfaceTension > 0
                   ? 0.25 * std::sqrt(f.restDensity * h * h * h / (2 * pi * f.surfaceTension))
                   : 1e9;
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
    double longestStep() const { return longestStepOf(flow_.model, Mixing{}); }

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
