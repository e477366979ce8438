// Kernels integrate to one, and their gradients are the derivatives of their values.
#define SPINDRIFT_REAL double
#define LANES kernelsTest
#include "sim/kernels.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

template <class K> class Kernels : public testing::Test {};
using All = testing::Types<kernelsTest::WendlandC2Kernel, kernelsTest::CubicSplineKernel>;
TYPED_TEST_SUITE(Kernels, All);

TYPED_TEST(Kernels, IntegrateToOne) {
    const int n = 100000;
    double disc = 0, ball = 0;
    for (int k = 0; k < n; ++k) {
        const double q = (k + 0.5) / n;
        disc += 2 * 3.14159265358979323846 * q * TypeParam::norm(2) * TypeParam::w(q) / n;
        ball += 4 * 3.14159265358979323846 * q * q * TypeParam::norm(3) * TypeParam::w(q) / n;
    }
    EXPECT_NEAR(disc, 1, 1e-8);
    EXPECT_NEAR(ball, 1, 1e-8);
}

TYPED_TEST(Kernels, VanishBeyondTheSupport) {
    for (double q : {1.0, 1.5, 1e6}) {
        EXPECT_EQ(TypeParam::w(q), 0);
        EXPECT_EQ(TypeParam::g(q), 0);
    }
}

// grad W = norm/R^(d+2) w'(q)/q x
TYPED_TEST(Kernels, GradientIsTheDerivative) {
    for (double q = 0.01; q < 1; q += 0.037) {
        const double e = 1e-6, derivative = (TypeParam::w(q + e) - TypeParam::w(q - e)) / (2 * e);
        EXPECT_NEAR(TypeParam::gradient * TypeParam::g(q), derivative / q, 1e-6) << q;
    }
    EXPECT_TRUE(std::isfinite(TypeParam::g(0.0)));
}

}  // namespace
}  // namespace spindrift
