// When pressures are good enough, and what finding them took.
#pragma once

#include "sim/simulation.h"
#include "sim/solver/pressure_passes.h"
#include "sim/step/flow.h"

namespace spindrift::LANES {

template <class Device> class PressureSolver {
public:
    explicit PressureSolver(Flow<Device>& flow) : flow_(flow) {
        error_.fill({SolveError{}}), progress_.fill({SolveProgress{}});
    }

    void begin() {
        flow_.device.forEach(1,
                             BeginSolve{flow_.view(), ShareTakenOut::of(flow_.model),
                                        double(flow_.scene.solver.densityError), progress_.data()});
    }
    void findError() {
        flow_.device.reduce(flow_.fluid.slots(), SumError{flow_.fluid.view()}, error_.data());
        flow_.device.forEach(1, ChooseMomentum{flow_.clock.data(), error_.data(),
                                               flow_.scene.solver.iterations, progress_.data()});
    }
    // Whether there is another iteration; asked after each.
    bool goesOn() const { return progress().goesOn != 0; }
    // The same, in memory of the device.
    const int* goesOnFlag() const { return &progress_.data()->goesOn; }
    void end() { flow_.device.forEach(1, EndSolve{flow_.clock.data(), progress_.data()}); }
    // Of the last step.
    SolveReport report() const {
        const SolveProgress p = progress();
        SolveReport report;
        report.iterations = p.iterations, report.failures = p.failures;
        report.rough = p.rough, report.allowed = p.allowed;
        report.error = p.error.count > 0 ? p.error.sum / p.error.count : 0;
        return report;
    }

private:
    SolveProgress progress() const {
        SolveProgress p;
        flow_.device.download(&p, progress_.data(), 1);
        return p;
    }

    Flow<Device>& flow_;
    Buffer<SolveError, Device> error_{flow_.device};
    Buffer<SolveProgress, Device> progress_{flow_.device};
};

}  // namespace spindrift::LANES
