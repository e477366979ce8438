#include "core/output_file.h"

#include "core/error.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why,
                         const std::string& remedy) {
    throw Error(Exit::Output, (path == "-" ? "standard output" : path) +
                                  ": can't be written: " + why + "; " + remedy);
}
[[noreturn]] void refuseIncomplete(const std::string& path) {
    refuse(path, std::string("it could not be completed (") + std::strerror(errno) + ")",
           "is the disk full? is the reader gone?");
}

// A file descriptor that is closed.
struct Descriptor {
    int number;
    explicit Descriptor(int n) : number(n) {}
    ~Descriptor() {
        if (number >= 0) close(number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int release() { return std::exchange(number, -1); }
};

// What a path leads to.
struct Target {
    fs::path file;        // no symbolic link
    int descriptor = -1;  // one that is open already: standard output, /dev/fd/3
    bool exists = false;
    struct stat status {};
    bool streams() const { return descriptor >= 0 || (exists && !S_ISREG(status.st_mode)); }
};

// The number of a link such as /dev/fd/3, -1 of any other. To follow it would replace the file that
// somebody else has opened.
int descriptorOf(const fs::path& link) {
    std::error_code none;
    const std::string name = link.filename().string();
    int number = -1;
    const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (failed != std::errc() || end != name.data() + name.size()) return -1;
    return fs::canonical(link.parent_path(), none) == fs::canonical("/proc/self/fd", none) ? number
                                                                                           : -1;
}

Target findTarget(const std::string& path) {
    if (path == "-") return {{}, STDOUT_FILENO};
    constexpr int MostLinks = 40;
    std::error_code none;
    Target target{path};
    for (int k = 0; k < MostLinks && fs::is_symlink(target.file, none); ++k) {
        target.descriptor = descriptorOf(target.file);
        if (target.descriptor >= 0) return target;
        target.file = target.file.parent_path() / fs::read_symlink(target.file, none);
    }
    target.exists = stat(target.file.c_str(), &target.status) == 0;
    if (!target.exists && errno != ENOENT) refuse(path, std::strerror(errno), "check the path");
    return target;
}

// The same, refused where it is certain that it can't be written to.
Target targetOf(const std::string& path) {
    const Target target = findTarget(path);
    const mode_t mode = target.status.st_mode;
    if (target.descriptor >= 0) {
        const int flags = fcntl(target.descriptor, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
            refuse(path, "it isn't open for writing", "redirect it to a file");
        return target;
    }
    if (path.empty() || (target.exists && S_ISDIR(mode)))
        refuse(path, "it is a folder", "name a file in it");
    if (!target.exists) return target;
    if (S_ISBLK(mode)) refuse(path, "it is a disk", "name a file on it");
    // Root may write to everything, but who took all rights to write away meant it.
    if ((mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0 || access(target.file.c_str(), W_OK) != 0)
        refuse(path, "it is read-only", "name another file, or give it the right to be written");
    return target;
}

// Beside the target, so that it can be renamed; the name is no longer than a file's may be.
std::string temporaryFor(const Target& target) {
    constexpr size_t Longest = 200;
    const std::string name = target.file.filename().string().substr(0, Longest) + "." +
                             std::to_string(getpid()) + ".part";
    return (target.file.parent_path() / name).string();
}

// Whether the file's contents have reached the disk, so that a rename can't come before them. It
// gets the owner and the rights of the one that it replaces.
bool finished(const std::string& temporary, const Target& target) {
    const Descriptor file(open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number < 0) return false;
    if (target.exists) {
        // A file that was another user's becomes one's own where the system forbids to give it
        // away.
        [[maybe_unused]] const int given =
            fchown(file.number, target.status.st_uid, target.status.st_gid);
        fchmod(file.number, target.status.st_mode & 07777);
    }
    return fsync(file.number) == 0;
}

bool put(int file, const char* data, size_t size) {
    while (size > 0) {
        const ssize_t n = write(file, data, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        data += n, size -= size_t(n);
    }
    return true;
}

int connectTo(const fs::path& socketFile) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (socketFile.string().size() >= sizeof address.sun_path) return errno = ENAMETOOLONG, -1;
    std::strcpy(address.sun_path, socketFile.c_str());
    Descriptor connection(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (connection.number < 0 ||
        connect(connection.number, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
        return -1;
    return connection.release();
}

// Waits for the reader of a FIFO.
int openStream(const std::string& path, const Target& target) {
    if (target.descriptor == STDOUT_FILENO) std::fflush(stdout);  // what was printed comes first
    int file = -1;
    do {
        if (target.descriptor >= 0)
            file = fcntl(target.descriptor, F_DUPFD_CLOEXEC, 0);
        else if (S_ISSOCK(target.status.st_mode))
            file = connectTo(target.file);
        else
            file = open(target.file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    } while (file < 0 && errno == EINTR);
    if (file < 0) refuse(path, std::strerror(errno), "is there a reader?");
    return file;
}

// A file that can be sought in, as pictures and HDF5 need it, is made first, where temporary files
// are. (HDF5 can't make one in memory under a name of /proc: it follows that to a name that there
// is not.)
void writeThrough(const std::string& path, const Target& target,
                  const std::function<bool(const std::string&)>& write) {
    std::error_code none;
    std::string temporary = (fs::temp_directory_path(none) / "spindrift-XXXXXX").string();
    const Descriptor whole(mkostemp(temporary.data(), O_CLOEXEC));
    errno = whole.number < 0 ? errno : 0;
    const bool written = whole.number >= 0 && write(temporary);
    const int why = errno;
    if (whole.number >= 0) unlink(temporary.c_str());
    errno = why;
    if (!written) refuseIncomplete(path);
    const Descriptor stream(openStream(path, target));
    std::array<char, 1 << 16> block;
    off_t at = 0;
    for (ssize_t n; (n = pread(whole.number, block.data(), block.size(), at)) > 0; at += n)
        if (!put(stream.number, block.data(), size_t(n))) refuseIncomplete(path);
}

bool writeWhole(const std::string& file, const std::string& text) {
    const Descriptor out(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    return out.number >= 0 && put(out.number, text.data(), text.size());
}

}  // namespace

void requireWritable(const std::string& path) {
    const Target target = targetOf(path);
    if (target.streams()) return;
    const std::string temporary = temporaryFor(target);
    const Descriptor file(open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (file.number < 0)
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    unlink(temporary.c_str());
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
    if (target.descriptor >= 0) return "descriptor " + std::to_string(target.descriptor);
    if (target.exists && S_ISCHR(target.status.st_mode)) return "";
    std::error_code none;
    return fs::weakly_canonical(fs::absolute(target.file), none).string();
}

bool isStandardOutput(const std::string& path) {
    return !path.empty() && findTarget(path).descriptor == STDOUT_FILENO;
}

bool isStream(const std::string& path) { return findTarget(path).streams(); }

void replaceFile(const std::string& path,
                 const std::function<bool(const std::string& temporary)>& write) {
    const Target target = targetOf(path);
    if (target.streams()) return writeThrough(path, target, write);
    const std::string temporary = temporaryFor(target);
    errno = 0;
    if (write(temporary) && finished(temporary, target) &&
        rename(temporary.c_str(), target.file.c_str()) == 0)
        return;
    const int why = errno;
    unlink(temporary.c_str());
    requireWritable(path);  // knows better what is wrong
    errno = why;
    refuseIncomplete(path);
}

void writeText(const std::string& path, const std::string& text) {
    const Target target = targetOf(path);
    if (!target.streams())
        return replaceFile(
            path, [&](const std::string& temporary) { return writeWhole(temporary, text); });
    const Descriptor stream(openStream(path, target));
    if (!put(stream.number, text.data(), text.size())) refuseIncomplete(path);
}

GrowingText::GrowingText(const std::string& path, const std::string& start)
    : path_(path), streams_(targetOf(path).streams()) {
    if (streams_) {
        file_ = openStream(path, targetOf(path));
        append(start);
        return;
    }
    writeText(path, start);
    file_ = open(targetOf(path).file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (file_ < 0)
        refuse(path, std::strerror(errno), "choose a folder that exists and that you may write to");
    size_ = start.size();
}

GrowingText::~GrowingText() { close(file_); }

void GrowingText::append(const std::string& text) {
    if (!put(file_, text.data(), text.size())) {
        const int why = errno;
        shrink(size_);  // half a line is worse than none
        errno = why;
        refuseIncomplete(path_);
    }
    size_ += text.size();
}

bool GrowingText::shrink(size_t size) {
    if (streams_ || ftruncate(file_, off_t(size)) != 0) return false;
    size_ = size;
    return true;
}

}  // namespace spindrift
