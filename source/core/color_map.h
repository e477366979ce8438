#pragma once
namespace spindrift {

// The colour tables; render/color_map.h holds their values.
enum class ColorMap { Viridis, Cividis, Turbo, Coolwarm };

}  // namespace spindrift
