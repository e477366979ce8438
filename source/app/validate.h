#pragma once
#include "app/scene_choice.h"

#include <string>
#include <vector>

namespace spindrift {

struct ValidateOptions {
    std::vector<std::string> cases;      // names; empty = all
    std::vector<int> resolutions;        // empty = the case's own
    std::vector<KnobChoice> choices;     // knobs that differ from the case's scene
    std::string out;                     // folder of JSON and charts, "" = none
    bool quick = false, list = false;
};

// Runs the cases and prints how wrong each is, beside its target. Returns Exit::Different when one is missed. Throws Error.
int validate(const ValidateOptions&);

}  // namespace spindrift
