#pragma once
// The values of particles that a series can have: what output.fields lists.
#include <string>
#include <vector>

namespace spindrift {

// All there are.
const std::vector<std::string>& fieldNames();
// Those of a list that is separated by commas or blanks, in its order. Throws Error (Scene), one
// line, where there is no such field.
std::vector<std::string> fieldsOf(const std::string& list);

}  // namespace spindrift
