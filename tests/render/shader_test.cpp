#include "picture.h"

#include "core/error.h"
#include "render/shader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

// A copy of the shaders in which one file is another.
struct BrokenShaders {
    fs::path folder = fs::temp_directory_path() / ("spindrift-shaders-" + std::to_string(getpid()));
    BrokenShaders() {
        fs::copy(SPINDRIFT_SOURCE_DIR "/shaders", folder, fs::copy_options::recursive);
        setenv("SPINDRIFT_SHADERS", folder.c_str(), 1);
    }
    ~BrokenShaders() {
        unsetenv("SPINDRIFT_SHADERS");
        fs::remove_all(folder);
    }
};

std::string messageOf(const std::string& program) {
    try {
        loadProgram(program);
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::NoDisplay);
        return error.what();
    }
    return {};
}

TEST(Shaders, MissingOneIsNamed) {
    rendererOf(64, 64);
    BrokenShaders shaders;
    fs::remove(shaders.folder / "particles.frag");
    EXPECT_NE(messageOf("particles").find("particles.frag: shader not found"), std::string::npos);
}

TEST(Shaders, BrokenOneIsNamedWithTheCompilersWords) {
    rendererOf(64, 64);
    BrokenShaders shaders;
    std::ofstream(shaders.folder / "lines.vert") << "void main() { gl_Position = nonsense; }\n";
    const std::string message = messageOf("lines");
    EXPECT_NE(message.find("lines.vert: shader doesn't compile"), std::string::npos) << message;
    EXPECT_NE(message.find("nonsense"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace
}  // namespace spindrift
