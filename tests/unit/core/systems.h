#pragma once
// What is asked of every system; whoever includes this says which one `os` is.
#include "core/system.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

inline std::string textOf(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Folder {
    fs::path path = fs::temp_directory_path() / ("system_test_" + std::to_string(os::processId()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

// All systems write, add to, replace and tell apart files in the same way.
inline void expectToWriteAndReplaceFiles() {
    const Folder folder;
    const std::string first = folder.path / "first", second = folder.path / "second";
    EXPECT_EQ(os::statusOf(first).kind, os::FileKind::Missing);
    {
        os::OutFile file = os::OutFile::create(first);
        ASSERT_TRUE(file);
        EXPECT_TRUE(file.write("one", 3));
    }
    EXPECT_TRUE(os::OutFile::append(first).write(" two", 4));
    EXPECT_EQ(textOf(first), "one two");
    EXPECT_EQ(os::statusOf(first).kind, os::FileKind::Regular);
    EXPECT_EQ(os::statusOf(folder.path).kind, os::FileKind::Folder);
    std::ofstream(second) << "old";
    EXPECT_TRUE(os::moveOver(first, second));
    EXPECT_EQ(textOf(second), "one two");
    EXPECT_FALSE(fs::exists(first));
    EXPECT_FALSE(os::moveOver(first, second));
    EXPECT_FALSE(os::OutFile::create(folder.path / "none" / "file"));
    fs::permissions(second, fs::perms::owner_read);
    EXPECT_FALSE(os::statusOf(second).mayAnyoneWrite);
    std::string temporary;
    EXPECT_TRUE(os::OutFile::temporary(temporary));
    EXPECT_TRUE(fs::remove(temporary));
}

inline void expectToNoteSignals() {
    for (const int signal : {SIGTERM, SIGINT}) {
        const os::StopSignals signals;
        EXPECT_EQ(os::StopSignals::received(), 0);
        std::raise(signal);
        EXPECT_EQ(os::StopSignals::received(), signal);
    }
}

}  // namespace
}  // namespace spindrift
