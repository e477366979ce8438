#pragma once
namespace spindrift {

// The colour tables; render/color_map.h holds their values, but for that of a file.
enum class ColorMap { Viridis, Cividis, Turbo, Coolwarm, File };
// What pictures and panel stand on.
enum class Theme { Dark, Light };

}  // namespace spindrift
