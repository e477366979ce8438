// Right-handed vectors.
#include "core/vec.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

TEST(Vec, IndexReachesEachComponent) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = float(k + 1);
    EXPECT_EQ(v, (Vec3{1, 2, 3}));
}

TEST(Vec, CrossIsRightHandedAndPerpendicular) {
    EXPECT_EQ(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), (Vec3{0, 0, 1}));
    const Vec3d a{1, 2, 3}, b{-2, 5, 0.5};
    EXPECT_EQ(dot(cross(a, b), a), 0);
    EXPECT_EQ(dot(cross(a, b), b), 0);
}

TEST(Vec, NormalizedHasLengthOneAndTheSameDirection) {
    const Vec3d v = normalized(Vec3d{3, 0, -4});
    EXPECT_DOUBLE_EQ(length(v), 1);
    EXPECT_DOUBLE_EQ(v.x, 0.6);
    EXPECT_DOUBLE_EQ(v.z, -0.8);
}

}  // namespace
}  // namespace spindrift
