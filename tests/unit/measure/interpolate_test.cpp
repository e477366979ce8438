// Between the particles: linear fields exactly, also at the rim and where particles lie in a plane
// or a line.
#include "measure/interpolate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace spindrift {
namespace {

std::vector<Particle> cloud(int dimensions) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Particle> particles;
    for (int i = 0; i < 800; ++i) {
        Particle p;
        p.id = i;
        p.position = {unit(random), dimensions > 1 ? unit(random) : 0.5,
                      dimensions > 2 ? unit(random) : 0.5};
        p.velocity = {2 + 3 * p.position.x - p.position.y, p.position.z, -1};
        p.pressure = 7 - 5 * p.position.x + 2 * p.position.y;
        particles.push_back(p);
    }
    return particles;
}

TEST(Interpolate, LinearFieldsExactlyInEveryDimension) {
    for (int dimensions : {1, 2, 3}) {
        for (Vec3d x : {Vec3d{0.4, 0.5, 0.5}, Vec3d{0.01, 0.5, 0.5}}) {
            const Fields f = interpolate(cloud(dimensions), {x}, 0.3)[0];
            EXPECT_GT(f.neighbours, 10);
            EXPECT_NEAR(f.velocity.x, 2 + 3 * x.x - x.y, 1e-9) << dimensions;
            EXPECT_NEAR(f.velocity.z, -1, 1e-9);
            EXPECT_NEAR(f.pressure, 7 - 5 * x.x + 2 * x.y, 1e-9) << dimensions;
        }
    }
}

TEST(Interpolate, OneNeighbourGivesItsValueNoneNothing) {
    Particle p;
    p.position = {0, 0, 0}, p.pressure = 3;
    const std::vector<Fields> f = interpolate({p}, {{0.1, 0, 0}, {5, 0, 0}}, 0.3);
    EXPECT_DOUBLE_EQ(f[0].pressure, 3);
    EXPECT_EQ(f[1].neighbours, 0);
    EXPECT_EQ(f[1].pressure, 0);
}

TEST(Interpolate, OneQuantityAloneIsTheSame) {
    for (int dimensions : {1, 2, 3}) {
        const std::vector<Particle> particles = cloud(dimensions);
        std::vector<Sample> samples;
        for (const Particle& p : particles) samples.push_back({p.position, p.pressure});
        const std::vector<Vec3d> points = {{0.4, 0.5, 0.5}, {0.01, 0.5, 0.5}, {5, 0, 0}};
        const auto fields = interpolate(particles, points, 0.3, Order::Mean);
        const auto alone = interpolate(samples, PointsNear(points, 0.3));
        for (size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(alone[i].value, fields[i].pressure, 1e-12);
        EXPECT_GT(alone[0].weight, 1);
        EXPECT_EQ(alone[2].weight, 0);
    }
}

}  // namespace
}  // namespace spindrift
