#pragma once
// The values of the colour tables.
#include "core/color_map.h"

#include <array>
#include <cstdint>

namespace spindrift {

inline constexpr int colorMapCount = 4;
using ColorTable = std::array<std::array<uint8_t, 3>, 256>;  // RGB as shown (sRGB)

ColorTable colorTable(ColorMap);
const char* colorMapName(ColorMap);

}  // namespace spindrift
