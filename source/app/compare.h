#pragma once
#include <optional>
#include <string>

namespace spindrift {

struct CompareOptions {
    std::string a, b;  // PNG files
    std::string diff;  // where to write the difference picture; "" = nowhere
    std::optional<double> minSsim;
    std::optional<int> maxDifference;  // of a colour, 0..255
};

// Prints how far two pictures differ. Returns Exit::Different when they are beyond the thresholds,
// with none when they differ at all. Throws Error (Scene, Output).
int compare(const CompareOptions&);

}  // namespace spindrift
