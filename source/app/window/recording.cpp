#include "app/window/recording.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

namespace spindrift {

namespace {

// Without an extension.
std::string freePath(const std::string& sceneName, const std::string& folder) {
    for (int i = 1;; ++i) {
        const std::string path =
            (std::filesystem::absolute(folder) / fmt::format("{}-{:03}", fileStem(sceneName), i))
                .lexically_normal()
                .string();
        if (!std::filesystem::exists(path + ".mp4") && !std::filesystem::exists(path + ".csv"))
            return path;
    }
}

Output csvInto(const std::string& path) {
    Output output;
    output.csv = path;
    return output;
}

}  // namespace

std::string fileStem(const std::string& sceneName) {
    std::string stem;
    for (const char c : sceneName) {
        const bool isPlain = std::isalnum(static_cast<unsigned char>(c)) || (c & 0x80) || c == '-';
        if (isPlain)
            stem += c;
        else if (!stem.empty() && stem.back() != '_')
            stem += '_';
    }
    while (stem.ends_with('_')) stem.pop_back();
    // Not within a letter of several bytes.
    size_t length = std::min<size_t>(stem.size(), 100);
    while (length < stem.size() && (stem[length] & 0xc0) == 0x80) --length;
    return stem.empty() ? "run" : stem.substr(0, length);
}

Recording::Recording(const Scene& scene, double time, int width, int height,
                     const std::string& folder)
    : film_(freePath(scene.name, folder) + ".mp4"),
      series_(std::filesystem::path(film_).replace_extension(".csv").string()),
      probes_(scene),
      rows_(csvInto(series_), probes_.columns(), {}, nullptr),
      rate_(std::min(60.0, double(scene.output.fps))),
      rowEvery_(scene.output.sampleEvery > 0 ? double(scene.output.sampleEvery)
                                             : 1 / double(scene.output.fps)),
      now_(time),
      nextPicture_(time),
      nextRow_(time),
      width_(width),
      height_(height),
      pictureFile_(film_, width, height, rate_) {
    requireWritable(series_);
}

void Recording::follow(Simulation& simulation, const Measurement& m,
                       const std::vector<Remark>& remarks) {
    if (m.time < now_) {
        rows_.dropAfter(m.time);
        nextPicture_ = nextRow_ = m.time;
    }
    now_ = m.time;
    for (const Remark& r : remarks) rows_.remark(r.time, r.text);
    if (!isReached(nextRow_, m.time) || m.time == rows_.lastTime()) return;
    rows_.add(m, {},
              probes_.any() ? probes_.read(simulation.particles(), probes_.looksPastSolids()
                                                                       ? simulation.solidPoses()
                                                                       : std::vector<SolidPose>())
                            : std::vector<double>());
    nextRow_ = multipleAfter(m.time, rowEvery_);
}

void Recording::add(const Image& image, double speed) {
    for (; wantsPicture(); nextPicture_ += speed / rate_, ++pictures_) pictureFile_.add(image);
}

void Recording::finish() {
    rows_.finish();
    pictureFile_.finish();
}

}  // namespace spindrift
