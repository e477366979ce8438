#include "scene/check_view.h"

#include "core/error.h"
#include "scene/check_bodies.h"
#include "scene/color_file.h"

#include <fmt/format.h>

namespace spindrift {

void checkView(const Scene& scene) {
    const View& v = scene.view;
    const auto requireAbove = [](const char* path, float most, const char* below, float least) {
        if (!(most > least))
            refuse(path, fmt::format("{} is not above {} {}; make it larger", most, below, least));
    };
    if (v.range == RangeMode::Fixed)
        requireAbove("view.range_max", v.rangeMax, "view.range_min", v.rangeMin);
    if (v.range == RangeMode::Fixed && v.colorScale == ColorScale::Logarithmic && v.rangeMin <= 0)
        refuse("view.range_min", fmt::format("{} has no logarithm; make it larger than 0, or set "
                                             "view.color_scale to linear",
                                             v.rangeMin));
    if (v.threshold.on)
        requireAbove("view.threshold.max", v.threshold.max, "view.threshold.min", v.threshold.min);
    for (int k = 0; k < 3; ++k)
        requireAbove("view.clip.max", v.clip.max[k], "view.clip.min", v.clip.min[k]);
    const bool flat = scene.simulation.dimensions == 2;
    if (flat && (v.slice.axis == Across::X || v.slice.axis == Across::Y))
        refuse("view.slice.axis", "in two dimensions fluid lies across z only; use z");
    if (v.colorBy == ColorBy::TimeBin && scene.time.mode != TimeMode::Local)
        refuse("view.color_by",
               "time_bin is of local steps; set time.mode to local, or colour by "
               "another quantity");
    if (v.colorMap == ColorMap::File && v.colorFile.empty())
        refuse("view.color_file", "is not named; name a table of colours, .csv or .json");
    try {
        if (v.colorMap == ColorMap::File) readColors(v.colorFile);
    } catch (const Error& error) { refuse("view.color_file", error.what()); }
}

}  // namespace spindrift
