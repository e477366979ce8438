// Runs a plan, measures its rows, and on devices that can records it and replays what it recorded.
#pragma once

#include "core/pass_time.h"
#include "sim/particles/particle_set.h"
#include "sim/step/plan.h"

#include <array>
#include <deque>
#include <string_view>
#include <utility>
#include <vector>

namespace spindrift::LANES {

template <class Device> class StepRunner {
public:
    // `sorted`: the sets of particles that rows put in order, each time from one side of their
    // buffers to the other. Not owned.
    StepRunner(Device& device, std::vector<ParticleSet<Device>*> sorted)
        : device_(device), sorted_(std::move(sorted)) {}

    // Times of rows survive a change of plan.
    void take(Plan plan) {
        plan_ = std::move(plan);
        recordings_.resize(plan_.stretches().size());
        outdateRecordings();
    }
    // Parameters or buffers have changed.
    void outdateRecordings() {
        for (Recordings& stretch : recordings_)
            for (Recorded& r : stretch) r.recording.outdate();
    }

    void runInitial() {
        for (const Plan::Stretch& stretch : plan_.stretches())
            for (const Plan::Row& row : stretch.rows)
                if (row.initial == Initial::Yes) row.run();
    }
    // One step. Where steps are recorded it is measured once after resetTimes(), otherwise always.
    void run() {
        const bool measured = std::exchange(measureNext_, !Device::recordsSteps);
        for (size_t k = 0; k < plan_.stretches().size(); ++k) {
            const Plan::Stretch& stretch = plan_.stretches()[k];
            if (stretch.rows.empty()) continue;
            const bool loops = stretch.until && (measured || !stretch.again);
            do measured ? measure(stretch) : replay(stretch, recordings_[k]);
            while (loops && !stretch.until());
        }
    }

    const Plan& plan() const { return plan_; }
    std::vector<PassTime> times() {
        device_.collectTimes();
        std::vector<PassTime> rows;
        for (const PassTime& t : times_)
            if (t.runs > 0) rows.push_back(t);
        return rows;
    }
    void resetTimes() {
        device_.collectTimes();
        for (PassTime& t : times_) t.ms = 0, t.runs = 0;
        measureNext_ = true;
    }

private:
    // What holds for one combination of sides, and the sides that it ends with.
    struct Recorded {
        typename Device::Recording recording;
        unsigned sidesAfter = 0;
    };
    static constexpr size_t mostSorted = 3;
    using Recordings = std::array<Recorded, 1u << mostSorted>;

    void measure(const Plan::Stretch& stretch) {
        for (const Plan::Row& row : stretch.rows) device_.timed(timeOf(row.name), row.run);
    }
    void replay(const Plan::Stretch& stretch, Recordings& recordings) {
        if constexpr (Device::recordsSteps) {
            Recorded& own = recordings[sides()];
            if (device_.replay(own.recording)) return setSides(own.sidesAfter);
            const unsigned before = sides();
            const auto rows = [&] {
                for (const Plan::Row& row : stretch.rows) row.run();
            };
            device_.record(own.recording,
                           [&] { stretch.again ? device_.repeat(stretch.again, rows) : rows(); });
            own.sidesAfter = sides();
            CHECK(!stretch.again || own.sidesAfter == before);  // how often it ran is not known
        }
    }
    unsigned sides() const {
        CHECK(sorted_.size() <= mostSorted);
        unsigned bits = 0;
        for (const ParticleSet<Device>* set : sorted_) bits = 2 * bits + unsigned(set->side());
        return bits;
    }
    // A replay sorts on the device; that the sides of buffers change is the host's work.
    void setSides(unsigned bits) {
        for (size_t k = sorted_.size(); k-- > 0; bits /= 2)
            if (unsigned(sorted_[k]->side()) != bits % 2) sorted_[k]->flip();
    }
    PassTime* timeOf(std::string_view name) {
        for (PassTime& t : times_)
            if (t.name == name) return &t;
        return &times_.emplace_back(PassTime{name.data(), 0, 0});
    }

    Device& device_;
    std::vector<ParticleSet<Device>*> sorted_;
    Plan plan_;
    std::deque<PassTime> times_;  // measurements under way point into it
    std::deque<Recordings> recordings_;
    bool measureNext_ = true;
};

}  // namespace spindrift::LANES
