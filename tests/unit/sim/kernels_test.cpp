// Kernels integrate to one, and their gradients are the derivatives of their values.
#define SPINDRIFT_REAL double
#define LANES kernelsTest
#include "sim/physics/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>
#include <vector>

namespace spindrift {
namespace {

template <class K> class Kernels : public testing::Test {};
using C2 = kernelsTest::WendlandC2Kernel;
using C4 = kernelsTest::WendlandC4Kernel;
using C6 = kernelsTest::WendlandC6Kernel;
using Cubic = kernelsTest::CubicSplineKernel;
using Quintic = kernelsTest::QuinticSplineKernel;
using All = testing::Types<C2, C4, C6, Cubic, Quintic>;
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
        EXPECT_NEAR(TypeParam::norm(3) * TypeParam::gradient(3) * TypeParam::g(q),
                    TypeParam::norm(3) * derivative / q, 1e-6)
            << q;
    }
    EXPECT_TRUE(std::isfinite(TypeParam::g(0.0)));
}

// poly6 is one to its integral; the gradients are those of the spiky kernel, and the Laplacian's
// sums see parabolas as they are.
TEST(Kernels, OfMuellerAreThreeOfOneNorm) {
    using M = kernelsTest::MuellerKernel;
    const int n = 100000;
    const double pi = 3.14159265358979323846;
    for (int d : {2, 3}) {
        double poly6 = 0, spiky = 0, laplacian = 0, position = 0;
        for (int k = 0; k < n; ++k) {
            const double q = (k + 0.5) / n, shell = (d == 2 ? 2 * pi * q : 4 * pi * q * q) / n;
            poly6 += shell * M::norm(d) * M::w(q);
            position -=
                shell * M::norm(d) * M::gradient(d) * M::g(q) * q * q / d;  // - integral x dW/dx
            laplacian +=
                shell * q * q / (2 * d) * (d == 2 ? 40 : 45) / pi * M::viscous(q);  // of |x|^2 / 2d
            spiky += shell * (d == 2 ? 10 : 15) / pi * std::pow(1 - q, 3);
        }
        EXPECT_NEAR(poly6, 1, 1e-8);
        EXPECT_NEAR(spiky, 1, 1e-8);
        EXPECT_NEAR(position, 1, 1e-8);
        EXPECT_NEAR(laplacian, 1, 1e-8);
        EXPECT_NEAR(M::norm(d) * M::gradient(d) * M::g(0.3) * 0.3,
                    -3 * (d == 2 ? 10 : 15) / pi * 0.49, 1e-12);
    }
    EXPECT_EQ(M::w(1.5) + M::g(1.5) + M::viscous(1.5), 0);
    EXPECT_TRUE(std::isfinite(M::g(0.0)));
}

// What sums over a lattice miss 1 by, in two and three dimensions: sum V W - 1 and -sum V x dW/dx
// - 1. Numbers of an independent computation with the standard kernels (case C1 of the validation),
// h = R / 2, of the quintic spline R / 3.
struct LatticeRow {
    int dimensions;
    double ratio, sum, gradient;
};
template <class K> extern const std::vector<LatticeRow> lattice;
template <> const std::vector<LatticeRow> lattice<C2> = {
    {2, 1.20, 1.795e-02, -3.615e-02}, {2, 1.30, 1.047e-02, -2.608e-02},
    {2, 1.50, 5.142e-03, -2.601e-03}, {2, 2.00, 1.206e-03, -8.007e-04},
    {3, 1.20, 1.746e-02, -1.477e-02}, {3, 1.30, 9.501e-03, -2.110e-02},
    {3, 1.50, 3.141e-03, 6.193e-04},  {3, 2.00, 5.486e-04, -5.873e-04},
};
template <> const std::vector<LatticeRow> lattice<C4> = {
    {2, 1.20, 1.311e-02, -2.236e-02}, {2, 1.30, 8.464e-03, -1.632e-02},
    {2, 1.50, 2.980e-03, -9.423e-03}, {2, 2.00, 4.158e-04, -1.313e-03},
    {3, 1.20, 1.344e-02, -1.559e-02}, {3, 1.30, 8.547e-03, -6.966e-03},
    {3, 1.50, 2.898e-03, -6.757e-03}, {3, 2.00, 3.059e-04, -6.337e-04},
};
template <> const std::vector<LatticeRow> lattice<C6> = {
    {2, 1.20, 2.050e-02, -7.686e-02}, {2, 1.30, 9.846e-03, -3.272e-02},
    {2, 1.50, 3.188e-03, -9.367e-03}, {2, 2.00, 2.513e-04, -7.378e-04},
    {3, 1.20, 2.976e-02, -7.779e-02}, {3, 1.30, 1.249e-02, -3.120e-02},
    {3, 1.50, 3.479e-03, -5.874e-03}, {3, 2.00, 2.050e-04, -3.602e-04},
};
template <> const std::vector<LatticeRow> lattice<Cubic> = {
    {2, 1.20, -2.427e-04, -9.207e-03}, {2, 1.30, -5.323e-05, 1.054e-02},
    {2, 1.50, 3.440e-03, 6.725e-03},   {2, 2.00, -4.239e-05, -8.998e-04},
    {3, 1.20, 8.095e-04, -1.831e-02},  {3, 1.30, -2.738e-03, -6.516e-03},
    {3, 1.50, 1.795e-03, 1.012e-02},   {3, 2.00, 7.918e-05, -4.935e-05},
};
template <> const std::vector<LatticeRow> lattice<Quintic> = {
    {2, 1.00, 6.322e-05, 7.954e-04},   {2, 1.20, -5.622e-05, -6.197e-04},
    {2, 1.30, -4.518e-05, 6.079e-04},  {2, 1.50, 1.551e-04, 1.567e-04},
    {2, 2.00, -7.708e-07, -6.722e-06}, {3, 1.00, -2.004e-05, 1.001e-03},
    {3, 1.20, 6.255e-06, -9.296e-04},  {3, 1.30, -1.243e-04, -1.694e-04},
    {3, 1.50, 7.672e-05, 4.136e-04},   {3, 2.00, 2.446e-07, 8.331e-07},
};

template <class K> void expectLattice(const LatticeRow& row) {
    const double R = (std::is_same_v<K, Quintic> ? 3 : 2) * row.ratio;  // dx = 1
    const int n = int(R) + 1, across = row.dimensions == 3 ? n : 0;
    double sum = 0, gradient = 0;
    for (int z = -across; z <= across; ++z)
        for (int y = -n; y <= n; ++y)
            for (int x = -n; x <= n; ++x) {
                const double q = std::sqrt(double(x * x + y * y + z * z)) / R;
                sum += K::norm(row.dimensions) / std::pow(R, row.dimensions) * K::w(q);
                gradient -= K::norm(row.dimensions) / std::pow(R, row.dimensions + 2) *
                            K::gradient(row.dimensions) * K::g(q) * x * x;
            }
    // The table has four digits.
    EXPECT_NEAR(sum - 1, row.sum, 6e-4 * std::abs(row.sum)) << row.dimensions << " " << row.ratio;
    EXPECT_NEAR(gradient - 1, row.gradient, 6e-4 * std::abs(row.gradient))
        << row.dimensions << " " << row.ratio;
}

TYPED_TEST(Kernels, MissOneOnALatticeByWhatTheTableSays) {
    EXPECT_GE(lattice<TypeParam>.size(), 8u);
    for (const LatticeRow& row : lattice<TypeParam>) expectLattice<TypeParam>(row);
}

}  // namespace
}  // namespace spindrift
