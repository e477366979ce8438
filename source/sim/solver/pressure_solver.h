// When pressures are good enough, and what finding them took.
#pragma once

#include "sim/simulation.h"
#include "sim/solver/pressure_passes.h"
#include "sim/step/flow.h"

namespace spindrift::LANES {

template <class Device> class PressureSolver {
public:
    explicit PressureSolver(Flow<Device>& flow) : flow_(flow) {
        error_.resize(1), progress_.resize(1);
    }

    void begin() {
        flow_.device.forEach(1,
                             BeginSolve{flow_.view(), ShareTakenOut::of(flow_.model),
                                        double(flow_.scene.solver.densityError), progress_.data()});
    }
    void findError() {
        flow_.device.reduce(flow_.fluid.slots(), SumError{flow_.fluid.view()}, error_.data());
        flow_.device.forEach(1,
                             ChooseMomentum{flow_.clock.data(), error_.data(), progress_.data()});
    }
    // Asked after each iteration.
    bool isDone() {
        ++now_.iterations;
        SolveProgress p;
        flow_.device.download(&p, progress_.data(), 1);
        if (!p.isFound() && now_.iterations < flow_.scene.solver.iterations) return false;
        now_.error = p.count > 0 ? p.error / p.count : 0, now_.allowed = p.allowed;
        now_.failures = last_.failures + !p.isFound();
        last_ = now_, now_ = {};
        return true;
    }
    void shortenSteps() {
        flow_.device.forEach(1, ShortenSteps{flow_.clock.data(), progress_.data()});
    }
    // Of the last step.
    SolveReport report() const { return last_; }

private:
    Flow<Device>& flow_;
    Buffer<SolveError, Device> error_{flow_.device};
    Buffer<SolveProgress, Device> progress_{flow_.device};
    SolveReport now_, last_;
};

}  // namespace spindrift::LANES
