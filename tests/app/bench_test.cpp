// `bench --baseline`: what got slower is said, what is new is noted, other machines don't count.
#include "app/bench_baseline.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace spindrift {
namespace {

nlohmann::json row(double ms, double forces) {
    return {{"case", "dam"},     {"machine", "here"},
            {"device", "CPU"},   {"particles", 10},
            {"ms_per_step", ms}, {"ms_per_pass", {{"forces", forces}, {"sort", 0.1}}}};
}

struct BenchBaselineTest : testing::Test {
    std::string path =
        (std::filesystem::temp_directory_path() / "spindrift-baseline-test.json").string();
    BenchBaselineTest() { std::filesystem::remove(path); }
    ~BenchBaselineTest() override { std::filesystem::remove(path); }
};

TEST_F(BenchBaselineTest, SaysWhatGotSlower) {
    EXPECT_EQ(BenchBaseline(path).ratio(row(1, 0.5)), 0) << "there is none yet";
    BenchBaseline first;
    EXPECT_TRUE(first.add(row(1, 0.5)));
    EXPECT_FALSE(first.add(row(2, 0.5))) << "the first time stays";
    std::ofstream(path) << first.text();

    const BenchBaseline baseline(path);
    EXPECT_EQ(baseline.complaint(row(1.09, 0.6)), "");
    EXPECT_EQ(baseline.complaint(row(0.5, 0.2)), "");
    EXPECT_EQ(baseline.complaint(row(1.5, 1)),
              "dam: 1.500 ms a step, 1.50 times the baseline's (forces 0.500 -> 1.000)");
    for (const char* key : {"case", "machine", "device"}) {
        nlohmann::json other = row(1.5, 1);
        other[key] = "another";
        EXPECT_EQ(baseline.complaint(other), "") << key;
    }
}

TEST_F(BenchBaselineTest, RefusesOtherFiles) {
    for (const char* text : {"", "{}", "[1, 2", "hello"}) {
        std::ofstream(path) << text;
        EXPECT_THROW(BenchBaseline{path}, Error) << text;
    }
    std::ofstream(path) << "[1, {\"case\": 3}, {\"case\": \"dam\", \"machine\": \"here\", "
                           "\"device\": \"CPU\", \"particles\": 10}]";
    EXPECT_EQ(BenchBaseline(path).ratio(row(1, 1)), 0) << "rows of other kinds are no rows";
}

}  // namespace
}  // namespace spindrift
