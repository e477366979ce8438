#pragma once
// Whether a run still makes physical sense, and what is done when it doesn't.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

// One line that says how the run has diverged, when, and what to try; "" while it is sound.
// Diverged: a value is not finite, a particle passes a whole support radius in one step, one is
// three times as fast as sound in the fluid, the largest rho/rho0 - 1 is above `squeezed` (not
// judged in the classic formulation, whose densities are arbitrary), or accelerations hold the step
// of the cfl mode below a thousandth of its other limits.
std::string divergence(const Scene&, const Measurement&, double squeezed = 1);

// Watches one run. Now and then it keeps the state; in trouble it goes back to the last good one
// and halves the time step, at most time.retries times until the run has been calm again; then it
// lengthens the step again, unless that has brought the trouble back. A run that meets no trouble
// is never touched: it has the same bits with and without a guard. Everything is counted in steps
// and simulated time, so that a rescued run too has the same bits every time.
class HealthGuard {
public:
    enum class Finding { Sound, WentBack, GaveUp };

    // Both must outlive it. Keeps the start.
    HealthGuard(Simulation&, const Scene&);
    // Instead of the simulation's own apply(): the shortened step stays.
    void apply(const Scene&);
    // Judges what was just measured. WentBack: the simulation stands at an earlier time, and `m` is
    // measured anew. GaveUp: it stands where it failed.
    Finding look(Measurement& m);
    // A state of the run that other code has fetched.
    void keep(RunState);

    // One line for the user about the last look(), "" when there is nothing to say.
    const std::string& said() const { return said_; }
    // After GaveUp: what is to blame, the worst first; those without a finite place with their last
    // one.
    const std::vector<Particle>& culprits() const { return culprits_; }
    const RunState& lastGood() const { return kept_[1].clock.steps == 0 ? kept_[0] : kept_[1]; }
    int retries() const { return allRetries_; }  // in the whole run

private:
    void keepIfDue(const Measurement&);
    void calmDown(const Measurement&);
    void goBack(Measurement&, const std::string& why);
    void giveUp(const Measurement&, const std::string& why);
    void blame(const Measurement&);
    Scene shortened() const;
    bool inTrouble() const { return tries_ > 0; }

    Simulation& simulation_;
    Scene scene_;
    RunState kept_[2];  // the one before and the last; the first try starts from the last, others
                        // from the one before
    int64_t interval_;  // steps between states kept
    double squeezed_;   // the largest rho/rho0 - 1 that is no trouble
    double share_ = 1, most_ = 1;  // of the step as asked for; what it grows to again
    double stepBefore_ = 0;        // s, of the state gone back to
    int tries_ = 0, allRetries_ = 0;
    double troubleTime_ = -1, backTime_ = 0,
           soonAfter_ = -1;  // s simulated; the last: until then longer steps are to blame
    int64_t backSteps_ = 0;
    std::string said_;
    std::vector<Particle> culprits_;
};

}  // namespace spindrift
