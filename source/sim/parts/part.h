// Features that some scenes have: solids, what floats, elastic objects, surface tension, steps of
// their own for particles. The step asks all parts in turn; a part that a scene does without says
// why, and has no pass run for it. Adding a feature is adding its part to SimulationOn.
#pragma once

#include "sim/run_state.h"
#include "sim/step/plan.h"

#include <tuple>

namespace spindrift::LANES {

// How much of a step's kick a part gives to what it moves, in halves, and whether it moves it.
struct ShareOfStep {
    int halvesOfKick;
    bool drifts;
};

// When in a step energy is looked at: around the mouse's stirring; when forces are known and have
// not moved the fluid yet; when pressures have been solved for; and when rates of density are
// known.
enum class Moment { BeforeStir, Stirred, ForcesKnown, BeforeKick, PressureSolved, BeforeDrift };

// What a part may answer; what it doesn't is nothing.
struct Part {
    // Live knobs may have changed; then, how long a step (s) may be because of all parts.
    void refresh() {}
    void knowLongestStep(double) {}
    double longestStep() const { return 1e9; }
    // From a state; and what it has to give to one.
    void restart(const RunState&) {}
    void save(RunState&) {}
    // Fluid has been put in order; neighbours are looked for; how fast anything is that the time
    // step has to know of, m/s, joins the fluid's extremes.
    void sorted() {}
    void findNeighbours() {}
    void findSpeed() {}
    // The most that anything of it moves at, m/s: what lists have to bear.
    double fastestSpeed() const { return 0; }
    // Bytes that the host holds for it.
    int64_t bytes() const { return 0; }

    // Whether its forces come from the fluid's pressure, so that they follow it where it is solved.
    static constexpr bool feelsPressure = false;

    // Rows of the plan: before anything is looked for, half a step ahead or not; between order and
    // lists; on top of the forces; things that move; what rates of density ask for, by the
    // velocities that forces have led to; what fluid runs into; and what all that does to energy.
    void place(Plan&, Initial, bool /*halfWay*/) {}
    void choose(Plan&, Initial) {}
    void addForces(Plan&, Initial) {}
    void move(Plan&, ShareOfStep) {}
    void addRates(Plan&) {}
    void collide(Plan&) {}
    void weigh(Plan&, Moment) {}
    // Where pressure follows from density, between the two, or after it where it is summed up with
    // it.
    void borrowPressure(Plan&, Initial) {}
    // After accelerations, those by pressure or shifts were found: what doesn't follow them.
    void holdBack(Plan&, Initial) {}
};

// Calls f(part) for each.
template <class Parts, class F> void forEachPart(const Parts& parts, const F& f) {
    std::apply([&](auto&... part) { (f(part), ...); }, parts);
}

}  // namespace spindrift::LANES
