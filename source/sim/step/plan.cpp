#include "sim/step/plan.h"

#include <algorithm>
#include <utility>

namespace spindrift {

void Plan::add(const char* name, std::function<void()> run, Initial initial, const char* skipped) {
    // A pass that is run twice in a step is missing once.
    const bool said = std::any_of(told_.begin(), told_.end(), [&](const PlanRow& row) {
        return row.name == name && !row.skipped.empty();
    });
    if (!said) note(name, skipped);
    if (!*skipped) stretches_.back().rows.push_back({name, std::move(run), initial});
}

void Plan::note(const std::string& name, const char* skipped) { told_.push_back({name, skipped}); }

void Plan::beginLoop() { stretches_.emplace_back(); }

void Plan::endLoop(std::function<bool()> until, const int* again) {
    stretches_.back().until = std::move(until);
    stretches_.back().again = again;
    stretches_.emplace_back();
}

}  // namespace spindrift
