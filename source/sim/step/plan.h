#pragma once
// The passes of a step, in order, and why others are missing. A plan may loop: rows are repeated
// until something holds.
#include "sim/simulation.h"

#include <functional>
#include <string>
#include <vector>

namespace spindrift {

// Whether a row is also run before the first step, so that there is something to see.
enum class Initial : bool { No, Yes };

class Plan {
public:
    struct Row {
        const char* name;
        std::function<void()> run;
        Initial initial;
    };
    // Rows that are run in turn, once or until `until` holds. Where `again` is given, memory of the
    // device, `until` says no more than that it is zero: devices that record steps look themselves.
    struct Stretch {
        std::vector<Row> rows;
        std::function<bool()> until;
        const int* again = nullptr;
    };

    // A row; or `skipped`, the reason why there is none.
    void add(const char* name, std::function<void()> run, Initial initial = Initial::No,
             const char* skipped = "");
    // What is a part of a row, or why it isn't.
    void note(const std::string& name, const char* skipped);
    // Rows from beginLoop() to endLoop() are repeated until `until` holds, which is asked after
    // the last one.
    void beginLoop();
    void endLoop(std::function<bool()> until, const int* again = nullptr);

    const std::vector<Stretch>& stretches() const { return stretches_; }
    // All rows and notes, for people.
    const std::vector<PlanRow>& told() const { return told_; }

private:
    std::vector<Stretch> stretches_{1};
    std::vector<PlanRow> told_;
};

}  // namespace spindrift
