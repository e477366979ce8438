#pragma once
#include "app/scene_choice.h"

#include <cstdint>
#include <string>
#include <vector>

namespace spindrift {

struct StressOptions {
    std::string only, out;  // part of a case's name, "random" or "maps"; folder of stability.md,
                            // stability.json and pictures, "" = none
    std::vector<std::string> handled;  // scenes: only they run, handled at random
    std::vector<KnobChoice> choices;   // for them
    double seconds = 10;               // of the clock, for them
    int random = 500;                  // scenes
    uint64_t seed = 1;                 // of the first one
    bool full = false;                 // what takes minutes, and the maps
};

// Torture, random scenes and, when full, maps of what is still stable. Returns Exit::Different when
// a run went wrong and the health guard said nothing. Throws Error.
int stress(const StressOptions&);

}  // namespace spindrift
