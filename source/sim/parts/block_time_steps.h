// Steps of their own for particles, on one device: which are active, and their part of the plan.
#pragma once

#include "sim/parts/block_time_step_passes.h"
#include "sim/step/flow.h"
#include "sim/parts/part.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

template <class Device> class BlockTimeSteps : public Part {
public:
    explicit BlockTimeSteps(Flow<Device>& flow) : flow_(flow), device_(flow.device) {}

    // A GPU would put all particles in order at each moment, and ask whether the step is over
    // (whyNotForGpus).
    bool areOn() const { return !Device::recordsSteps && flow_.scene.time.mode == TimeMode::Local; }
    // All particles take part again, from the beginning of a step.
    void wake() {
        if (!areOn()) return;
        device_.forEach(blocks(), WakeBlocks{flow_.blocks});
        StepState clock = flow_.readClock();
        clock.allActive = clock.allRest = false, clock.awake = 1;
        flow_.setClock(clock);
        device_.forEach(flow_.fluid.slots(), WakeParticles{flow_.fluid.view()});
    }
    // Where all rest there is nothing to be done but to let time pass; says whether it did.
    bool letTimePass() {
        if (!areOn() || !flow_.readClock().allRest) return false;
        beginStep();
        device_.forEach(1, ChooseSubstep{flow_.view(), motion_.data(), flow_.fluidCount});
        return true;
    }
    bool atStepEnd() const { return flow_.readClock().substep == 0; }
    // What lists want to know; without them a recorded step could not ask.
    double shareAwake() const {
        return NeighbourSearch<Device>::keepsLists && areOn() ? flow_.readClock().awake : 1;
    }

    // --- as a part (part.h) ---

    void refresh() {
        flow_.fluid.stepInBlocks(areOn());
        flow_.walls.stepInBlocks(areOn());
        if (areOn() && speed2_.size() == 0) makeBlocks();
        flow_.allActive = flow_.allActive && areOn();
    }
    // Of particles that are not active, as the order is another one.
    void sorted() {
        if (areOn()) flow_.template onFluid<ApplyEquationOfState>();
    }
    void choose(Plan& plan, Initial initial) {
        plan.add(
            "rest", [this] { findResting(); }, initial,
            !areOn()                           ? allAlike
            : flow_.model.shared.restSpeed > 0 ? ""
                                               : "nothing rests (time.rest_speed)");
        plan.add(
            "active", [this] { findActive(); }, initial, areOn() ? "" : allAlike);
    }

    // Rows of the plan that others have not.
    void begin(Plan& plan) {
        plan.add("step", [this] { beginStep(); });
    }
    void kick(Plan& plan) {
        plan.add("kick", [this] { flow_.template onFluid<KickActive>(); });
    }
    void chooseSubstep(Plan& plan) {
        plan.add("substep", [this] { findSubstep(); });
    }

private:
    static constexpr const char* allAlike = "all take the same steps (time.mode)";

    // Blocks are whole cells and no smaller than what neighbours lie apart: these lie in blocks
    // that touch.
    void makeBlocks() {
        const Grid& grid = flow_.search.grid();
        const real reach = real(2 * supportRadius(flow_.scene) * (1 + flow_.scene.compute.skin));
        auto along = [&](int cells, real perMetre) {
            return std::clamp(int(std::ceil(double(reach * perMetre))), 1, cells);
        };
        Blocks& b = flow_.blocks;
        b.size = {along(grid.cells.x, grid.perMetre.x), along(grid.cells.y, grid.perMetre.y),
                  along(grid.cells.z, grid.perMetre.z)};
        b.count = {grid.cells.x / b.size.x, grid.cells.y / b.size.y, grid.cells.z / b.size.z};
        const size_t n = size_t(b.count.x) * size_t(b.count.y) * size_t(b.count.z);
        speed2_.resize(n), calm_.resize(n), sleepLength_.resize(n), active_.resize(n),
            near_.resize(n), motion_.resize(1);
        b.speed2 = speed2_.data(), b.calm = calm_.data(), b.sleepLength = sleepLength_.data();
        b.active = active_.data(), b.near = near_.data();
        device_.forEach(blocks(), WakeBlocks{b});
    }
    int blocks() const {
        return flow_.blocks.count.x * flow_.blocks.count.y * flow_.blocks.count.z;
    }
    void beginStep() { device_.forEach(1, BeginStep{flow_.view()}); }
    void findResting() {
        device_.forEach(blocks(), MeasureBlocks{flow_.view()});
        device_.forEach(blocks(), RestBlocks{flow_.view()});
    }
    void findActive() {
        flow_.allActive = flow_.readClock().allActive;
        if (flow_.allActive) return;
        const View v = flow_.view();
        device_.forEach(v.fluid.slots / clusterSize, FindActiveClusters{v});
        device_.forEach(blocks(), FindActiveBlocks{v});
        device_.forEach(v.walls.slots / clusterSize, ClearActive{v.walls});
        device_.forEach(blocks(), FindNearBlocks{v});
        device_.forEach(blocks(), SpreadActive{v});
    }
    void findSubstep() {
        device_.reduce(flow_.fluid.slots(), FindMotion{flow_.fluid.view(), flow_.clock.data()},
                       motion_.data());
        device_.forEach(1, ChooseSubstep{flow_.view(), motion_.data(), flow_.fluidCount});
        if constexpr (NeighbourSearch<Device>::keepsLists) {
            const StepState& clock = *flow_.clock.data();
            flow_.search.movedAtMost(
                clock.dt * std::max({clock.speed, flow_.stir.speed(), flow_.fastestPart()}));
        }
    }

    Flow<Device>& flow_;
    Device& device_;
    Buffer<real, Device> speed2_{device_};
    Buffer<int, Device> calm_{device_}, sleepLength_{device_};
    Buffer<uint8_t, Device> active_{device_}, near_{device_};
    Buffer<Motion, Device> motion_{device_};
};

}  // namespace spindrift::LANES
