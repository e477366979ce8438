#pragma once
// The real program as a shell runs it: what it prints and its exit code.
#include "app/exit_code.h"
#include "core/error.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace spindrift {

namespace fs = std::filesystem;

struct Outcome {
    int code;
    std::string text;
};

inline std::string slurp(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Runs in a folder of its own, without a display.
class Shell : public ::testing::Test {
protected:
    Shell() {
        folder_ = fs::temp_directory_path() /
                  ("spindrift_" + std::to_string(getpid()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
        where_ = folder_;
    }
    ~Shell() override { fs::remove_all(folder_); }

    // Standard output, and standard error behind `redirection`; see "2>&1".
    Outcome call(const std::string& arguments, const char* redirection = "2>&1") const {
        const std::string command = "cd '" + where_.string() +
                                    "' && env -u DISPLAY -u WAYLAND_DISPLAY -u SDL_VIDEODRIVER " +
                                    environment_ + " timeout 60 '" SPINDRIFT_PROGRAM "' " +
                                    arguments + " " + redirection;
        std::FILE* pipe = popen(command.c_str(), "r");
        Outcome outcome{-1, ""};
        std::array<char, 4096> buffer;
        for (size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
            outcome.text.append(buffer.data(), n);
        const int status = pclose(pipe);
        outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
        return outcome;
    }

    void expectMistake(const std::string& arguments, Exit code, const std::string& words) const {
        const Outcome outcome = call(arguments);
        EXPECT_EQ(outcome.code, int(code)) << arguments << "\n" << outcome.text;
        EXPECT_NE(outcome.text.find(words), std::string::npos) << arguments << "\n"
                                                               << words << "\nin: " << outcome.text;
        EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1)
            << "one line: " << outcome.text;
    }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return name;
    }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (auto& entry : fs::recursive_directory_iterator(folder_))
            names.push_back(entry.path().filename().string());
        return names;
    }

    fs::path folder_, where_;  // its own folder; the one that it starts in
    std::string environment_;  // more of it, "NAME=value ..."
};

}  // namespace spindrift
