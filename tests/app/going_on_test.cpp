// A run that is killed at any moment has its series until then, and goes on as if it had not been
// killed; nothing is written unasked.
#include "measure/checkpoint.h"
#include "measure/read_series.h"
#include "scene/json.h"
#include "shell.h"

#include <fmt/format.h>

#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <random>

namespace spindrift {
namespace {

class GoingOn : public Shell {
protected:
    const std::string Run =
        "test/dam_break_small --headless --backend cpu --threads 1 --quiet --size 64x48 ";
    const std::string Series = "--csv run.csv --json run.json --hdf5 run.h5 ";
    SeriesTable read(const std::string& name) const {
        return readSeries((folder_ / name).string());
    }
    // But for the times of passes, which differ from run to run.
    static void expectSame(const SeriesTable& a, const SeriesTable& b) {
        ASSERT_EQ(a.rows.size(), b.rows.size()) << a.path << " and " << b.path;
        for (size_t i = 0; i < a.columns.size(); ++i) {
            const auto k = find(b.columns, a.columns[i].name);
            ASSERT_TRUE(k) << a.columns[i].name;
            EXPECT_EQ(a.columns[i].unit, b.columns[*k].unit);
            if (a.columns[i].unit == "ms") continue;
            for (size_t r = 0; r < a.rows.size(); ++r)
                EXPECT_EQ(a.rows[r][i], b.rows[r][*k])
                    << a.path << ", row " << r << ", " << a.columns[i].name;
        }
    }
    // Rows in whole lines, of rising time.
    void expectSound(const std::string& name) const {
        if (!fs::exists(folder_ / name)) return;
        const SeriesTable table = read(name);
        ASSERT_FALSE(table.rows.empty()) << name;
        const size_t time = *find(table.columns, "time");
        for (size_t r = 1; r < table.rows.size(); ++r)
            EXPECT_GT(table.rows[r][time], table.rows[r - 1][time]) << name;
    }
    int killAfter(double seconds, const std::string& arguments) const {
        return std::system(fmt::format("cd '{}' && timeout -s KILL {} '" SPINDRIFT_PROGRAM
                                       "' {} >/dev/null 2>&1",
                                       folder_.string(), seconds, arguments)
                               .c_str());
    }
};

TEST_F(GoingOn, ARunKilledAtRandomHasTheSeriesOfAWholeOne) {
    const std::string often =
        "--set output.checkpoint_every=0.01 --set output.sample_every=0.0015 --time 0.06 ";
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(call(Run + often + "--csv whole.csv --checkpoint whole.h5").code, 0);
    // Shares of what a whole run takes on this machine; what is left of it gets shorter.
    const double whole =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const char* seed = std::getenv("SPINDRIFT_SEED");  // to try others
    std::mt19937 random(seed ? unsigned(std::atoi(seed)) : 3u);
    std::uniform_real_distribution<double> share(0.05, 0.6);
    int killed = 0;
    for (int k = 0; k < 6; ++k) {
        const bool first = !fs::exists(folder_ / "run_state.h5");
        killed += killAfter(whole * share(random),
                            (first ? Run + often : "run_state.h5 --headless --quiet ") + Series +
                                "--checkpoint run_state.h5") != 0;
        for (const char* name : {"run.csv", "run.json", "run.h5"}) expectSound(name);
    }
    EXPECT_GT(killed, 0);
    const bool first = !fs::exists(folder_ / "run_state.h5");
    const Outcome end =
        call((first ? Run + often : "run_state.h5 --headless --quiet --time 0.06 ") + Series +
             "--checkpoint run_state.h5");
    ASSERT_EQ(end.code, 0) << end.text;
    for (const char* name : {"run.csv", "run.json"}) expectSame(read("whole.csv"), read(name));
    EXPECT_EQ(read("run.h5").rows.size(), read("whole.csv").rows.size());
    EXPECT_EQ(readCheckpoint((folder_ / "run_state.h5").string()).state.particles.positions,
              readCheckpoint((folder_ / "whole.h5").string()).state.particles.positions);
}

// While it runs, not only at its end.
TEST_F(GoingOn, RowsAreThereWhileItRuns) {
    ASSERT_NE(killAfter(4, Run + "--time 1000 --set output.sample_every=0.001 " + Series), 0);
    for (const char* name : {"run.csv", "run.json", "run.h5"}) {
        ASSERT_TRUE(fs::exists(folder_ / name)) << name;
        EXPECT_GT(read(name).rows.size(), 1u) << name;
    }
}

TEST_F(GoingOn, RowsBeforeStayAndRowsAfterAreReplaced) {
    ASSERT_EQ(call(Run + "--time 0.02 --fps 500 --checkpoint a.h5").code, 0);
    ASSERT_EQ(call(Run + "--time 0.04 --fps 500 " + Series).code, 0);
    const SeriesTable before = read("run.csv");
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.03 " + Series + "--csv run.csv").code, 0);
    for (const char* name : {"run.csv", "run.json", "run.h5"}) {
        const SeriesTable after = read(name);
        const size_t time = *find(after.columns, "time");
        ASSERT_EQ(after.rows.size(), 16u) << name;
        EXPECT_NEAR(after.rows.back()[time], 0.03, 1e-8);
        for (size_t r = 0; r <= 10; ++r)
            EXPECT_NEAR(after.rows[r][time], before.rows[r][0], 1e-9) << name;
    }
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.03 --csv new.csv").code, 0);
    EXPECT_EQ(read("new.csv").rows.size(), 6u)
        << "a file that isn't there begins where the run goes on";
}

// Where there is nothing left to do, files that a killed run has left behind the others catch up,
// and new ones are made.
TEST_F(GoingOn, AllFilesOfAFinishedRunAreWhole) {
    ASSERT_EQ(call(Run + "--time 0.02 --fps 500 --checkpoint half.h5 --json run.json").code, 0);
    ASSERT_EQ(call(Run + "--time 0.03 --fps 500 --checkpoint a.h5 --csv run.csv").code, 0);
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.03 " + Series).code, 0);
    for (const char* name : {"run.json", "run.h5"}) EXPECT_EQ(read(name).rows.size(), 16u) << name;
    fs::remove(folder_ / "run.csv");
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.03 " + Series).code, 0);
    expectSame(read("run.json"), read("run.csv"));
}

TEST_F(GoingOn, AnotherProbeIsAColumnOfItsOwn) {
    const std::string probe =
        R"(--set 'output.probes=[{"kind":"height","name":"NAME","position":[0.1,0,0.1]}]' )";
    const auto named = [&](const char* name) {
        return std::string(probe).replace(probe.find("NAME"), 4, name);
    };
    ASSERT_EQ(
        call(Run + "--time 0.02 --fps 500 --csv run.csv --checkpoint a.h5 " + named("one")).code,
        0);
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.03 --csv run.csv " + named("two")).code, 0);
    const SeriesTable run = read("run.csv");
    const auto one = find(run.columns, "one.height"), two = find(run.columns, "two.height");
    ASSERT_TRUE(one && two && run.rows.size() == 16);
    for (size_t r = 0; r < run.rows.size(); ++r) {
        EXPECT_EQ(std::isnan(run.rows[r][*one]), r > 10) << r;
        EXPECT_EQ(std::isnan(run.rows[r][*two]), r <= 10) << r;
    }
}

TEST_F(GoingOn, WhatIsNoSeriesOfTheRunIsRefusedAndStays) {
    ASSERT_EQ(call(Run + "--time 0.02 --fps 500 --checkpoint a.h5").code, 0);
    ASSERT_EQ(
        call(Run +
             "--time 0.03 --fps 500 --csv other.csv --set time.mode=fixed --set time.step=0.0001")
            .code,
        0);
    write("notes.csv", "dear diary\n"), write("x.json", "{\"rows\": 7}"),
        write("numbers.csv", "time [s],step\n0,zero\n");
    const std::string other = slurp(folder_ / "other.csv");
    for (const auto& [option, words] : std::vector<std::pair<std::string, std::string>>{
             {"--csv other.csv", "it is another run's"},
             {"--csv notes.csv", "no columns time and step"},
             {"--json x.json", "it is no time series"},
             {"--csv numbers.csv", "a value that is no number"},
             {"--hdf5 a.h5", "the run is read from it"}})
        expectMistake("a.h5 --headless --time 0.03 " + option, Exit::Output, words);
    EXPECT_EQ(slurp(folder_ / "other.csv"), other);
    EXPECT_EQ(slurp(folder_ / "notes.csv"), "dear diary\n");
}

TEST_F(GoingOn, NothingIsWrittenUnasked) {
    ASSERT_EQ(call(Run + "--time 0.01 --color pressure " + Series +
                   "--checkpoint a.h5 --screenshot last.png --frames frames --set "
                   "output.particles=end.csv")
                  .code,
              0);
    const std::string checkpoint = slurp(folder_ / "a.h5");
    for (const std::string& name : files())
        if (name != "a.h5") fs::remove_all(folder_ / name);
    const Outcome outcome = call("a.h5 --headless --time 0.02");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(files(), std::vector<std::string>{"a.h5"});
    EXPECT_EQ(slurp(folder_ / "a.h5"), checkpoint);
    for (const char* named :
         {"--csv run.csv", "--json run.json", "--hdf5 run.h5", "--checkpoint a.h5",
          "--screenshot last.png", "--frames frames", "--set output.particles=end.csv"})
        EXPECT_NE(outcome.text.find(named), std::string::npos)
            << named << " isn't told in: " << outcome.text;
    const Scene next = parseScene(call("a.h5 --print-config").text, "printed"),
                own = parseScene(call("test/dam_break_small --print-config").text, "own");
    EXPECT_EQ(next.view.colorBy, own.view.colorBy);
    EXPECT_EQ(next.window.width, own.window.width);
    EXPECT_FALSE(next.output.headless);
    ASSERT_EQ(call("a.h5 --headless --quiet --time 0.02 --checkpoint ./a.h5").code, 0);
    EXPECT_NE(slurp(folder_ / "a.h5"), checkpoint) << "it was named again";
}

TEST_F(GoingOn, AnEndThatLiesBehindIsAMistake) {
    ASSERT_EQ(call(Run + "--steps 30 --checkpoint a.h5").code, 0);
    const double time = readCheckpoint((folder_ / "a.h5").string()).state.clock.time;
    for (const int steps : {1, 15, 29}) {
        expectMistake(fmt::format("a.h5 --headless --steps {}", steps), Exit::Usage,
                      "a.h5 goes on from step 30");
        expectMistake(fmt::format("a.h5 --headless --time {}", time * steps / 31), Exit::Usage,
                      "name a later one");
    }
    for (const std::string& end :
         {std::string("--steps 30"), std::string("--steps 33"), fmt::format("--time {}", time),
          fmt::format("--time {}", 1.1 * time)}) {
        const Outcome outcome = call("a.h5 --headless --quiet --checkpoint b.h5 " + end);
        EXPECT_EQ(outcome.code, 0) << end << outcome.text;
        const StepState clock = readCheckpoint((folder_ / "b.h5").string()).state.clock;
        EXPECT_TRUE(end != "--steps 33" || clock.steps == 33) << clock.steps;
        EXPECT_TRUE(end != fmt::format("--time {}", 1.1 * time) ||
                    std::abs(clock.time - 1.1 * time) < 1e-6)
            << clock.time;
    }
}

TEST_F(GoingOn, FramesGoOn) {
    const std::string often = "--fps 500 --frames frames ";
    ASSERT_EQ(call(Run + often + "--time 0.02 --checkpoint a.h5").code, 0);
    const auto stamp = fs::last_write_time(folder_ / "frames/frame_00010.png");
    ASSERT_EQ(call("a.h5 --headless --quiet --size 64x48 --time 0.03 --frames frames").code, 0);
    EXPECT_EQ(fs::last_write_time(folder_ / "frames/frame_00010.png"), stamp);
    EXPECT_TRUE(fs::exists(folder_ / "frames/frame_00015.png"));
    EXPECT_FALSE(fs::exists(folder_ / "frames/frame_00016.png"));
    ASSERT_EQ(call("a.h5 --headless --quiet --size 64x48 --time 0.03 --frames new").code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "new/frame_00000.png") &&
                fs::exists(folder_ / "new/frame_00005.png"));
    EXPECT_FALSE(fs::exists(folder_ / "new/frame_00006.png"));
}

TEST_F(GoingOn, AFifoIsFollowedWhileItRuns) {
    ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
    const std::string run = "cd '" + folder_.string() +
                            "' && { head -n 3 fifo > got & } && timeout 60 '" SPINDRIFT_PROGRAM
                            "' " +
                            Run + "--time 1000 --csv fifo --checkpoint a.h5 2> said";
    const int status = std::system(run.c_str());
    EXPECT_EQ(WEXITSTATUS(status), int(Exit::Output)) << "the reader is gone after three lines";
    EXPECT_NE(slurp(folder_ / "said").find("fifo: can't be written"), std::string::npos)
        << slurp(folder_ / "said");
    const std::string got = slurp(folder_ / "got");
    EXPECT_EQ(std::count(got.begin(), got.end(), '\n'), 3) << got;
    EXPECT_TRUE(fs::is_fifo(folder_ / "fifo"));
}

}  // namespace
}  // namespace spindrift
