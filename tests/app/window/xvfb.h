#pragma once
// A screen without a monitor, the real program on it, and hands: keys, mouse, screenshots.
#include "render/image.h"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace spindrift {

// A child process, ended with its owner.
class Process {
public:
    Process() = default;
    Process(const std::vector<std::string>& command, const std::vector<std::string>& environment,
            const std::filesystem::path& folder, const std::filesystem::path& log,
            int inherited = -1);
    ~Process();
    Process(Process&& other) noexcept { std::swap(pid_, other.pid_); }
    Process& operator=(Process&& other) noexcept {
        std::swap(pid_, other.pid_);
        return *this;
    }

    bool running();
    void send(int signal) const;
    // What it has used of the cores so far, all its threads together; s.
    double cpuTime() const;
    // What it returned, -1 when it's still running after `seconds` or a signal ended it.
    int wait(double seconds);

private:
    pid_t pid_ = 0;
    int result_ = -1;
};

// An X server on a free display.
class Screen {
public:
    Screen();
    const std::string& display() const { return display_; }

private:
    std::string display_;  // ":7"
    Process server_;
};

// The program in a window, with a folder of its own for what it writes.
class Window {
public:
    Window(const Screen&, const std::vector<std::string>& arguments);
    ~Window();

    // "key space", at(400, 300) + "click 4": words of xdotool.
    void act(const std::string& words) const;
    // The same for a program that is busy meanwhile and finds all of it in its queue.
    void actWhileStopped(const std::string& words);
    // Puts the mouse at a place of the window.
    std::string at(int x, int y) const;
    void drag(int button, int x0, int y0, int x1, int y1) const;
    // F12, and the picture it saved.
    Image screenshot();
    int wait(double seconds) { return program_.wait(seconds); }
    void send(int signal) const { program_.send(signal); }
    bool running() { return program_.running(); }
    double cpuTime() const { return program_.cpuTime(); }
    std::string log() const;
    // Whether the log has these words, now or some seconds later.
    bool prints(const std::string& words) const;

private:
    std::string display_, id_;
    std::filesystem::path folder_;
    Process program_;
};

bool allInstalled(const std::vector<std::string>& programs);

}  // namespace spindrift
