// Bugs abort with their place; mistakes say what they are about.
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

TEST(Error, KeepsWordsAndKind) {
    const Error error(Failure::Memory, "too much");
    EXPECT_STREQ(error.what(), "too much");
    EXPECT_EQ(error.failure, Failure::Memory);
}

// Whatever it cites.
TEST(Error, IsOneLine) {
    EXPECT_STREQ(Error(Failure::Scene, "a\nb\tc\x1b[0m").what(), "a b c [0m");
}

}  // namespace
}  // namespace spindrift
