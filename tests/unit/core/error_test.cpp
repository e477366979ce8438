// Bugs abort with their place; mistakes carry their exit code.
#include "core/error.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

TEST(ErrorDeathTest, CheckNamesExpressionAndPlace) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const int three = 3;
    EXPECT_DEATH(CHECK(three < 2), "bug: three < 2 is false at .*error_test.cpp:[0-9]+");
    CHECK(three > 2);
}

TEST(Error, KeepsWordsAndExitCode) {
    const Error error(Exit::Memory, "too much");
    EXPECT_STREQ(error.what(), "too much");
    EXPECT_EQ(int(error.exit), 7);
}

// Whatever it cites.
TEST(Error, IsOneLine) { EXPECT_STREQ(Error(Exit::Scene, "a\nb\tc\x1b[0m").what(), "a b c [0m"); }

}  // namespace
}  // namespace spindrift
