#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace spindrift {

// Letters to insert, remove, replace or swap with their neighbour to turn a into b.
int editDistance(std::string_view a, std::string_view b);

// The name nearest to `wrong`, or "" when none is near enough to be what was meant.
std::string nearestName(std::string_view wrong, const std::vector<std::string>& names);

// "a, b, c"
std::string listed(const std::vector<std::string>& names, std::string_view separator = ", ");

}  // namespace spindrift
