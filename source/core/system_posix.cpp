#include "core/system.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace spindrift::os {

namespace fs = std::filesystem;

int processId() { return getpid(); }

bool errorsGoToTerminal() { return isatty(STDERR_FILENO); }

// By its path, so that the program keeps its name.
void restartWith(const char* variable, const char* value, char** arguments) {
    setenv(variable, value, 0);
    std::error_code none;
    const fs::path self = fs::read_symlink("/proc/self/exe", none);
    if (!none) execv(self.c_str(), arguments);
}

void becomeNeighbour(const char* name, char** arguments) {
    std::error_code none;
    const fs::path self = fs::read_symlink("/proc/self/exe", none);
    if (!none) execv((self.parent_path() / name).c_str(), arguments);
}

namespace {
volatile std::sig_atomic_t stopSignal = 0;
std::array<struct sigaction, 3> before;
constexpr int Signals[3] = {SIGINT, SIGTERM, SIGPIPE};
}  // namespace

StopSignals::StopSignals() {
    stopSignal = 0;
    struct sigaction action {};
    action.sa_flags = int(SA_RESETHAND);
    for (size_t k = 0; k < 3; ++k) {
        if (Signals[k] == SIGPIPE)
            action.sa_handler = SIG_IGN;
        else
            action.sa_handler = [](int signal) { stopSignal = signal; };
        sigaction(Signals[k], &action, &before[k]);
    }
}
StopSignals::~StopSignals() {
    for (size_t k = 0; k < 3; ++k) sigaction(Signals[k], &before[k], nullptr);
}
int StopSignals::received() { return stopSignal; }

int64_t freeMemory() {
    int64_t available = int64_t(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
    std::ifstream meminfo("/proc/meminfo");
    for (std::string key, unit; meminfo >> key;) {
        int64_t kib = 0;
        if (meminfo >> kib && key == "MemAvailable:") available = std::min(available, kib * 1024);
        std::getline(meminfo, unit);
    }
    std::ifstream limitFile("/sys/fs/cgroup/memory.max"), usedFile("/sys/fs/cgroup/memory.current");
    int64_t limit = 0, used = 0;  // "max" is no number: no limit
    if (limitFile >> limit && usedFile >> used)
        available = std::min(available, std::max<int64_t>(0, limit - used));
    return available;
}

std::string processorName() {
    std::ifstream cpus("/proc/cpuinfo");
    for (std::string line; std::getline(cpus, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

void wishLargePages(void* memory, size_t bytes) { madvise(memory, bytes, MADV_HUGEPAGE); }

static FileKind kindOf(mode_t mode) {
    return S_ISREG(mode)    ? FileKind::Regular
           : S_ISDIR(mode)  ? FileKind::Folder
           : S_ISBLK(mode)  ? FileKind::Disk
           : S_ISCHR(mode)  ? FileKind::Characters
           : S_ISFIFO(mode) ? FileKind::Pipe
           : S_ISSOCK(mode) ? FileKind::Socket
                            : FileKind::Unknown;
}
FileStatus statusOf(const fs::path& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0)
        return {errno == ENOENT ? FileKind::Missing : FileKind::Unknown};
    return {kindOf(status.st_mode), (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) != 0,
            status.st_uid, status.st_gid, status.st_mode & 07777};
}
bool mayWrite(const fs::path& path) { return access(path.c_str(), W_OK) == 0; }

int openNumberOf(const fs::path& link) {
    std::error_code none;
    const std::string name = link.filename().string();
    int number = -1;
    const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (failed != std::errc() || end != name.data() + name.size()) return -1;
    return fs::canonical(link.parent_path(), none) == fs::canonical("/proc/self/fd", none) ? number
                                                                                           : -1;
}
bool isOpenForWriting(int number) {
    const int flags = fcntl(number, F_GETFL);
    return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

template <class Open> static int again(const Open& open) {
    int file = -1;
    do file = open();
    while (file < 0 && errno == EINTR);
    return file;
}
OutFile OutFile::create(const std::string& path) {
    return OutFile(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
}
OutFile OutFile::append(const std::string& path) {
    return OutFile(open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
}
OutFile OutFile::copyOf(int number) {
    return OutFile(again([&] { return fcntl(number, F_DUPFD_CLOEXEC, 0); }));
}
static int connectTo(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.string().size() >= sizeof address.sun_path) return errno = ENAMETOOLONG, -1;
    std::strcpy(address.sun_path, path.c_str());
    const int connection = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection < 0 ||
        connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
        return connection;
    const int why = errno;
    close(connection);
    return errno = why, -1;
}
OutFile OutFile::stream(const fs::path& path, FileKind kind) {
    return OutFile(again([&] {
        return kind == FileKind::Socket ? connectTo(path)
                                        : open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    }));
}
OutFile OutFile::temporary(std::string& path) {
    std::error_code none;
    path = (fs::temp_directory_path(none) / "spindrift-XXXXXX").string();
    return OutFile(mkostemp(path.data(), O_CLOEXEC));
}
bool OutFile::write(const char* data, size_t size) {
    while (size > 0) {
        const ssize_t n = ::write(int(handle_), data, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        data += n, size -= size_t(n);
    }
    return true;
}
bool OutFile::resize(size_t size) { return ftruncate(int(handle_), off_t(size)) == 0; }
void OutFile::close() {
    if (handle_ != None) ::close(int(handle_));
    handle_ = None;
}

bool ReadingProgram::start(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
    arguments.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return false;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
    pid_t id = 0;
    const int failed = posix_spawnp(&id, arguments[0], &files, &how, arguments.data(), environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    close(ends[0]);
    input_ = OutFile(ends[1]);
    if (failed) input_ = OutFile(), errno = failed;
    id_ = failed ? 0 : id;
    return !failed;
}
int ReadingProgram::finish() {
    input_ = OutFile();
    if (id_ == 0) return -1;
    int status = -1;
    const int ended = again([&] { return waitpid(id_, &status, 0); });
    id_ = 0;
    return ended > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool finish(const std::string& path, const FileStatus& replaced) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    if (replaced.kind != FileKind::Missing) {
        // A file that was another user's becomes one's own where the system forbids to give it
        // away.
        [[maybe_unused]] const int given = fchown(file, replaced.owner, replaced.group);
        fchmod(file, replaced.rights);
    }
    const bool done = fsync(file) == 0;
    close(file);
    return done;
}
bool moveOver(const std::string& from, const fs::path& to) {
    return std::rename(from.c_str(), to.c_str()) == 0;
}

}  // namespace spindrift::os
