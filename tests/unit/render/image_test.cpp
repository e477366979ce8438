#include "render/image.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include <unistd.h>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

struct ImageFiles : testing::Test {
    fs::path folder = fs::temp_directory_path() / ("spindrift-image-" + std::to_string(getpid()));
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    std::string path(const char* name) const { return (folder / name).string(); }
};

Image gradient(int width, int height) {
    Image image{width, height, std::vector<uint8_t>(size_t(width) * height * 3)};
    for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = uint8_t(i * 7);
    return image;
}

std::optional<Failure> failureOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.failure;
    }
    return std::nullopt;
}

TEST_F(ImageFiles, WhatIsWrittenIsRead) {
    const Image image = gradient(37, 21);
    writePng(path("a.png"), image);
    EXPECT_EQ(readPng(path("a.png")), image);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary file was left";
}

TEST_F(ImageFiles, UnwritablePlaceIsAnErrorAndLeavesNothing) {
    EXPECT_EQ(failureOf([&] { writePng(path("no/such/folder/a.png"), gradient(4, 4)); }),
              Failure::Output);
    fs::create_directory(folder / "taken.png");
    EXPECT_EQ(failureOf([&] { writePng(path("taken.png"), gradient(4, 4)); }), Failure::Output);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary file was left";
}

TEST_F(ImageFiles, MissingAndDamagedFilesAreErrors) {
    EXPECT_EQ(failureOf([&] { readPng(path("missing.png")); }), Failure::Scene);
    std::ofstream(path("text.png")) << "no picture";
    EXPECT_EQ(failureOf([&] { readPng(path("text.png")); }), Failure::Scene);
    writePng(path("cut.png"), gradient(64, 64));
    fs::resize_file(path("cut.png"), 200);
    EXPECT_EQ(failureOf([&] { readPng(path("cut.png")); }), Failure::Scene);
}

}  // namespace
}  // namespace spindrift
