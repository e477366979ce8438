#include "app/exit_code.h"
#include "app/compare.h"

#include "core/error.h"
#include "core/output_file.h"
#include "render/image_compare.h"

#include <fmt/format.h>

namespace spindrift {

int compare(const CompareOptions& options) {
    if (!options.diff.empty()) requireFormat(options.diff, {"png"}), requireWritable(options.diff);
    const Image a = readPng(options.a), b = readPng(options.b);
    if (a.width != b.width || a.height != b.height) {
        fmt::print("sizes differ: {} x {} and {} x {}\n", a.width, a.height, b.width, b.height);
        return int(Exit::Different);
    }
    const ImageDifference difference = compareImages(a, b);
    fmt::print("SSIM {:.6f}, largest difference {} of 255, {} of {} pixels differ\n",
               difference.ssim, difference.largest, difference.pixels, int64_t(a.width) * a.height);
    if (!options.diff.empty()) writePng(options.diff, differencePicture(a, b));

    const bool noThreshold = !options.minSsim && !options.maxDifference;
    const bool beyond = (options.minSsim && difference.ssim < *options.minSsim) ||
                        (options.maxDifference && difference.largest > *options.maxDifference) ||
                        (noThreshold && difference.pixels > 0);
    return int(beyond ? Exit::Different : Exit::Ok);
}

}  // namespace spindrift
