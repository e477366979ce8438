// Rows, frames and ends whose times are nearly, but not quite, the same: no step is as short as
// their difference, no row is missing or doubled, and the run is not declared dead.
#include "app/headless.h"
#include "measure/read_series.h"
#include "scene/json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace spindrift {
namespace {

SeriesTable rowsOf(double every, double end, const char* mode) {
    const std::string file =
        (std::filesystem::temp_directory_path() / fmt::format("near_stops_{}.csv", getpid()))
            .string();
    Start start;
    start.file = "near_stops.json";
    for (const std::string& knob : std::vector<std::string>{
             "simulation.dimensions=2", "simulation.spacing=0.1", "compute.threads=1",
             fmt::format("time.mode={}", mode), fmt::format("output.sample_every={}", every),
             fmt::format("output.time={}", end), "output.csv=" + file,
             R"(fluid.bodies=[{"max":[0.5,0.5,1]}])"})
        setKnob(start.scene, knob);
    EXPECT_EQ(runHeadless(start, true), 0) << every << " " << end << " " << mode;
    const SeriesTable table = readSeries(file);
    std::filesystem::remove(file);
    return table;
}

TEST(NearStops, EachIntervalAndEndHasItsRowsAndNoTinyStep) {
    const double usual = 0.02 / 30;  // s, about the step of this scene
    for (const char* mode : {"cfl", "local"})
        for (double end : {0.02, 0.0333})
            for (int rows : {1, 2, 3, 7})
                for (double off : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, -1e-9, -1e-7, -1e-6, -1e-4}) {
                    const SeriesTable table = rowsOf(end / rows * (1 + off), end, mode);
                    const size_t time = *find(table.columns, "time"),
                                 dt = *find(table.columns, "dt");
                    const std::string what = fmt::format("{} {} {} {}", mode, end, rows, off);
                    EXPECT_EQ(int(table.rows.size()), rows + 1) << what;
                    EXPECT_NEAR(table.rows.back()[time], end, 1e-2 * usual) << what;
                    for (size_t r = 1; r < table.rows.size(); ++r)
                        EXPECT_GT(table.rows[r][dt], 1e-2 * usual) << what;
                }
}

}  // namespace
}  // namespace spindrift
