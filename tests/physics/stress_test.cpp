// The quick part of `spindrift stress`: nothing goes wrong without the health guard saying so.
#include "measure/stability_map.h"
#include "measure/stress.h"

#include "scene/json.h"

#include <gtest/gtest.h>

#include <cctype>

namespace spindrift {
namespace {

class Torture : public testing::TestWithParam<StressCase> {};

TEST_P(Torture, IsSound) {
    const StressResult r = stress(GetParam());
    EXPECT_EQ(int(r.verdict), int(Verdict::Sound)) << r.what;
    EXPECT_EQ(r.steps, GetParam().steps);
}

std::string nameOf(const testing::TestParamInfo<StressCase>& info) {
    std::string name;
    for (char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
}
INSTANTIATE_TEST_SUITE_P(Cases, Torture, testing::ValuesIn(tortures(false)), nameOf);

TEST(RandomScenes, AreNeverBroken) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        const StressResult r = stress(randomCase(seed));
        EXPECT_NE(int(r.verdict), int(Verdict::Broken)) << "seed " << seed << ": " << r.what;
    }
}

// Thick fluid in full boxes, whose empty slots once became infinitely fast.
TEST(RandomScenes, EmptySlotsStayQuiet) {
    for (uint64_t seed : {138, 618}) {
        const StressCase c = randomCase(seed);
        ASSERT_EQ(int(c.scene.simulation.formulation), int(Formulation::TransportVelocity));
        const StressResult r = stress(c);
        EXPECT_EQ(int(r.verdict), int(Verdict::Sound)) << "seed " << seed << ": " << r.what;
        EXPECT_EQ(r.retries, 0) << "seed " << seed;
    }
}

TEST(RandomScenes, AreTheSameForTheSameSeed) {
    EXPECT_EQ(writeScene(randomCase(5).scene), writeScene(randomCase(5).scene));
    EXPECT_NE(writeScene(randomCase(5).scene), writeScene(randomCase(6).scene));
}

// Half as long again is sound too; and the search does find where it ends.
TEST(StabilityMaps, TheAutomaticStepLiesInside) {
    for (const char* scene : {"drop impact"})  // `spindrift stress --full` has the others
        for (const StabilityRow& row : stabilityMap(scene, "", "time.step").rows) {
            EXPECT_TRUE(row.usualIsSound) << scene << ", " << row.formulation;
            EXPECT_EQ(row.low, row.least) << scene << ", " << row.formulation;
            EXPECT_GE(row.high, 1.5) << scene << ", " << row.formulation;
            EXPECT_LT(row.high, row.most) << scene << ", " << row.formulation;
        }
}
TEST(StabilityMaps, AreDrawnRowByRow) {
    StabilityMap map{"pool",
                     {{"wcsph",
                       "time.cfl",
                       "",
                       0.4,
                       0.1,
                       4,
                       0.1,
                       2,
                       true,
                       {{0.4, Verdict::Sound}, {4, Verdict::Broken}}}}};
    const std::string text = svg(map);
    EXPECT_NE(text.find(">wcsph time.cfl<"), std::string::npos);
    EXPECT_EQ(text.find("nan"), std::string::npos);
}

// The criteria see what they are for.
TEST(StressCriteria, NoticeTooLongSteps) {
    StressCase c = randomCase(1);
    c.scene.time.mode = TimeMode::Fixed, c.scene.time.step = 0.02f;
    EXPECT_NE(int(stress(c).verdict), int(Verdict::Sound));
}
TEST(StressCriteria, NoticeEnergyFromNothing) {
    for (const StressCase& c : tortures(false)) {
        if (c.name != "wcsph: gravity tilted and turned") continue;
        StressCase blind = c;
        blind.energyIsConserved = true;  // it isn't: somebody tilts the box
        const StressResult r = stress(blind);
        EXPECT_EQ(int(r.verdict), int(Verdict::Broken));
        EXPECT_NE(r.what.find("energy from nothing"), std::string::npos) << r.what;
    }
}

}  // namespace
}  // namespace spindrift
