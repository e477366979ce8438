#pragma once
#include <cstdint>

namespace spindrift {

// One row of the plan: a pass's name, and the time that its measured runs took.
struct PassTime { const char* name; double ms; int64_t runs; };

}  // namespace spindrift
