// Where there is no POSIX: nothing of the system's own, files by the standard library alone.
#include "core/system.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <limits>

namespace spindrift::os {

namespace fs = std::filesystem;

int processId() {
    static const auto start = std::chrono::system_clock::now().time_since_epoch().count();
    return int(start & 0x7fffffff);
}
bool errorsGoToTerminal() { return false; }
void restartWith(const char*, const char*, char**) {}

namespace {
volatile std::sig_atomic_t stopSignal = 0;
}
StopSignals::StopSignals() {
    stopSignal = 0;
    for (const int signal : {SIGINT, SIGTERM})
        std::signal(signal, [](int received) { stopSignal = received; });
}
StopSignals::~StopSignals() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}
int StopSignals::received() { return stopSignal; }

int64_t freeMemory() { return std::numeric_limits<int64_t>::max(); }
std::string processorName() { return "unknown processor"; }
void wishLargePages(void*, size_t) {}

FileStatus statusOf(const fs::path& path) {
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    const fs::perms any = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
    FileStatus s;
    s.kind = status.type() == fs::file_type::regular     ? FileKind::Regular
             : status.type() == fs::file_type::directory ? FileKind::Folder
             : status.type() == fs::file_type::not_found ? FileKind::Missing
                                                         : FileKind::Unknown;
    s.mayAnyoneWrite = (status.permissions() & any) != fs::perms::none;
    return s;
}
bool mayWrite(const fs::path& path) { return statusOf(path).mayAnyoneWrite; }
int openNumberOf(const fs::path&) { return -1; }
bool isOpenForWriting(int number) { return number == StandardOutput; }

// A handle is a FILE*.
static FILE* fileOf(intptr_t handle) { return reinterpret_cast<FILE*>(handle); }
static intptr_t handleOf(FILE* file) { return file ? reinterpret_cast<intptr_t>(file) : -1; }

OutFile OutFile::create(const std::string& path) {
    return OutFile(handleOf(std::fopen(path.c_str(), "wb")));
}
OutFile OutFile::append(const std::string& path) {
    return OutFile(handleOf(std::fopen(path.c_str(), "ab")));
}
OutFile OutFile::stream(const fs::path& path, FileKind) { return append(path.string()); }
OutFile OutFile::copyOf(int number) {
    return OutFile(number == StandardOutput ? handleOf(stdout) : None);
}
OutFile OutFile::temporary(std::string& path) {
    static int count = 0;
    std::error_code none;
    path = (fs::temp_directory_path(none) /
            ("spindrift-" + std::to_string(processId()) + "-" + std::to_string(++count)))
               .string();
    return create(path);
}
bool OutFile::write(const char* data, size_t size) {
    FILE* file = fileOf(handle_);
    return std::fwrite(data, 1, size, file) == size && std::fflush(file) == 0;
}
bool OutFile::resize(size_t) { return errno = ENOSYS, false; }
void OutFile::close() {
    if (handle_ != None && fileOf(handle_) != stdout) std::fclose(fileOf(handle_));
    handle_ = None;
}

void becomeNeighbour(const char*, char**) {}
bool ReadingProgram::start(const std::vector<std::string>&) { return errno = ENOSYS, false; }
int ReadingProgram::finish() { return -1; }

bool finish(const std::string&, const FileStatus&) { return true; }
bool moveOver(const std::string& from, const fs::path& to) {
    std::error_code failed;
    fs::rename(from, to, failed);
    return !failed;
}

}  // namespace spindrift::os
