// The rule by which blocks of fluid rest (RestBlocks), by itself: what the neighbours do is given.
#define SPINDRIFT_REAL double
#define LANES sleepTest
#include "sim/parts/block_time_steps.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace spindrift {
namespace {

using namespace sleepTest;

// Three blocks in a row, a particle in each; 1 m/s is the speed of sound and of what rests.
struct Row {
    std::array<int, 3> ids{0, 1, 2}, calm{}, sleepLength{};
    std::array<int, 4> cellStart{0, 1, 2, 3};
    std::array<double, 3> speed2{}, timeBin{};
    alignas(32) std::array<double, 12> velocity{};
    StepState clock;
    sleepTest::View v{};

    Row() {
        v.fluid.slots = 3, v.fluid.id = ids.data(), v.fluid.timeBin = {timeBin.data()},
        v.fluid.velocity = {velocity.data()};
        v.fluidNearFluid.cellStart = cellStart.data();
        v.grid.cells = {3, 1, 1};
        v.blocks = {{3, 1, 1},          {1, 1, 1}, speed2.data(), calm.data(),
                    sleepLength.data(), nullptr,   nullptr};
        v.c.restSpeed = v.c.soundSpeed = 1;
        v.state = &clock;
        for (int b = 0; b < 3; ++b) WakeBlocks{v.blocks}(b);
    }
    // One decision with blocks as fast as this, m/s; who sleeps is still.
    void decide(std::array<double, 3> speed) {
        for (int b = 0; b < 3; ++b) speed2[b] = sleeps(b) ? -1 : speed[b] * speed[b];
        for (int b = 0; b < 3; ++b) RestBlocks{v}(b);
    }
    bool sleeps(int b) const { return timeBin[b] < 0; }
    // How many decisions the last block sleeps for.
    int nextSleep(std::array<double, 3> speed, int most = 2 * longestSleep) {
        while (!sleeps(2)) decide(speed);
        int decisions = 0;
        for (; sleeps(2) && decisions < most; ++decisions) decide(speed);
        return decisions;
    }
};

TEST(Sleep, BeginWhenAllAroundHasBeenCalmForLong) {
    Row row;
    for (int k = 1; k < calmDecisions; ++k) row.decide({2, 0.9, 0.9});
    EXPECT_FALSE(row.sleeps(2));
    row.decide({2, 0.9, 0.9});
    EXPECT_FALSE(row.sleeps(0));
    EXPECT_FALSE(row.sleeps(1)) << "its neighbour is fast";
    EXPECT_TRUE(row.sleeps(2));
}

// Beside somebody who neither rests nor disturbs.
TEST(Sleep, GrowWhileNothingComesOfThem) {
    Row row;
    const std::array<double, 3> speed{2, 0.9, 0.9};
    int expected = firstSleep;
    for (int k = 0; k < 9; ++k, expected = std::min(2 * expected, longestSleep))
        EXPECT_EQ(row.nextSleep(speed), expected - calmDecisions + 1) << k;
    EXPECT_EQ(expected, longestSleep);
}

TEST(Sleep, EndWhenSomethingFastComesNearAndAreShortAgain) {
    Row row;
    const std::array<double, 3> calm{2, 0.9, 0.9};
    for (int k = 0; k < 4; ++k) row.nextSleep(calm);
    while (!row.sleeps(2)) row.decide(calm);
    row.decide({2, 3.9, 0});
    EXPECT_TRUE(row.sleeps(2)) << "slower than what wakes";
    row.decide({2, 4.1, 0});
    EXPECT_FALSE(row.sleeps(2));
    EXPECT_EQ(row.nextSleep(calm), firstSleep - calmDecisions + 1);
}

// Nobody is awake: nobody wakes.
TEST(Sleep, LastForEverWhereAllRest) {
    Row row;
    EXPECT_EQ(row.nextSleep({0.5, 0.5, 0.5}, longestSleep + 1), longestSleep + 1);
}

}  // namespace
}  // namespace spindrift
