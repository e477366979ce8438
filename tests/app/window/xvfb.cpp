#include "xvfb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spindrift {

namespace fs = std::filesystem;

namespace {

bool waitFor(double seconds, const std::function<bool()>& done) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (!done()) {
        if (Clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

}  // namespace

Process::Process(const std::vector<std::string>& command,
                 const std::vector<std::string>& environment, const fs::path& folder,
                 const fs::path& log, int inherited) {
    pid_ = fork();
    if (pid_ != 0) return;
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    if (inherited >= 0) fcntl(inherited, F_SETFD, 0);
    for (const std::string& setting : environment) putenv(const_cast<char*>(setting.c_str()));
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execvp(words[0], words.data());
    _exit(127);
}

Process::~Process() {
    if (!running()) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
}

bool Process::running() {
    if (pid_ <= 0) return false;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
    result_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    pid_ = 0;
    return false;
}

void Process::send(int signal) const {
    if (pid_ > 0) kill(pid_, signal);
}

double Process::cpuTime() const {
    std::ifstream stat("/proc/" + std::to_string(pid_) + "/stat");
    std::string word;
    std::getline(stat, word, ')');  // the name may have blanks
    for (int field = 3; field < 14; ++field) stat >> word;
    double user = 0, system = 0;
    stat >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

int Process::wait(double seconds) {
    waitFor(seconds, [this] { return !running(); });
    return result_;
}

Screen::Screen() {
    // The server picks a free number and writes it into the pipe.
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    server_ = Process({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1280x800x24",
                       "-nolisten", "tcp", "-noreset"},
                      {}, "/", "/dev/null", ends[1]);
    close(ends[1]);
    char c = 0;
    while (read(ends[0], &c, 1) == 1 && c != '\n') display_ += c;
    close(ends[0]);
    display_ = ":" + display_;
}

Window::Window(const Screen& screen, const std::vector<std::string>& arguments)
    : display_("DISPLAY=" + screen.display()) {
    std::string pattern = (fs::temp_directory_path() / "spindrift-window-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    std::vector<std::string> command{SPINDRIFT_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    program_ = Process(command, {display_, "SDL_VIDEODRIVER=x11", "OMP_WAIT_POLICY=passive"},
                       folder_, folder_ / "log");
    const fs::path found = folder_ / "id";
    const std::string search =
        display_ + " xdotool search --name Spindrift >" + found.string() + " 2>/dev/null";
    waitFor(30, [&] { return !running() || std::system(search.c_str()) == 0; });
    std::ifstream(found) >> id_;
    if (running()) screenshot();  // the first picture is there
}

Window::~Window() {
    program_ = {};
    fs::remove_all(folder_);
}

void Window::act(const std::string& words) const {
    ASSERT_EQ(std::system((display_ + " xdotool " + words).c_str()), 0) << words;
}

void Window::actWhileStopped(const std::string& words) {
    program_.send(SIGSTOP);
    act(words);
    program_.send(SIGCONT);
}

void Window::drag(int button, int x0, int y0, int x1, int y1) const {
    const std::string b = std::to_string(button);
    act(at(x0, y0) + "mousedown " + b + " sleep 0.1 " + at((x0 + x1) / 2, (y0 + y1) / 2) +
        at(x1, y1) + "mouseup " + b + " sleep 0.1");
}

std::string Window::at(int x, int y) const {
    return "mousemove --window " + id_ + " " + std::to_string(x) + " " + std::to_string(y) +
           " sleep 0.1 ";
}

Image Window::screenshot() {
    const auto count = [&] {
        return std::count_if(fs::directory_iterator(folder_), {},
                             [](const auto& entry) { return entry.path().extension() == ".png"; });
    };
    const auto before = count();
    // A window that has just opened may not listen yet: press again after a while.
    for (int attempt = 0; attempt < 5 && count() == before; ++attempt) {
        act("key F12");
        waitFor(8, [&] { return count() > before || !running(); });
    }
    EXPECT_EQ(count(), before + 1) << log();
    char name[32];
    std::snprintf(name, sizeof name, "spindrift-%03d.png", int(before + 1));
    return fs::exists(folder_ / name) ? readPng((folder_ / name).string()) : Image{};
}

std::string Window::log() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "log").rdbuf();
    return text.str();
}

bool Window::prints(const std::string& words) const {
    return waitFor(10, [&] { return log().find(words) != std::string::npos; });
}

bool allInstalled(const std::vector<std::string>& programs) {
    for (const std::string& program : programs)
        if (std::system(("command -v " + program + " >/dev/null").c_str()) != 0) return false;
    return true;
}

}  // namespace spindrift
