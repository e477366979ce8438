// `spindrift validate` as a shell sees it.
#include "shell.h"

#include <nlohmann/json.hpp>

namespace spindrift {
namespace {

class Validate : public Shell {};

TEST_F(Validate, WritesFiguresAndAChart) {
    const Outcome outcome = call(
        "validate couette --resolution 20 --resolution 40 --out here --set compute.backend=cpu");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("2 of 2 targets met"), std::string::npos) << outcome.text;
    const auto rows = nlohmann::json::parse(slurp(folder_ / "here/validation.json"));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1]["resolution"], 40);
    EXPECT_GT(rows[1]["order"].get<double>(), 1.5);
    EXPECT_LT(rows[1]["metrics"][0]["value"].get<double>(),
              rows[1]["metrics"][0]["target"].get<double>());
    EXPECT_NE(slurp(folder_ / "here/couette_40.svg").find("<svg"), std::string::npos);
}

TEST_F(Validate, MissedTargetsAndMistakesHaveTheirCodes) {
    const Outcome missed = call(
        "validate poiseuille --resolution 40 --set walls.moving_face=y_max --set "
        "walls.velocity=0.1,0,0");
    EXPECT_EQ(missed.code, int(Exit::Different)) << missed.text;
    EXPECT_NE(missed.text.find("MISSED"), std::string::npos);
    expectMistake("validate couete", Exit::Usage, "did you mean couette?");
    expectMistake("validate couette --set nothing=1", Exit::Usage, "nothing");
    expectMistake("validate couette --out /proc/nowhere", Exit::Output, "/proc/nowhere");
    EXPECT_NE(call("validate --list").text.find("taylor_green"), std::string::npos);
}

}  // namespace
}  // namespace spindrift
