#pragma once
// Where every output goes. A regular file is there whole or not at all, and what was there before
// stays until then. FIFOs, devices and sockets are written through. Symbolic links are followed and
// stay. What is read-only is refused, also to root; so are disks. "-" is standard output, as
// /dev/stdout is. What fails throws Error (Output), one line that names the path.
#include "core/system.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace spindrift {

// Refuses a path that can't be written to. Leaves nothing behind, and opens no FIFO.
void requireWritable(const std::string& path);

// Refuses a file whose extension is that of another format than `own`, {"csv"}: nobody expects a
// PNG in x.jpg.
void requireFormat(const std::string& path, const std::vector<std::string>& own);

// Makes the folder when it is missing and refuses one that can't be written to.
void requireFolder(const std::string& path);

// What a path leads to: the same for two paths that lead to the same file, "" where outputs don't
// disturb each other (/dev/null).
std::string whereItLeads(const std::string& path);
bool isStandardOutput(const std::string& path);
// What is written there can be neither replaced nor read again.
bool isStream(const std::string& path);

// Lets `write` make a file beside its target, flushes that to the disk and renames it;
// write(temporary) returns whether all of it was written.
void replaceFile(const std::string& path,
                 const std::function<bool(const std::string& temporary)>& write);

// The whole of a text.
void writeText(const std::string& path, const std::string& text);

// A text that grows at its end, so that others can follow it (tail -f). All of it is with the
// system when a call returns: no crash takes it away.
class GrowingText {
public:
    GrowingText(const std::string& path, const std::string& start);
    void append(const std::string& text);
    // Forgets what is behind the first `size` bytes; false where it has been written through and
    // can't be taken back.
    bool shrink(size_t size);

private:
    std::string path_;
    os::OutFile file_;
    bool streams_ = false;
    size_t size_ = 0;
};

}  // namespace spindrift
