#pragma once
// Tables of colours of a user's file.
#include <array>
#include <cstdint>
#include <string>

namespace spindrift {

// 256 colours from one end of the scale to the other, red, green and blue as shown (sRGB), with
// straight lines between those of the file. A CSV has columns r, g, b and, where colours are not
// evenly spread, at; a JSON file is a list of [r, g, b] or a colour map as ParaView exports it,
// with RGBPoints. Where a number is above 1, colours go from 0 to 255. Throws Error (Scene) when
// the file is missing or is no such table.
std::array<std::array<uint8_t, 3>, 256> readColors(const std::string& path);

}  // namespace spindrift
