#include "app/output_files.h"

#include "core/error.h"
#include "core/output_file.h"
#include "measure/moment_files.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace spindrift {
namespace {

struct OutputFormat {
    std::string Output::*file;
    std::vector<std::string> extensions;
};
const std::vector<OutputFormat>& outputFormats() {
    static const std::vector<OutputFormat> all = {{&Output::screenshot, {"png"}},
                                                  {&Output::csv, {"csv"}},
                                                  {&Output::json, {"json"}},
                                                  {&Output::hdf5, {"h5", "hdf5", "hdf"}},
                                                  {&Output::particles, {"csv", "h5"}},
                                                  {&Output::checkpoint, {"h5", "hdf5", "hdf"}},
                                                  {&Output::video, {"mp4", "mkv", "webm"}},
                                                  {&Output::series, {"pvd", "xdmf", "ply", "csv"}}};
    return all;
}

}  // namespace

void requireOutputs(const Output& output, const Start& start) {
    const std::string source = whereItLeads(start.file);
    std::set<std::string> places;
    for (const OutputFormat& format : outputFormats()) {
        const std::string& file = output.*format.file;
        if (file.empty()) continue;
        // A series without an index is a folder alone.
        if (format.file == &Output::series && !MomentFormat(file).hasIndex()) continue;
        requireFormat(file, format.extensions);
        requireWritable(file);
        const std::string place = whereItLeads(file);
        if (place.empty()) continue;
        if (place == source && !(start.state && format.file == &Output::checkpoint))
            throw Error(Failure::Output,
                        file + ": can't be written: the run is read from it; name another file");
        if (!places.insert(place).second)
            throw Error(Failure::Output,
                        isStandardOutput(file)
                            ? "two outputs both want standard output; give one of them a file"
                            : file + ": two outputs want this file; give each a file of its own");
    }
    if (!output.frames.empty()) requireFolder(output.frames);
}

bool takesStandardOutput(const Output& output) {
    const auto& formats = outputFormats();
    return std::any_of(formats.begin(), formats.end(),
                       [&](const auto& f) { return isStandardOutput(output.*f.file); });
}

}  // namespace spindrift
