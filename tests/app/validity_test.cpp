// A run outside the validity of its method says so in all that it leaves, once; strictly, it fails.
#include "core/hdf5_file.h"
#include "measure/read_series.h"
#include "shell.h"

namespace spindrift {
namespace {

size_t countOf(const std::string& text, const std::string& what) {
    size_t count = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++count;
    return count;
}

class OutsideValidity : public Shell {
protected:
    // A piston goes into a full, closed tank.
    OutsideValidity() {
        std::ofstream(folder_ / "piston.json")
            << R"({"version": 2, "simulation": {"spacing": 0.02, "dimensions": 2},
            "domain": {"min": [0, 0, 0], "max": [0.5, 0.2, 0.2]},
            "solids": [{"shape": "block", "min": [0, 0, 0], "max": [0.1, 0.2, 0.2],
                        "keyframes": [[0.05, 0, 0, 0], [0.25, 0.1, 0, 0]]}],
            "fluid": {"bodies": [{"shape": "block", "min": [0.1, 0, 0], "max": [0.5, 0.2, 0.2]}]},
            "output": {"sample_every": 0.01}})";
    }
    const std::string Run = "piston.json --headless --backend cpu --threads 1 ";
    const std::string What = "mean compression: ";
};

TEST_F(OutsideValidity, IsSaidOnceInEachOutput) {
    const Outcome whole =
        call(Run + "--time 0.15 --csv a.csv --json a.json --hdf5 a.h5 --checkpoint half.h5");
    EXPECT_EQ(whole.code, 0) << whole.text;
    EXPECT_EQ(countOf(whole.text, What), 1u) << whole.text;
    EXPECT_NE(whole.text.find("raise fluid.speed_ratio"), std::string::npos);
    EXPECT_EQ(countOf(slurp(folder_ / "a.csv"), "\n# " + What), 1u);
    EXPECT_EQ(countOf(slurp(folder_ / "a.json"), What), 1u);
    EXPECT_EQ(countOf(hdf5::readText(hdf5::openFile((folder_ / "a.h5").string()), Remarks), What),
              1u);
    const size_t row = readSeries((folder_ / "a.csv").string()).remarks.at(0).row;
    EXPECT_GT(row, 4u);
    for (const std::string next :
         {"a.csv", "a.json", "a.h5"}) {  // a run that goes on keeps it as it is
        const std::string option = next == "a.csv"    ? " --csv "
                                   : next == "a.json" ? " --json "
                                                      : " --hdf5 ";
        ASSERT_EQ(call("half.h5 --headless --quiet --time 0.17" + option + next).code, 0);
        const auto remarks = readSeries((folder_ / next).string()).remarks;
        ASSERT_EQ(remarks.size(), 1u) << next;
        EXPECT_EQ(remarks[0].row, row) << next;
    }
    const Outcome quiet = call(Run + "--quiet --time 0.15");
    EXPECT_EQ(quiet.code, 0);
    EXPECT_EQ(countOf(quiet.text, What), 1u) << "also to who asks for no summary";
}

TEST_F(OutsideValidity, IsAnErrorWhenStrict) {
    const Outcome strict = call(Run + "--quiet --strict --time 0.15 --csv b.csv");
    EXPECT_EQ(strict.code, int(Exit::Invalid));
    EXPECT_EQ(countOf(strict.text, What), 1u) << strict.text;
    EXPECT_EQ(countOf(strict.text, "\n"), 1u) << strict.text;
    const auto rows = readSeries((folder_ / "b.csv").string()).rows;
    ASSERT_FALSE(rows.empty()) << "what was measured until then is there";
    EXPECT_LT(rows.back()[0], 0.15);
    EXPECT_EQ(call(Run + "--quiet --strict --time 0.04").code, 0);
}

TEST_F(OutsideValidity, OfASceneIsAnErrorBeforeItRuns) {
    const std::string thin = R"( --set 'solids=[{"name":"p","shape":"block",)"
                             R"("min":[0.3,0.1,0],"max":[0.305,0.105,0.2]}]' )";
    const Outcome strict = call(Run + thin + "--strict --time 0.01 --csv c.csv");
    EXPECT_EQ(strict.code, int(Exit::Invalid));
    EXPECT_NE(strict.text.find("solids[0] (p), thickness: 0.005 m are 0.25 spacings"),
              std::string::npos)
        << strict.text;
    EXPECT_FALSE(fs::exists(folder_ / "c.csv"));
    EXPECT_EQ(call(Run + thin + "--quiet --time 0.01").code, 0);
}

}  // namespace
}  // namespace spindrift
