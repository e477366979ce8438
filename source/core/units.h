#pragma once
// Units as people write them in the header of a table: "g/cm³", "g/cm^3", "kg m-3", "km/h", "µm",
// "MPA".
#include <optional>
#include <string>

namespace spindrift {

// How many of the unit `to` one of `unit` is; none where it is unknown or of another quantity. In
// capitals throughout it may be one of commonUnits(to).
std::optional<double> unitFactor(const std::string& unit, const std::string& to);

// "m, mm, cm": what messages name. Any product of the same base units, with prefixes, is
// understood.
std::string commonUnits(const std::string& to);

}  // namespace spindrift
