#pragma once
#include "app/scene_choice.h"

#include "measure/validation.h"

#include <string>
#include <vector>

namespace spindrift {

struct ValidateOptions {
    std::vector<std::string> cases;   // names; empty = all
    std::vector<int> resolutions;     // empty = the case's own
    std::vector<KnobChoice> choices;  // knobs that differ from the case's scene
    std::string out;  // folder of validation.json, validation.md and charts, "" = none
    bool quick = false, list = false;
};

// Those of `all` with these names, in their order; all when there are no names. Throws Error
// (Usage).
std::vector<ValidationCase> chooseCases(const std::vector<ValidationCase>& all,
                                        const std::vector<std::string>& names);

// Runs the cases and prints how wrong each is, beside its target. Returns Exit::Different when one
// is missed. Throws Error.
int validate(const ValidateOptions&);

}  // namespace spindrift
