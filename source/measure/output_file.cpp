#include "measure/output_file.h"

#include "core/error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why,
                         const std::string& remedy) {
    throw Error(Exit::Output, fmt::format("{}: can't be written: {}; {}", path, why, remedy));
}

std::string temporaryFor(const std::string& path) {
    return fmt::format("{}.{}.part", path, getpid());
}

// Whether all of the text reached the stream.
bool put(std::FILE* file, const std::string& text) {
    return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

}  // namespace

void requireWritable(const std::string& path) {
    std::error_code ignored;
    if (path.empty() || fs::is_directory(path, ignored))
        refuse(path, "it is a folder", "name a file in it");
    const std::string temporary = temporaryFor(path);
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file)
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    std::fclose(file);
    fs::remove(temporary, ignored);
}

void requireFolder(const std::string& path) {
    std::error_code failed;
    fs::create_directories(path, failed);
    if (failed) refuse(path, failed.message(), "choose a folder that you may write to");
    requireWritable((fs::path(path) / "probe").string());
}

void writeText(const std::string& path, const std::string& text) {
    if (path == "-") {
        if (!put(stdout, text))
            refuse("standard output", std::strerror(errno), "is the reader gone or the disk full?");
        return;
    }
    const std::string temporary = temporaryFor(path);
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file)
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    const bool written = put(file, text);
    std::error_code failed;
    if (std::fclose(file) == 0 && written) {
        fs::rename(temporary, path, failed);
        if (!failed) return;
    }
    fs::remove(temporary, failed);
    refuse(path, "the file could not be completed", "is the disk full?");
}

}  // namespace spindrift
