#include "core/output_file.h"

#include "core/error.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

class OutputFile : public ::testing::Test {
protected:
    OutputFile() { fs::create_directories(folder_); }
    ~OutputFile() override { fs::remove_all(folder_); }
    size_t count() const { return size_t(std::distance(fs::directory_iterator(folder_), {})); }
    const fs::path folder_ =
        fs::temp_directory_path() / ("spindrift_output_" + std::to_string(getpid()));
};

std::optional<Failure> failureOf(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) { return error.failure; }
    return std::nullopt;
}

TEST_F(OutputFile, WritesWholeFilesAndLeavesNothingElse) {
    const std::string file = folder_ / "a.txt";
    requireWritable(file);
    EXPECT_EQ(count(), 0u);
    writeText(file, "one\n");
    writeText(file, "two\n");
    std::ifstream stream(file);
    std::string text;
    std::getline(stream, text);
    EXPECT_EQ(text, "two");
    EXPECT_EQ(count(), 1u);
}

TEST_F(OutputFile, KeepsTheOldFileWhenTheNewOneFails) {
    fs::create_directory(folder_ / "taken");  // a folder can't be replaced by a file
    EXPECT_EQ(failureOf([&] { writeText(folder_ / "taken", "text"); }), Failure::Output);
    EXPECT_EQ(count(), 1u);
}

TEST_F(OutputFile, RefusesWhatCantBeWritten) {
    EXPECT_EQ(failureOf([&] { requireWritable(folder_ / "missing" / "a.txt"); }), Failure::Output);
    EXPECT_EQ(failureOf([&] { requireWritable(folder_); }), Failure::Output);
    EXPECT_EQ(failureOf([&] { requireFolder("/proc/missing"); }), Failure::Output);
    EXPECT_EQ(failureOf([&] { writeText(folder_ / "missing" / "a.txt", "text"); }),
              Failure::Output);
    EXPECT_EQ(failureOf([&] { requireFolder(folder_ / "new" / "frames"); }), std::nullopt);
    EXPECT_TRUE(fs::is_directory(folder_ / "new" / "frames"));
}

}  // namespace
}  // namespace spindrift
