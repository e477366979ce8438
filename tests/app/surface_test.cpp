// Surfaces around the particles of files.
#include "app/shell.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

namespace spindrift {
namespace {

struct Mesh {
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<int, 3>> triangles;

    // Every edge has a triangle on either side, wound the same way.
    bool isClosed() const {
        std::map<std::pair<int, int>, int> edges;
        for (const auto& t : triangles)
            for (size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
        for (const auto& [edge, count] : edges)
            if (edges.find({edge.second, edge.first}) == edges.end()) return false;
        return !triangles.empty();
    }
    double volume() const {
        double six = 0;
        for (const auto& t : triangles) {
            const auto &a = points[size_t(t[0])], &b = points[size_t(t[1])],
                       &c = points[size_t(t[2])];
            six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
        return six / 6;
    }
};

Mesh readObj(const fs::path& path) {
    Mesh mesh;
    std::istringstream file(slurp(path));
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(std::min<size_t>(2, line.size())));
        if (line.starts_with("v ")) {
            auto& p = mesh.points.emplace_back();
            words >> p[0] >> p[1] >> p[2];
        } else if (line.starts_with("f ")) {
            auto& t = mesh.triangles.emplace_back();
            words >> t[0] >> t[1] >> t[2];
            for (int& corner : t) --corner;
        }
    }
    return mesh;
}

class Surfaces : public Shell {
protected:
    void SetUp() override {
        const Outcome outcome = call("surface " + ball("any.csv"));
        if (outcome.text.find("no spindrift-surface") != std::string::npos)
            GTEST_SKIP() << outcome.text;
    }
    // Particles of a lattice that are within a shape, as another program might write them.
    template <class Inside> std::string lattice(const std::string& name, Inside inside) const {
        std::string text = "x,y,z\n";
        for (int i = 0; i < 40; ++i)
            for (int j = 0; j < 40; ++j)
                for (int k = 0; k < 40; ++k) {
                    const double x = dx * (i + 0.5), y = dx * (j + 0.5), z = dx * (k + 0.5);
                    if (inside(x, y, z)) text += fmt::format("{},{},{}\n", x, y, z);
                }
        return write(name, text);
    }
    std::string ball(const std::string& name) const {
        return lattice(name, [](double x, double y, double z) {
            return std::hypot(x - 0.4, y - 0.4, z - 0.4) < 0.25;
        });
    }
    static constexpr double dx = 0.02;
};

TEST_F(Surfaces, OfABallIsRoundClosedAndOfItsVolume) {
    const Outcome outcome = call("surface " + ball("ball.csv") + " --out ball.obj");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const Mesh mesh = readObj(folder_ / "ball.obj");
    EXPECT_TRUE(mesh.isClosed());
    const double volume = 4 * M_PI / 3 * 0.25 * 0.25 * 0.25;
    EXPECT_NEAR(mesh.volume(), volume, 0.02 * volume);
    double least = 1, most = 0;
    for (const auto& p : mesh.points) {
        const double r = std::hypot(p[0] - 0.4, p[1] - 0.4, p[2] - 0.4);
        least = std::min(least, r), most = std::max(most, r);
    }
    EXPECT_GT(least, 0.25 - 0.6 * dx) << "a lattice's ball has steps of half a spacing";
    EXPECT_LT(most, 0.25 + 0.6 * dx);
}

// The top of a pool is flat, and a sheet of one layer has no holes.
TEST_F(Surfaces, AreFlatWhereFluidIsAndKeepSheets) {
    lattice("pool.csv", [](double, double y, double) { return y < 0.3; });
    lattice("sheet.csv", [](double, double y, double) { return y > 0.4 && y < 0.4 + dx; });
    const Outcome outcome =
        call("surface pool.csv sheet.csv --format obj --out meshes --spacing 0.02");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    for (const auto& [name, low, volume] :
         {std::tuple{"pool.obj", 0.3, 0.8 * 0.3 * 0.8}, {"sheet.obj", 0.42, 0.8 * dx * 0.8}}) {
        SCOPED_TRACE(name);
        const Mesh mesh = readObj(folder_ / "meshes" / name);
        EXPECT_TRUE(mesh.isClosed());
        EXPECT_NEAR(mesh.volume(), volume, 0.02 * volume);
        double least = 1, most = 0;
        for (const auto& p : mesh.points)
            if (p[1] > low - 0.5 * dx && std::abs(p[0] - 0.4) < 0.2 && std::abs(p[2] - 0.4) < 0.2)
                least = std::min(least, p[1]), most = std::max(most, p[1]);
        EXPECT_LT(most - least, 0.1 * dx) << "flat";
        EXPECT_NEAR(most, low, 0.5 * dx);
    }
}

TEST_F(Surfaces, GoIntoEveryFormat) {
    ball("ball.csv");
    ASSERT_EQ(call("surface ball.csv").code, 0);
    EXPECT_TRUE(slurp(folder_ / "ball.ply").starts_with("ply\nformat binary_little_endian"));
    ASSERT_EQ(call("surface ball.csv --out ball.vdb").code, 0);
    EXPECT_NE(slurp(folder_ / "ball.vdb").find("surface"), std::string::npos);
    ASSERT_EQ(call("test/dam_break_small --headless --backend cpu --quiet --steps 5 "
                   "--set output.particles=p.h5")
                  .code,
              0);
    const Outcome own = call("surface p.h5");
    EXPECT_EQ(own.code, 0) << own.text;
    EXPECT_TRUE(fs::exists(folder_ / "p.ply"));
}

TEST_F(Surfaces, MistakesAreNamed) {
    write("one.csv", "x,y,z\n0,0,0\n0,0,1\n");
    ball("ball.csv");
    expectMistake("surface nowhere.csv", Exit::Scene, "nowhere.csv");
    expectMistake("surface one.csv", Exit::Usage, "give --spacing");
    expectMistake("surface ball.csv --out ball.stl", Exit::Usage, "take ply, obj or vdb");
    expectMistake("surface ball.csv --format png", Exit::Usage, "take ply, obj or vdb");
    expectMistake("surface ball.csv --format ply --out x.obj", Exit::Usage, "x.obj is no ply");
    expectMistake("surface ball.csv one.csv --out x.obj", Exit::Usage, "name a folder");
    lattice("flat.csv", [](double, double, double z) { return z < dx; });
    expectMistake("surface flat.csv", Exit::Usage, "lie in a plane");
    fs::create_directory(folder_ / "other");
    fs::copy(folder_ / "ball.csv", folder_ / "other" / "ball.csv");
    expectMistake("surface ball.csv other/ball.csv --out all", Exit::Usage, "would become");
    expectMistake("surface ball.csv --out nowhere/ball.ply", Exit::Output, "nowhere/ball.ply");
}

}  // namespace
}  // namespace spindrift
