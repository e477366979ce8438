#include "app/film.h"

#include "core/error.h"
#include "core/output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace spindrift {

namespace fs = std::filesystem;

Film::Film(const std::string& path, int width, int height, double rate) : path_(path) {
    std::error_code none;
    const fs::path file = fs::weakly_canonical(path, none);  // what a link leads to
    const std::string kind = file.extension().string();
    if (kind != ".mp4" && kind != ".mkv" && kind != ".webm")
        fail("a film is an .mp4, .mkv or .webm; name one of them");
    requireWritable(path);
    if (isStream(path)) fail("it is no file; name one");
    unfinished_ = (file.parent_path() / fmt::format("{}.{}.part{}", file.stem().string(),
                                                    os::processId(), file.extension().string()))
                      .string();
    std::vector<std::string> command = {
        "ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
        fmt::format("{}x{}", width, height), "-r", fmt::format("{}", rate), "-i", "-",
        // Players want an even number of pixels, and colours at half the resolution.
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"};
    if (kind != ".webm")
        command.insert(command.end(), {"-c:v", "libx264", "-preset", "veryfast", "-crf", "18"});
    command.push_back("file:" + unfinished_);  // whatever its name looks like
    if (!ffmpeg_.start(command))
        fail(errno == ENOENT ? "there is no ffmpeg; install it (apt-get install ffmpeg)"
                             : fmt::format("ffmpeg does not start ({})", std::strerror(errno)));
}

Film::~Film() {
    if (done_) return;
    std::error_code none;
    try {
        beside_.wait();
    } catch (...) {}  // has been told
    ffmpeg_.finish();
    fs::remove(unfinished_, none);
}

void Film::fail(const std::string& why) const {
    throw Error(Failure::Output, fmt::format("{}: can't be made: {}", path_, why));
}

void Film::add(Image image) {
    beside_.add([this, picture = std::make_shared<Image>(std::move(image))] {
        if (!ffmpeg_.write(reinterpret_cast<const char*>(picture->rgb.data()), picture->rgb.size()))
            fail("ffmpeg ended early; what it says is above");
    });
}

void Film::finish() {
    beside_.wait();
    if (const int code = ffmpeg_.finish(); code != 0)
        fail(fmt::format("ffmpeg ended with exit code {}; what it says is above", code));
    replaceFile(path_, [this](const std::string& temporary) {
        std::error_code failed;
        fs::rename(unfinished_, temporary, failed);
        return !failed;
    });
    done_ = true;
}

}  // namespace spindrift
