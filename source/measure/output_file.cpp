#include "measure/output_file.h"

#include "core/error.h"
#include "scene/particle_file.h"

#include <fmt/format.h>
#include <fcntl.h>
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

// Whether the file's contents have reached the disk, so that a rename can't come before them.
bool flushed(const std::string& path) {
    const int file = open(path.c_str(), O_RDONLY);
    const bool done = file >= 0 && fsync(file) == 0;
    if (file >= 0) close(file);
    return done;
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

void replaceFile(const std::string& path, const std::function<bool(const std::string& temporary)>& write) {
    const std::string temporary = temporaryFor(path);
    std::error_code failed;
    if (write(temporary) && flushed(temporary)) {
        fs::rename(temporary, path, failed);
        if (!failed) return;
    }
    fs::remove(temporary, failed);
    refuse(path, "the file could not be completed", "is the disk full?");
}

void writeText(const std::string& path, const std::string& text) {
    if (path == "-") {
        if (!put(stdout, text))
            refuse("standard output", std::strerror(errno), "is the reader gone or the disk full?");
        return;
    }
    requireWritable(path);
    replaceFile(path, [&](const std::string& temporary) {
        std::FILE* file = std::fopen(temporary.c_str(), "wb");
        if (!file) return false;
        const bool written = put(file, text);
        return std::fclose(file) == 0 && written;
    });
}

void saveParticles(const std::string& path, const std::vector<Particle>& particles) {
    ParticleTable table;
    for (const Particle& p : particles) {
        table.positions.push_back(p.position), table.velocities.push_back(p.velocity);
        table.densities.push_back(p.density), table.pressures.push_back(p.pressure);
    }
    requireWritable(path);
    replaceFile(path, [&](const std::string& temporary) { return writeParticles(temporary, path.ends_with(".h5"), table); });
}

}  // namespace spindrift
