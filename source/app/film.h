#pragma once
// Pictures as a film, made by ffmpeg beside the run.
#include "core/beside.h"
#include "core/system.h"
#include "render/image.h"

#include <string>

namespace spindrift {

class Film {
public:
    // Pictures of this size, so many a second. Throws Error (Output), before any is drawn, where
    // the file can't be written or there is no ffmpeg.
    Film(const std::string& path, int width, int height, double rate);
    ~Film();
    void add(Image);
    // All of it is in its place then. Throws Error (Output).
    void finish();

private:
    [[noreturn]] void fail(const std::string& why) const;
    std::string path_, unfinished_;
    os::ReadingProgram ffmpeg_;
    bool done_ = false;
    Beside beside_;
};

}  // namespace spindrift
