// How many threads a run ends up with, by what steps are made to cost. No clock is asked.
#include "device/team.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace spindrift {
namespace {

// ms of a step by so many threads; every tenth makes new lists and takes three times as long.
using Cost = std::function<double(int threads)>;

struct Spent {
    double ms;
    int last;
};
Spent run(Team& team, const Cost& cost, int steps) {
    double ms = 0;
    for (int k = 0; k < steps; ++k) {
        const double step = cost(team.size()) * (k % 10 == 0 ? 3 : 1);
        team.note(step), ms += step;
    }
    return {ms, team.size()};
}

// A machine of our own, and one on which every thread but the first waits for another program.
Cost calm(double ms) {
    return [=](int threads) { return ms * (0.05 + 0.95 / threads); };
}
Cost busy(double ms, std::mt19937& random) {
    return [ms, &random](int threads) {
        const double late = threads > 1 && random() % 3 ? 10.0 : 0.0;
        return ms * (1.0 / threads + late);
    };
}

TEST(Team, OfACalmMachineIsAllOfItAndTrialsCostLittle) {
    for (const int most : {1, 2, 3, 8, 16, 64}) {
        Team team(most, true);
        const Spent spent = run(team, calm(1), 20000);
        EXPECT_LT(spent.ms / (20000 * 1.2 * calm(1)(most)), 1.03) << most;
        EXPECT_GE(run(team, calm(1), 1000).ms, 1000 * 1.2 * calm(1)(most) * 0.999);
    }
}

TEST(Team, OfABusyMachineGetsSmallAndGrowsAgain) {
    std::mt19937 random(5);
    for (const int most : {2, 4, 16}) {
        Team team(most, true);
        run(team, busy(1, random), 200);
        EXPECT_LT(run(team, busy(1, random), 20000).ms / (20000 * 1.2), 1.05) << most;
        run(team, calm(1), 20000);
        EXPECT_LT(run(team, calm(1), 2000).ms / (2000 * 1.2 * calm(1)(most)), 1.3) << most;
    }
}

TEST(Team, ThatWasAskedForStays) {
    std::mt19937 random(5);
    Team team(8, false);
    EXPECT_EQ(run(team, busy(1, random), 1000).last, 8);
}

}  // namespace
}  // namespace spindrift
