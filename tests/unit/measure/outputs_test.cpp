// Whatever is written, and wherever: files whole or not at all, what isn't a file written through,
// nothing destroyed.
#include "core/error.h"
#include "core/output_file.h"
#include "measure/checkpoint.h"
#include "measure/save_particles.h"
#include "measure/time_series.h"
#include "render/image.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}
std::string allFrom(int file) {
    std::string bytes;
    char block[4096];
    for (ssize_t n; (n = read(file, block, sizeof block)) > 0;) bytes.append(block, size_t(n));
    close(file);
    return bytes;
}
mode_t modeOf(const fs::path& path) {
    struct stat status {};
    lstat(path.c_str(), &status);
    return status.st_mode;
}

struct Writer {
    const char *name, *extension;
    std::function<void(const std::string& path)> write;
};

TimeSeries series() {
    TimeSeries s;
    s.add({}, {});
    return s;
}
void writeState(const std::string& path) {
    Placement p;
    p.positions = {{1, 2, 3}}, p.velocities = {{}};
    const RunState state(std::move(p));
    writeCheckpoint(path, Scene{}, state);
}
std::vector<Writer> writers() {
    using Path = const std::string&;
    static const std::vector<Particle> one(1);
    return {{"text", "", [](Path path) { writeText(path, std::string(100000, 'x') + "\n"); }},
            {"growing text", ".csv", [](Path path) { GrowingText(path, "one\n").append("two\n"); }},
            {"picture", ".png",
             [](Path path) {
                 writePng(path, Image{40, 30, std::vector<uint8_t>(3600, 7)});
             }},
            {"series as HDF5", ".h5", [](Path path) { series().writeHdf5(path); }},
            {"particles as CSV", ".csv", [](Path path) { saveParticles(path, one); }},
            {"particles as HDF5", ".h5", [](Path path) { saveParticles(path, one); }},
            {"checkpoint", ".h5", writeState}};
}

class Outputs : public ::testing::Test {
protected:
    Outputs() {
        fs::create_directories(folder_ / "sub");
        std::signal(SIGPIPE, SIG_IGN);
    }
    ~Outputs() override { fs::remove_all(folder_); }
    // What the writer makes, and the name of a file that is of its kind.
    std::string expected(const Writer& w) {
        const fs::path file = folder_ / ("expected" + std::string(w.extension));
        w.write(file);
        const std::string bytes = bytesOf(file);
        fs::remove(file);
        EXPECT_GT(bytes.size(), 7u);
        return bytes;
    }
    std::string pathFor(const Writer& w, const std::string& name) const {
        return folder_ / (name + w.extension);
    }
    // "" when it was refused in one line with the right code.
    static std::string refusal(const std::function<void()>& act) {
        try {
            act();
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::Output);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return "";
    }
    void expectClean() const {
        for (const auto& entry : fs::recursive_directory_iterator(folder_))
            EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    }
    const fs::path folder_ =
        fs::temp_directory_path() / ("spindrift_outputs_" + std::to_string(getpid()));
};

TEST_F(Outputs, FilesAreReplacedAndKeepTheirRights) {
    for (const Writer& w : writers()) {
        const std::string bytes = expected(w), file = pathFor(w, "file");
        std::ofstream(file) << "before";
        fs::permissions(file, fs::perms(0640));
        const std::string other = pathFor(w, "other name");
        fs::create_hard_link(file, other);
        w.write(file);
        EXPECT_EQ(bytesOf(file), bytes) << w.name;
        EXPECT_EQ(modeOf(file) & 07777, 0640u) << w.name;
        EXPECT_EQ(bytesOf(other), "before") << w.name << " was written in place";
        fs::remove(other);
        const std::string longest = folder_ / (std::string(240, 'n') + w.extension);
        w.write(longest);
        EXPECT_EQ(bytesOf(longest), bytes) << w.name;
    }
    expectClean();
}

TEST_F(Outputs, LinksAreFollowedAndStay) {
    for (const Writer& w : writers()) {
        const std::string bytes = expected(w), link = pathFor(w, "link"),
                          file = folder_ / "sub" / (std::string("file") + w.extension);
        fs::create_symlink("between", link);
        fs::create_symlink(fs::path("sub") / (std::string("file") + w.extension),
                           folder_ / "between");
        for (const bool there : {false, true}) {
            if (there) std::ofstream(file) << "before";
            requireWritable(link);
            w.write(link);
            EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(folder_ / "between")) << w.name;
            EXPECT_EQ(bytesOf(file), bytes) << w.name;
        }
        fs::remove(link), fs::remove(folder_ / "between"), fs::remove(file);
    }
    fs::create_symlink("circle", folder_ / "circle");
    EXPECT_NE(refusal([&] { writeText(folder_ / "circle", "text"); }), "");
    EXPECT_TRUE(fs::is_symlink(folder_ / "circle"));
    expectClean();
}

TEST_F(Outputs, FifosAreWrittenThrough) {
    for (const Writer& w : writers()) {
        const std::string bytes = expected(w), fifo = pathFor(w, "fifo");
        ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
        requireWritable(fifo);
        auto reader =
            std::async(std::launch::async, [&] { return allFrom(open(fifo.c_str(), O_RDONLY)); });
        const std::string refused = refusal([&] { w.write(fifo); });
        if (!refused.empty())
            close(open(fifo.c_str(), O_WRONLY | O_NONBLOCK));  // the reader waits no longer
        EXPECT_EQ(refused, "") << w.name;
        EXPECT_EQ(reader.get(), bytes) << w.name;
        EXPECT_TRUE(S_ISFIFO(modeOf(fifo))) << w.name;
        fs::remove(fifo);
    }
    expectClean();
}

TEST_F(Outputs, SocketsAreWrittenThrough) {
    for (const Writer& w : writers()) {
        const std::string bytes = expected(w), place = pathFor(w, "s");
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        ASSERT_LT(place.size(), sizeof address.sun_path);
        std::strcpy(address.sun_path, place.c_str());
        const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
        ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        listen(listener, 1);
        auto reader = std::async(std::launch::async,
                                 [&] { return allFrom(accept(listener, nullptr, nullptr)); });
        const std::string refused = refusal([&] { w.write(place); });
        if (!refused.empty()) shutdown(listener, SHUT_RDWR);
        EXPECT_EQ(refused, "") << w.name;
        EXPECT_EQ(reader.get(), bytes) << w.name;
        EXPECT_TRUE(S_ISSOCK(modeOf(place))) << w.name;
        close(listener);
        EXPECT_NE(refusal([&] { w.write(place); }), "") << "nobody listens";
        EXPECT_TRUE(S_ISSOCK(modeOf(place))) << w.name;
        fs::remove(place);
    }
}

// A node of one's own, where one may make it: the test must not cost the machine its /dev/null.
TEST_F(Outputs, DevicesAreWrittenThrough) {
    const fs::path null = folder_ / "null", full = folder_ / "full", disk = folder_ / "disk";
    if (mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
        mknod(full.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0 ||
        mknod(disk.c_str(), S_IFBLK | 0666, makedev(7, 255)) != 0)
        GTEST_SKIP() << "only root makes devices";
    if (const int file = open(null.c_str(), O_WRONLY); file < 0)
        GTEST_SKIP() << "devices don't work in this folder";
    else
        close(file);
    for (const Writer& w : writers()) {
        ASSERT_EQ(refusal([&] { w.write(null); }), "") << w.name;
        EXPECT_TRUE(S_ISCHR(modeOf(null))) << w.name;
        EXPECT_NE(refusal([&] { w.write(full); }).find("No space left on device"),
                  std::string::npos)
            << w.name;
        EXPECT_TRUE(S_ISCHR(modeOf(full))) << w.name;
        EXPECT_NE(refusal([&] { w.write(disk); }).find("it is a disk"), std::string::npos)
            << w.name;
        EXPECT_TRUE(S_ISBLK(modeOf(disk))) << w.name;
    }
    EXPECT_EQ(whereItLeads(null), "") << "any number of outputs may go there";
}

TEST_F(Outputs, OpenDescriptorsAreWrittenThrough) {
    const fs::path log = folder_ / "log";
    for (const Writer& w : writers()) {
        if (w.name == std::string("particles as HDF5"))
            continue;  // by its extension, which a descriptor hasn't
        const std::string bytes = expected(w);
        std::ofstream(log) << "before\n";
        const int file = open(log.c_str(), O_WRONLY | O_APPEND);
        w.write("/dev/fd/" + std::to_string(file));
        EXPECT_EQ(bytesOf(log), "before\n" + bytes) << w.name;
        close(file);
        EXPECT_NE(refusal([&] { w.write("/dev/fd/" + std::to_string(file)); }), "") << w.name;
        const int toRead = open(log.c_str(), O_RDONLY);
        EXPECT_NE(refusal([&] { w.write("/dev/fd/" + std::to_string(toRead)); }), "") << w.name;
        close(toRead);
    }
    EXPECT_TRUE(isStandardOutput("-") && isStandardOutput("/dev/stdout") &&
                isStandardOutput("/dev/fd/1"));
    EXPECT_FALSE(isStandardOutput("/dev/stderr") || isStandardOutput("1") || isStandardOutput(""));
}

TEST_F(Outputs, WhatIsReadOnlyIsRefused) {
    for (const Writer& w : writers()) {
        const std::string file = pathFor(w, "file"), link = pathFor(w, "link");
        std::ofstream(file) << "before";
        fs::create_symlink(file, link);
        for (const int mode : {0444, 0400, 0555, 0}) {
            fs::permissions(file, fs::perms(mode));
            for (const std::string& path : {file, link}) {
                EXPECT_NE(refusal([&] { w.write(path); }).find("it is read-only"),
                          std::string::npos)
                    << w.name << mode;
                EXPECT_NE(refusal([&] { requireWritable(path); }).find("it is read-only"),
                          std::string::npos)
                    << w.name << mode;
            }
        }
        fs::permissions(file, fs::perms(0644));
        EXPECT_EQ(bytesOf(file), "before") << w.name;
        EXPECT_NE(refusal([&] { w.write(folder_ / "sub"); }).find("it is a folder"),
                  std::string::npos)
            << w.name;
        EXPECT_NE(refusal([&] {
                      w.write(pathFor(w, "missing/file"));
                  }).find("choose a folder that exists"),
                  std::string::npos)
            << w.name;
        fs::remove(file), fs::remove(link);
    }
    expectClean();
}

TEST_F(Outputs, TwoPathsToOneFileAreOne) {
    std::ofstream(folder_ / "file") << "text";
    fs::create_symlink("file", folder_ / "link");
    fs::create_symlink("sub/../file", folder_ / "around");
    fs::create_symlink("new", folder_ / "dangling");
    for (const char* name : {"link", "around", "sub/../file", "./file"})
        EXPECT_EQ(whereItLeads(folder_ / name), whereItLeads(folder_ / "file")) << name;
    EXPECT_EQ(whereItLeads(folder_ / "dangling"), whereItLeads(folder_ / "new"));
    EXPECT_NE(whereItLeads(folder_ / "new"), whereItLeads(folder_ / "file"));
    EXPECT_EQ(whereItLeads("-"), whereItLeads("/dev/stdout"));
    EXPECT_EQ(whereItLeads("no such file"), whereItLeads("./no such file"));
    EXPECT_EQ(whereItLeads("no such file"), whereItLeads(fs::absolute("no such file")));
}

TEST_F(Outputs, AFormatHasItsExtensions) {
    for (const char* name :
         {"a.png", "a.PNG", "a", "a.5", "b.jpg/a.png", "/dev/null", "-", "a.out"})
        EXPECT_EQ(refusal([&] { requireFormat(name, {"png"}); }), "") << name;
    for (const char* name :
         {"a.jpg", "a.JPEG", "a.png.bmp", "a.tiff", "a.csv", "a.h5", ".gif/a.webp"}) {
        const std::string said = refusal([&] { requireFormat(name, {"png"}); });
        EXPECT_NE(said.find("ends in .png"), std::string::npos) << name;
    }
    EXPECT_NE(refusal([&] { writePng(folder_ / "a.jpg", Image{1, 1, {1, 2, 3}}); }), "");
    EXPECT_FALSE(fs::exists(folder_ / "a.jpg"));
}

TEST_F(Outputs, GrowingTextIsThereAtOnceAndShrinks) {
    const fs::path file = folder_ / "a.csv", fifo = folder_ / "fifo";
    std::ofstream(file) << "of another run";
    GrowingText text(file, "head\n");
    EXPECT_EQ(bytesOf(file), "head\n");
    const int follower = open(file.c_str(), O_RDONLY);
    text.append("one\n");
    text.append("two\n");
    EXPECT_EQ(bytesOf(file), "head\none\ntwo\n");
    EXPECT_TRUE(text.shrink(9));
    text.append("three\n");
    EXPECT_EQ(allFrom(follower), "head\none\nthree\n") << "is another file";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    auto reader =
        std::async(std::launch::async, [&] { return allFrom(open(fifo.c_str(), O_RDONLY)); });
    {
        GrowingText stream(fifo, "head\n");
        EXPECT_FALSE(stream.shrink(0));
        stream.append("one\n");
    }
    EXPECT_EQ(reader.get(), "head\none\n");
}

}  // namespace
}  // namespace spindrift
