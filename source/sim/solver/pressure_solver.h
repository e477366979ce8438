// When pressures are good enough, and what finding them took.
#pragma once

#include "sim/simulation.h"
#include "sim/solver/pressure_passes.h"
#include "sim/step/flow.h"

namespace spindrift::LANES {

template <class Device> class PressureSolver {
public:
    explicit PressureSolver(Flow<Device>& flow) : flow_(flow) {
        error_.resize(1), momentum_.resize(1);
    }

    // Mean growth of density in a step, relative to rho0. As a step takes out a share of what
    // densities are too large by, they are too large by no more than what is asked for.
    double allowed() const {
        const Solver& asked = flow_.scene.solver;
        return double(asked.densityError) * double(asked.densityShare);
    }
    void begin() { flow_.device.forEach(1, BeginSolve{flow_.clock.data(), momentum_.data()}); }
    void findError() {
        flow_.device.reduce(flow_.fluid.slots(), SumError{flow_.fluid.view()}, error_.data());
        flow_.device.forEach(1,
                             ChooseMomentum{flow_.clock.data(), error_.data(), momentum_.data()});
    }
    // Asked after each iteration.
    bool isDone() {
        ++now_.iterations;
        SolveError e;
        flow_.device.download(&e, error_.data(), 1);
        now_.error = e.count > 0 ? e.growth / e.count : 0;
        const bool found = now_.error <= allowed();
        if (!found && now_.iterations < flow_.scene.solver.iterations) return false;
        now_.failures = last_.failures + !found;
        last_ = now_, now_ = {};
        return true;
    }
    void shortenSteps() {
        flow_.device.forEach(1, ShortenSteps{flow_.clock.data(), error_.data(), allowed()});
    }
    // Of the last step.
    SolveReport report() const { return last_; }

private:
    Flow<Device>& flow_;
    Buffer<SolveError, Device> error_{flow_.device};
    Buffer<Momentum, Device> momentum_{flow_.device};
    SolveReport now_, last_;
};

}  // namespace spindrift::LANES
