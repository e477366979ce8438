// Surfaces around the particles of files and of runs.
#include "app/shell.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
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
    // Of a flat top, away from the sides: root of the mean square of its heights, less their mean.
    double roughness(double top) const {
        double n = 0, sum = 0, squares = 0;
        for (const auto& p : points)
            if (p[1] > top - 0.015 && std::abs(p[0] - 0.4) < 0.25 && std::abs(p[2] - 0.4) < 0.25)
                ++n, sum += p[1] - top, squares += (p[1] - top) * (p[1] - top);
        return std::sqrt(squares / n - sum / n * (sum / n));
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

// Particles that lie as in a flow, not on a lattice; shapes that a surface may lose or break up.
// Anisotropic kernels make them flatter.
TEST_F(Surfaces, OfAnisotropicKernelsAreFlatterAndKeepVolumeAndSheets) {
    std::mt19937 random(1);
    std::normal_distribution<double> off(0, 0.15 * dx);
    const auto scattered = [&](const std::string& name, auto inside) {
        std::string text = "x,y,z\n";
        size_t n = 0;
        for (int i = 0; i < 40 * 40 * 40; ++i) {
            const double x = dx * (i % 40 + 0.5), y = dx * (i / 40 % 40 + 0.5),
                         z = dx * (i / 1600 + 0.5);
            if (!inside(x, y, z)) continue;
            text += fmt::format("{},{},{}\n", x + off(random), y + off(random), z + off(random));
            ++n;
        }
        write(name, text);
        return double(n) * dx * dx * dx;
    };
    struct Case {
        const char* name;
        double top, volume, share;  // m, m^3, of the spheres' roughness
    };
    const Case cases[] = {
        {"pool", 0.3, scattered("pool.csv", [](double, double y, double) { return y < 0.3; }), 0.8},
        {"sheet", 0.42,
         scattered("sheet.csv", [](double, double y, double) { return y > 0.4 && y < 0.4 + dx; }),
         1.1},
        {"sheets", 0.44,
         scattered("sheets.csv",
                   [](double, double y, double) { return y > 0.4 && y < 0.4 + 2 * dx; }),
         0.7},
        {"ball", 0,
         scattered("ball.csv",
                   [](double x, double y, double z) {
                       return std::hypot(x - 0.4, y - 0.4, z - 0.4) < 0.25;
                   }),
         0},
        {"drops", 0,
         scattered("drops.csv",
                   [](double x, double y, double z) {
                       const auto in = [](double at) { return int(at / dx) % 10 < 2; };
                       return in(x) && in(y) && in(z);
                   }),
         0}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        double rough[2];
        for (int k = 0; k < 2; ++k) {
            const Outcome outcome =
                call(fmt::format("surface {}.csv --out {}.obj --spacing 0.02 {}", c.name, c.name,
                                 k ? "--anisotropic" : ""));
            ASSERT_EQ(outcome.code, 0) << outcome.text;
            const Mesh mesh = readObj(folder_ / (std::string(c.name) + ".obj"));
            EXPECT_TRUE(mesh.isClosed());
            EXPECT_NEAR(mesh.volume(), c.volume, 0.02 * c.volume);
            rough[k] = mesh.roughness(c.top);
        }
        if (c.share > 0) {
            EXPECT_LT(rough[1], c.share * rough[0]) << rough[0] / dx << " spacings of spheres";
            EXPECT_LT(rough[1], 0.06 * dx);
        }
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

class SurfacesOfRuns : public Surfaces {
protected:
    const std::string run_ = "test/dam_break_small --headless --backend cpu --quiet --fps 50 ";

    std::set<std::string> surfaces(const std::string& folder) const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            names.insert(entry.path().filename().string());
        return names;
    }
};

// Those of its particles' files, at every frame.
TEST_F(SurfacesOfRuns, AreThoseOfTheirParticles) {
    for (const std::string method : {"", " --anisotropic"}) {
        const std::string knob = method.empty() ? "" : " --set output.surface_anisotropic=true";
        const Outcome outcome =
            call(run_ + "--time 0.06 --surface water.obj --series run.csv" + knob);
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        EXPECT_EQ(surfaces("water"),
                  (std::set<std::string>{"surface_00000.obj", "surface_00001.obj",
                                         "surface_00002.obj", "surface_00003.obj"}));
        for (int k = 0; k < 4; ++k) {
            SCOPED_TRACE(k);
            const Mesh mesh = readObj(folder_ / fmt::format("water/surface_{:05}.obj", k));
            EXPECT_TRUE(mesh.isClosed());
            const double volume = 2250 * 0.02 * 0.02 * 0.02;
            EXPECT_NEAR(mesh.volume(), volume, 0.02 * volume);
            const Outcome after =
                call(fmt::format("surface run/fluid_{:05}.csv --out after.obj --spacing {}{}", k,
                                 double(0.02f), method));
            ASSERT_EQ(after.code, 0) << after.text;
            const Mesh same = readObj(folder_ / "after.obj");
            ASSERT_EQ(same.triangles, mesh.triangles);
            ASSERT_EQ(same.points.size(), mesh.points.size());
            for (size_t i = 0; i < mesh.points.size(); ++i)
                for (size_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(same.points[i][c], mesh.points[i][c], 1e-6);
        }
    }
}

// Beside the series, in the same folder; a new run takes away what is left of an older one.
TEST_F(SurfacesOfRuns, GoIntoEveryFormatBesideTheSeries) {
    for (const std::string format : {"ply", "obj", "vdb"}) {
        fs::create_directory(folder_ / "run");
        write("run/surface_00009." + format, "of an older run");
        write("run/notes.txt", "mine");
        const Outcome outcome = call(run_ + "--time 0.02 --series run.ply --surface run." + format);
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        EXPECT_EQ(surfaces("run"),
                  (std::set<std::string>{"fluid_00000.ply", "fluid_00001.ply", "notes.txt",
                                         "surface_00000." + format, "surface_00001." + format}));
        fs::remove_all(folder_ / "run");
    }
}

TEST_F(SurfacesOfRuns, GoOnWhereTheRunBeforeEnded) {
    ASSERT_EQ(call(run_ + "--time 0.04 --checkpoint c.h5 --surface water.obj").code, 0);
    ASSERT_EQ(surfaces("water").size(), 3u);
    std::map<std::string, fs::file_time_type> before;
    for (const std::string& name : surfaces("water"))
        before[name] = fs::last_write_time(folder_ / "water" / name);
    const Outcome on =
        call("c.h5 --headless --backend cpu --quiet --fps 50 --time 0.08 --surface water.obj");
    ASSERT_EQ(on.code, 0) << on.text;
    EXPECT_EQ(surfaces("water").size(), 5u);
    for (const auto& [name, time] : before)
        EXPECT_EQ(fs::last_write_time(folder_ / "water" / name), time) << name;
    for (const char* name : {"water/surface_00003.obj", "water/surface_00004.obj"})
        EXPECT_TRUE(readObj(folder_ / name).isClosed());
}

// Where nothing has come yet there is a file without triangles.
TEST_F(SurfacesOfRuns, OfNoFluidAreEmpty) {
    write("tap.json", R"({"version": 2, "simulation": {"spacing": 0.02},
        "domain": {"max": [0.4, 0.4, 0.4]}, "fluid": {"bodies": []},
        "sources": [{"mouth": "disc", "center": [0.2, 0.3, 0.2], "normal": [0, -1, 0],
                     "radius": 0.05, "velocity": 1, "start": 0.5}]})");
    for (const std::string format : {"ply", "obj", "vdb"}) {
        const Outcome outcome = call(
            "tap.json --headless --backend cpu --quiet --steps 1 "
            "--surface water." +
            format);
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        EXPECT_TRUE(fs::exists(folder_ / ("water/surface_00000." + format)));
    }
}

TEST_F(SurfacesOfRuns, MistakesAreNamedBeforeItStarts) {
    expectMistake(run_ + "--surface water.stl", Exit::Output, "name it .ply, .obj or .vdb");
    expectMistake(run_ + "--surface water", Exit::Output, "name it .ply, .obj or .vdb");
    expectMistake(run_ +
                      "--surface water.ply --set simulation.spacing=2e-5 "
                      "--set domain.max=1e-3,1e-3,1e-3 "
                      "--set 'fluid.bodies=[{\"min\":[0,0,0],\"max\":[4e-4,4e-4,4e-4]}]'",
                  Exit::Usage, "are the smallest");
    write("notes", "mine");
    expectMistake(run_ + "--surface notes.ply", Exit::Output, "notes");
    expectMistake("poiseuille --headless --backend cpu --quiet --surface water.ply", Exit::Scene,
                  "needs three dimensions");
}

// Without its neighbour, the program says what is missing and how it comes there.
TEST_F(SurfacesOfRuns, NeedTheProgramBesideThisOne) {
    fs::copy(SPINDRIFT_PROGRAM, folder_ / "alone");
    const std::string command = "cd '" + folder_.string() + "' && ./alone " + run_ +
                                "--time 1 --csv run.csv --surface water.ply >said.txt 2>&1";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), int(Exit::Usage));
    const std::string said = slurp(folder_ / "said.txt");
    EXPECT_NE(said.find("water.ply: there is no spindrift-surface"), std::string::npos) << said;
    EXPECT_NE(said.find("apt-get install libopenvdb-dev"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_FALSE(fs::exists(folder_ / "run.csv"));
}

}  // namespace
}  // namespace spindrift
