#pragma once
// How far a knob can go from its usual value before a scene breaks.
#include "measure/stress.h"

#include <string>
#include <utility>
#include <vector>

namespace spindrift {

// One knob of one formulation in one scene. The interval around the usual value in which all runs
// were sound, its ends by bisection to a tenth of a decade; an end that is the last value tried is
// no limit found.
struct StabilityRow {
    std::string formulation, knob, unit;
    double usual = 0, least = 0, most = 0;  // least and most: tried
    double low = 0, high = 0;               // sound
    bool usualIsSound = false;
    std::vector<std::pair<double, Verdict>> tried;  // in the order of the values
};
struct StabilityMap {
    std::string scene;
    std::vector<StabilityRow> rows;
};

// Names of the scenes: a dam break, the impact of a drop, a still pool, and vortices in a box that
// is full, for the formulation without free surfaces. The classic formulation is in none: its
// density is what the historical files' masses make of it, and no other scene starts at rest.
std::vector<std::string> mapScenes();
// Some hundred short runs without retries of the health guard. `formulation` and `knob`: part of a
// name, "" = all.
StabilityMap stabilityMap(const std::string& scene, const std::string& formulation = "",
                          const std::string& knob = "");

// A bar a row: what was tried, what was sound, the usual value.
std::string svg(const StabilityMap&);

}  // namespace spindrift
