#pragma once
// What systems do each in their own way, and all of it: a port is another file like
// system_posix.cpp. system_plain.cpp is what the standard library alone can do.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spindrift::os {

// --- this process ---

int processId();
bool errorsGoToTerminal();
// Starts the program anew with a variable of the environment set; returns where that fails.
void restartWith(const char* variable, const char* value, char** arguments);
// Becomes another program of the folder that this one is in, with the same arguments; returns where
// there is none.
void becomeNeighbour(const char* name, char** arguments);
// Which signal asked for an end while one of these lives, 0: none. A second one kills as usual, and
// a reader that is gone is an error of the output, not the end without the other outputs.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    static int received();
};

// --- this machine ---

// Bytes that a new program can have, of the machine or of its container; the largest number:
// unknown.
int64_t freeMemory();
std::string processorName();
// Large pages serve memory that all of a step goes over; `memory` begins and ends on one.
void wishLargePages(void* memory, size_t bytes);

// --- files; where something fails errno says why ---

enum class FileKind { Missing, Regular, Folder, Disk, Characters, Pipe, Socket, Unknown };
struct FileStatus {
    FileKind kind = FileKind::Missing;
    bool mayAnyoneWrite = true;  // whoever owns it
    uint32_t owner = 0, group = 0, rights = 0;
};
FileStatus statusOf(const std::filesystem::path&);  // of what a link leads to
bool mayWrite(const std::filesystem::path&);
// The number of a link to what the process has open, such as /dev/fd/3; -1 of any other.
int openNumberOf(const std::filesystem::path& link);
constexpr int StandardOutput = 1;
bool isOpenForWriting(int number);

// An open file that is written to, or a stream. Closed in the end.
class OutFile {
public:
    OutFile() = default;
    ~OutFile() { close(); }
    OutFile(OutFile&& o) noexcept : handle_(o.handle_) { o.handle_ = None; }
    OutFile& operator=(OutFile&& o) noexcept {
        close();
        handle_ = o.handle_, o.handle_ = None;
        return *this;
    }
    static OutFile create(const std::string& path);  // empty, or emptied
    static OutFile append(const std::string& path);
    static OutFile stream(const std::filesystem::path&, FileKind);  // waits for a reader
    static OutFile copyOf(int number);
    static OutFile temporary(std::string& path);  // a new one; says where

    explicit operator bool() const { return handle_ != None; }
    bool write(const char* data, size_t size);
    bool resize(size_t size);

private:
    friend class ReadingProgram;
    static constexpr intptr_t None = -1;
    explicit OutFile(intptr_t handle) : handle_(handle) {}
    void close();
    intptr_t handle_ = None;
};
// A program of PATH that reads what this one writes to it.
class ReadingProgram {
public:
    ReadingProgram() = default;
    ~ReadingProgram() { finish(); }
    ReadingProgram(const ReadingProgram&) = delete;
    // False where it can't be started; errno says why. Signals from the terminal don't reach it.
    bool start(const std::vector<std::string>& command);
    bool write(const char* data, size_t size) { return input_.write(data, size); }
    // Nothing more comes: waits for its end and returns its exit code, -1 when it has none.
    int finish();

private:
    OutFile input_;
    int id_ = 0;  // of the process, 0: none
};

// Until a file has reached the disk, so that a rename can't come before; it gets the owner and the
// rights of the one that it is to replace.
bool finish(const std::string& path, const FileStatus& replaced);
// In place of what is there, in one go.
bool moveOver(const std::string& from, const std::filesystem::path& to);

}  // namespace spindrift::os
