#include "core/output_file.h"

#include "core/error.h"
#include "core/system.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why,
                         const std::string& remedy) {
    throw Error(Failure::Output, (path == "-" ? "standard output" : path) +
                                     ": can't be written: " + why + "; " + remedy);
}
[[noreturn]] void refuseIncomplete(const std::string& path) {
    refuse(path, std::string("it could not be completed (") + std::strerror(errno) + ")",
           "is the disk full? is the reader gone?");
}

// What a path leads to.
struct Target {
    fs::path file;    // no symbolic link
    int number = -1;  // of one that is open already: standard output, /dev/fd/3
    os::FileStatus status{};
    bool exists() const { return status.kind != os::FileKind::Missing; }
    bool streams() const {
        return number >= 0 || (exists() && status.kind != os::FileKind::Regular);
    }
};

Target findTarget(const std::string& path) {
    if (path == "-") return {{}, os::StandardOutput};
    constexpr int MostLinks = 40;
    std::error_code none;
    Target target{path};
    for (int k = 0; k < MostLinks && fs::is_symlink(target.file, none); ++k) {
        // Such a link is written through: the file behind it is open elsewhere, and stays.
        target.number = os::openNumberOf(target.file);
        if (target.number >= 0) return target;
        target.file = target.file.parent_path() / fs::read_symlink(target.file, none);
    }
    target.status = os::statusOf(target.file);
    if (target.status.kind == os::FileKind::Unknown)
        refuse(path, std::strerror(errno), "check the path");
    return target;
}

// The same, refused where it is certain that it can't be written to.
Target targetOf(const std::string& path) {
    const Target target = findTarget(path);
    if (target.number >= 0) {
        if (!os::isOpenForWriting(target.number))
            refuse(path, "it isn't open for writing", "redirect it to a file");
        return target;
    }
    if (path.empty() || target.status.kind == os::FileKind::Folder)
        refuse(path, "it is a folder", "name a file in it");
    if (!target.exists()) return target;
    if (target.status.kind == os::FileKind::Disk) refuse(path, "it is a disk", "name a file on it");
    // Root may write to everything, but who took all rights to write away meant it.
    if (!target.status.mayAnyoneWrite || !os::mayWrite(target.file))
        refuse(path, "it is read-only", "name another file, or give it the right to be written");
    return target;
}

// Beside the target, so that it can be renamed; the name is no longer than a file's may be.
std::string temporaryFor(const Target& target) {
    constexpr size_t Longest = 200;
    const std::string name = target.file.filename().string().substr(0, Longest) + "." +
                             std::to_string(os::processId()) + ".part";
    return (target.file.parent_path() / name).string();
}

void remove(const std::string& file) {
    std::error_code none;
    fs::remove(file, none);
}

// Waits for the reader of a FIFO.
os::OutFile openStream(const std::string& path, const Target& target) {
    if (target.number == os::StandardOutput) std::fflush(stdout);  // what was printed comes first
    os::OutFile file = target.number >= 0 ? os::OutFile::copyOf(target.number)
                                          : os::OutFile::stream(target.file, target.status.kind);
    if (!file) refuse(path, std::strerror(errno), "is there a reader?");
    return file;
}

// A file that can be sought in, as pictures and HDF5 need it, is made first, where temporary files
// are. (HDF5 can't make one in memory under a name of /proc: it follows that to a name that there
// is not.)
void writeThrough(const std::string& path, const Target& target,
                  const std::function<bool(const std::string&)>& write) {
    std::string temporary;
    const os::OutFile made = os::OutFile::temporary(temporary);
    if (!made) refuseIncomplete(path);
    errno = 0;
    const bool written = write(temporary);
    const int why = errno;
    std::ifstream whole(temporary, std::ios::binary);
    remove(temporary);
    errno = why;
    if (!written) refuseIncomplete(path);
    os::OutFile stream = openStream(path, target);
    std::array<char, 1 << 16> block;
    while (whole.read(block.data(), block.size()) || whole.gcount() > 0)
        if (!stream.write(block.data(), size_t(whole.gcount()))) refuseIncomplete(path);
}

}  // namespace

void requireWritable(const std::string& path) {
    const Target target = targetOf(path);
    if (target.streams()) return;
    const std::string temporary = temporaryFor(target);
    if (!os::OutFile::create(temporary))
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    remove(temporary);
}

void requireFormat(const std::string& path, const std::vector<std::string>& own) {
    static const std::vector<std::string> known = {
        "png", "jpg",  "jpeg", "bmp",  "gif", "tif", "tiff", "webp", "svg", "pdf",
        "csv", "json", "h5",   "hdf5", "hdf", "mp4", "avi",  "vtk",  "vtu", "ply"};
    std::string extension = fs::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const auto has = [&](const std::vector<std::string>& list) {
        return std::find(list.begin(), list.end(), extension) != list.end();
    };
    if (has(known) && !has(own))
        refuse(path, "what goes there is no ." + extension + " file",
               "give it a name that ends in ." + own.front());
}

void requireFolder(const std::string& path) {
    std::error_code failed;
    fs::create_directories(path, failed);
    if (failed) refuse(path, failed.message(), "choose a folder that you may write to");
    requireWritable((fs::path(path) / "probe").string());
}

std::string whereItLeads(const std::string& path) {
    const Target target = findTarget(path);
    if (target.number >= 0) return "descriptor " + std::to_string(target.number);
    if (target.status.kind == os::FileKind::Characters) return "";
    std::error_code none;
    return fs::weakly_canonical(fs::absolute(target.file), none).string();
}

bool isStandardOutput(const std::string& path) {
    return !path.empty() && findTarget(path).number == os::StandardOutput;
}

bool isStream(const std::string& path) { return findTarget(path).streams(); }

void replaceFile(const std::string& path,
                 const std::function<bool(const std::string& temporary)>& write) {
    const Target target = targetOf(path);
    if (target.streams()) return writeThrough(path, target, write);
    const std::string temporary = temporaryFor(target);
    errno = 0;
    if (write(temporary) && os::finish(temporary, target.status) &&
        os::moveOver(temporary, target.file))
        return;
    const int why = errno;
    remove(temporary);
    requireWritable(path);  // knows better what is wrong
    errno = why;
    refuseIncomplete(path);
}

void writeText(const std::string& path, const std::string& text) {
    const Target target = targetOf(path);
    if (!target.streams())
        return replaceFile(path, [&](const std::string& temporary) {
            os::OutFile file = os::OutFile::create(temporary);
            return file && file.write(text.data(), text.size());
        });
    if (!openStream(path, target).write(text.data(), text.size())) refuseIncomplete(path);
}

GrowingText::GrowingText(const std::string& path, const std::string& start)
    : path_(path), streams_(targetOf(path).streams()) {
    if (streams_) {
        file_ = openStream(path, targetOf(path));
        append(start);
        return;
    }
    writeText(path, start);
    file_ = os::OutFile::append(targetOf(path).file.string());
    if (!file_)
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    size_ = start.size();
}

void GrowingText::append(const std::string& text) {
    if (!file_.write(text.data(), text.size())) {
        const int why = errno;
        shrink(size_);  // half a line is worse than none
        errno = why;
        refuseIncomplete(path_);
    }
    size_ += text.size();
}

bool GrowingText::shrink(size_t size) {
    if (streams_ || !file_.resize(size)) return false;
    size_ = size;
    return true;
}

}  // namespace spindrift
