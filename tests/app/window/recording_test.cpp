// Film and series of a run in the window; in place of ffmpeg a script that keeps what it gets.
#include "app/window/recording.h"
#include "core/error.h"
#include "measure/read_series.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

struct Recordings : testing::Test {
    Recordings() {
        fs::create_directories(folder / "bin");
        std::ofstream(folder / "bin" / "ffmpeg")
            << "#!/bin/sh\nfor last; do :; done\nexec cat > \"${last#file:}\"\n";
        fs::permissions(folder / "bin" / "ffmpeg", fs::perms::owner_all);
        setenv("PATH", ((folder / "bin").string() + ":" + path).c_str(), 1);
        scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/solids_small.json");
        scene.name = "a test / of names", scene.output.fps = 100;
        scene.output.probes = {Probe{}};
        scene.output.probes[0].position = {0.5f, 0.1f, 0.4f};
        simulation = makeSimulation(scene);
    }
    ~Recordings() override {
        setenv("PATH", path.c_str(), 1);
        fs::remove_all(folder);
    }
    // Pictures of 4 x 2 pixels of one shade.
    static Image shade(uint8_t value) { return {4, 2, std::vector<uint8_t>(24, value)}; }
    // The run is at these times, s, shown at this share of real time.
    void follow(Recording& recording, std::vector<double> times, double speed = 1) {
        Measurement m = simulation->measure();
        for (const double time : times) {
            m.time = time;
            recording.follow(*simulation, m, {});
            if (recording.wantsPicture()) recording.add(shade(uint8_t(1000 * time)), speed);
        }
    }
    static std::vector<int> shades(const std::string& film) {
        std::ifstream file(film, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        std::vector<int> found;
        for (size_t i = 0; i + 24 <= bytes.size(); i += 24)
            found.push_back(static_cast<unsigned char>(bytes[i]));
        return found;
    }
    static std::vector<double> times(const std::string& series) {
        std::vector<double> found;
        for (const auto& row : readSeries(series).rows) found.push_back(row[0]);
        return found;
    }

    const std::string path = std::getenv("PATH");
    const fs::path folder =
        fs::temp_directory_path() / ("spindrift-recording-" + std::to_string(getpid()));
    Scene scene;
    std::unique_ptr<Simulation> simulation;
};

TEST_F(Recordings, FollowTheRunsTime) {
    Recording recording(scene, 0, 4, 2, folder.string());
    EXPECT_EQ(fs::path(recording.film()).filename(), "a_test_of_names-001.mp4");
    // 60 pictures a second: 0, 1/60, ...; one for each even where the run has gone farther.
    follow(recording, {0, 0.005, 0.012, 0.018, 0.02, 0.031, 0.1});
    EXPECT_DOUBLE_EQ(recording.seconds(), 7 / 60.0);
    recording.finish();
    EXPECT_EQ(shades(recording.film()), (std::vector<int>{0, 18, 100, 100, 100, 100, 100}));
    EXPECT_EQ(times(recording.series()), (std::vector<double>{0, 0.012, 0.02, 0.031, 0.1}));
    const SeriesTable table = readSeries(recording.series());
    EXPECT_TRUE(find(table.columns, "probe.pressure").has_value());
}

TEST_F(Recordings, SlowMotionTakesMorePictures) {
    Recording recording(scene, 0.5, 4, 2, folder.string());
    std::vector<double> steps;
    for (int i = 0; i <= 1000; ++i) steps.push_back(0.5 + 1e-4 * i);
    follow(recording, steps, 0.1);
    EXPECT_NEAR(recording.seconds(), 1, 0.02) << "a tenth of a second, ten times as long";
    EXPECT_LT(recording.next(), 0.6 + 0.01);
    recording.finish();
}

// As a run that goes on from a checkpoint does with its rows.
TEST_F(Recordings, RunThatGoesBackTakesItsRowsWithIt) {
    Recording recording(scene, 0, 4, 2, folder.string());
    follow(recording, {0, 0.01, 0.02, 0.03, 0.04, 0.015, 0.025, 0.045});
    recording.finish();
    EXPECT_EQ(times(recording.series()), (std::vector<double>{0, 0.01, 0.015, 0.025, 0.045}));
    EXPECT_EQ(shades(recording.film()), (std::vector<int>{0, 20, 40, 15, 45})) << "it shows both";
}

TEST_F(Recordings, OverwriteNothing) {
    const std::string stem = (folder / fileStem(scene.name)).string();
    std::ofstream(stem + "-001.mp4") << "a film";
    std::ofstream(stem + "-002.csv") << "a series";
    for (const char* number : {"-003", "-004"}) {
        Recording recording(scene, 0, 4, 2, folder.string());
        EXPECT_EQ(recording.film(), stem + number + ".mp4");
        EXPECT_EQ(recording.series(), stem + number + ".csv");
        follow(recording, {0});
        recording.finish();
        EXPECT_TRUE(fs::exists(recording.film()) && fs::exists(recording.series()));
    }
    EXPECT_EQ(fs::file_size(stem + "-001.mp4"), 6u);
    EXPECT_EQ(fs::file_size(stem + "-002.csv"), 8u);
}

TEST_F(Recordings, SayHowToGetFfmpegAndLeaveNothingBehind) {
    setenv("PATH", (folder / "nothing").c_str(), 1);
    try {
        Recording recording(scene, 0, 4, 2, folder.string());
        ADD_FAILURE() << "there is no ffmpeg";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("apt-get install ffmpeg"), std::string::npos)
            << error.what();
    }
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) files += entry.is_regular_file();
    EXPECT_EQ(files, 0);
}

TEST(FileStem, IsAFileName) {
    EXPECT_EQ(fileStem("dam break"), "dam_break");
    EXPECT_EQ(fileStem("../x.y, "), "x_y");
    EXPECT_EQ(fileStem(""), "run");
    EXPECT_EQ(fileStem("Stra\xc3\x9f"
                       "e 2"),
              "Stra\xc3\x9f"
              "e_2");
    EXPECT_LE(fileStem(std::string(5000, 'a')).size(), 100u);
    // Cut between letters, however many bytes they have.
    for (const std::string letter : {"\xc3\x9f", "\xe6\xb0\xb4", "\xf0\x9f\x8c\x8a"})
        for (size_t before = 0; before < 4; ++before) {
            std::string name(before, 'a');
            while (name.size() < 200) name += letter;
            const std::string stem = fileStem(name);
            EXPECT_EQ((stem.size() - before) % letter.size(), 0u) << letter << before;
            EXPECT_GT(stem.size(), 100 - letter.size());
            EXPECT_LE(stem.size(), 100u);
        }
}

}  // namespace
}  // namespace spindrift
