#pragma once
// Moments of a run that it can go back to, look at and go on from: whole states in memory, as many
// as a budget allows, evenly over all of the run. Knows no simulation, no window and no clock.
#include "scene/scene.h"
#include "sim/run_state.h"
#include "sim/simulation.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace spindrift {

// What was so then. The state is without the places of walls, which are those of all moments.
struct Moment {
    RunState state;
    Measurement measurement;
    std::shared_ptr<const Scene> asked, inForce;  // knobs as they were wanted; as the run had them
    double time() const { return state.clock.time; }
};

// Who keeps a moment lets the run go on from it (Simulation::restart), as with a checkpoint, and
// does so again at the same steps when it comes there another time: then the same bits follow.
class History {
public:
    // MB from now on; what is more goes at once, and with 0 all of it.
    void setBudget(double megabytes);
    bool isOn() const { return budget_ > 0; }
    // Two moments are more than the budget: nothing is kept.
    bool isTooSmall() const { return isTooSmall_; }

    // So many seconds of the clock have passed while the run was on its way.
    void passed(double seconds) { passed_ += seconds; }
    // Whether to keep where the run stands now: enough time has passed for what that costs, and as
    // much of the run as between two others; or it was done at this step before.
    bool isDue(double time, int64_t steps) const;
    // Whether that is nearer to the last moment than moments are after thinning: where it was done
    // before it is done again, but not kept.
    bool isNearTheLast(double time) const {
        return !empty() && time < back().time() + 0.75 * interval_;
    }
    // Until a step at which it was done before; `never`: none is ahead.
    int64_t stepsToNext(int64_t steps) const;
    static constexpr int64_t never = std::numeric_limits<int64_t>::max();

    // Keeps the state; to fetch it, and to go on from it, took so many seconds. Every second moment
    // goes where the budget is spent, the first and the last ones stay.
    void add(RunState, const Measurement&, const Scene& asked, const Scene& inForce, double cost);
    // The run goes on from an earlier time, s: forgets the moments after it.
    void dropAfter(double time);
    void clear();

    size_t size() const { return moments_.size(); }
    bool empty() const { return moments_.empty(); }
    const Moment& operator[](size_t i) const { return moments_[i]; }
    const Moment& back() const { return moments_.back(); }
    // As the simulation gave it.
    RunState state(size_t i) const;
    // The moment that is nearest to a time, s; 0 of an empty history.
    size_t at(double time) const;
    int64_t bytes() const { return bytes_; }
    // Of the run's time at most goes into keeping.
    static constexpr double share = 0.02;

private:
    void thin();
    void count();

    std::vector<Moment> moments_;
    std::vector<Vec3> walls_;
    std::vector<int64_t> keptAt_;   // steps, of all that were ever kept, in rising order
    double budget_ = 0;             // bytes
    int64_t bytes_ = 0;             // of all that is kept
    double interval_ = 0;           // s simulated, between moments at least
    double passed_ = 0, cost_ = 0;  // s, since the last was kept; that it took
    bool isTooSmall_ = false;
};

}  // namespace spindrift
