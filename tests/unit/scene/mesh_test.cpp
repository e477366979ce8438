// Triangles from files: what is read, what is refused, how far away they are and what they weigh.
#include "core/error.h"
#include "meshes.h"
#include "scene/check.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/mesh.h"
#include "scene/particles.h"
#include "scene/sample_solid.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <random>

namespace spindrift {
namespace {

std::string fileOf(const std::string& text, const std::string& name = "surface.obj") {
    const std::string path = testing::TempDir() + "/" + name;
    std::ofstream(path) << text;
    return path;
}
std::string complaint(const std::string& text) {
    static int count = 0;
    try {
        readMesh(fileOf(text, "wrong" + std::to_string(count++) + ".obj"));
        return "";
    } catch (const Error& e) { return e.what(); }
}
Mesh meshOf(const Surface& s) {
    std::vector<Mesh::Triangle> triangles;
    for (const auto& f : s.faces)
        for (size_t k = 2; k < f.size(); ++k) triangles.push_back({f[0], f[k - 1], f[k]});
    return Mesh("surface", s.vertices, triangles);
}
// A ring about y.
Surface torusSurface(double ring, double tube, int around, int across) {
    Surface s;
    const double pi = std::numbers::pi;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double a = 2 * pi * i / around, b = 2 * pi * j / across,
                         r = ring + tube * std::cos(b);
            s.vertices.push_back({r * std::cos(a), tube * std::sin(b), r * std::sin(a)});
            auto at = [&](int u, int v) { return (u % around) * across + v % across; };
            s.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    return s;
}
Vec3d randomPoint(std::mt19937& random, Vec3d low, Vec3d high) {
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = low[k] + (high[k] - low[k]) * (random() / 4294967296.0);
    return p;
}
// Of a box about 0.
double distanceFromBox(Vec3d half, Vec3d p) {
    Vec3d out;
    double most = -1e300;
    for (int k = 0; k < 3; ++k) {
        const double d = std::abs(p[k]) - half[k];
        most = std::max(most, d), out[k] = std::max(d, 0.0);
    }
    return most > 0 ? length(out) : most;
}

TEST(Meshes, AreReadInAllWritings) {
    // Quads, numbers of texture and normal, numbers from the end, corners twice, lines that are
    // none of ours, the ends of lines of another system.
    const std::string box =
        "# made by hand\r\nmtllib a.mtl\r\no box\nv 0 0 0\nv 2 0 0 1.0\nv 2 3 0\nv\t0 3  0\nvt 0.5 "
        "0.5\nvn 0 0 1\n"
        "v 0 0 4e0\nv 2 0 +4\nv 2 3 4\nv 0 3 4\nv 0 0 0\ns off\nf 9 4 3 2\nf 5/1 6/1 7/1 8/1\nf "
        "1//1 2//1 6//1 5//1\nf 2/1/1 3/1/1 7/1/1 6/1/1\n"
        "f -7 -6 -2 -3\nf 4 1 5 8\n";
    const Mesh mesh = *readMesh(fileOf(box));
    EXPECT_EQ(mesh.triangles().size(), 12u);
    EXPECT_EQ(mesh.low(), (Vec3d{0, 0, 0}));
    EXPECT_EQ(mesh.high(), (Vec3d{2, 3, 4}));
    EXPECT_NEAR(mesh.weigh().volume, 24, 1e-12);
    EXPECT_NEAR(mesh.area(), 52, 1e-12);
    EXPECT_NEAR(mesh.nearest({1, 1, 1}).distance, -1, 1e-12);
}

TEST(Meshes, AreReadAnewWhenTheFileChanges) {
    const std::string path =
        boxSurface({0, 0, 0}, {1, 1, 1}).write(testing::TempDir() + "/changing.obj");
    EXPECT_EQ(readMesh(path)->high().x, 1);
    EXPECT_EQ(readMesh(path), readMesh(path));
    boxSurface({0, 0, 0}, {2.5, 1, 1}).write(path);
    EXPECT_EQ(readMesh(path)->high().x, 2.5);
}

TEST(Meshes, MistakesAreNamed) {
    const std::string box = boxSurface({0, 0, 0}, {1, 1, 1}).text();
    Surface open = boxSurface({0, 0, 0}, {1, 1, 1}), membrane = open;
    open.faces.pop_back();
    membrane.faces.push_back({0, 1, 7, 6});
    // The projective plane in six corners: closed, and nothing can be behind it.
    Surface moebius;
    moebius.vertices = {{0, 0, 1},        {1, 0, 0},          {0.3, 1, 0.1},
                        {-0.8, 0.6, 0.3}, {-0.8, -0.6, -0.2}, {0.3, -1, 0.4}};
    moebius.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                     {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
    EXPECT_EQ(complaint(box), "");
    const std::pair<std::string, const char*> mistakes[] = {
        {"v 0 0\n", "line 1: z = \"\" is no number"},
        {"v 0 0 1e999\n", "line 1: z = \"1e999\" is no number"},
        {"v 0 nan 1\n", "line 1: y = \"nan\" is no number"},
        {"\nv 2e9 0 1\n", "line 2: x = 2e+09 is farther than 1e+09 from 0"},
        {"v 0 0 0\nf 1 1 2\n", "line 2: vertex 2 of 1"},
        {"v 0 0 0\nf 1 1 -2\n", "line 2: vertex -2 of 1"},
        {"v 0 0 0\nf 0 1 1\n", "line 2: \"0\" is no corner"},
        {"v 0 0 0\nf 1 1 a/1\n", "line 2: \"a/1\" is no corner"},
        {"v 0 0 0\nf 1 1\n", "a face of 2 corners"},
        {"v 0 0 0\n", "has no faces"},
        {"v 0 0 0\nf 1 1 1\n", "encloses no volume"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", "belongs to one triangle"},
        {open.text(),
         "is not closed: the edge from (0, 0, 1) to (1, 0, 1) belongs to one triangle"},
        {open.text(), "4 such edges"},
        {membrane.text(), "belongs to 3 triangles"},
        {moebius.text(), "has one side only"},
    };
    for (const auto& [text, words] : mistakes)
        EXPECT_NE(complaint(text).find(words), std::string::npos) << complaint(text);
    EXPECT_THROW(readMesh("/nowhere/a.obj"), Error);
    EXPECT_THROW(readMesh(testing::TempDir()), Error);
    EXPECT_THROW(readMesh("/dev/zero"), Error);
    EXPECT_THROW(readMesh(""), Error);
}

TEST(Meshes, InsideOutOnesAreTurned) {
    Surface s = sphereSurface({0, 0, 0}, 1, 2);
    for (auto& f : s.faces) std::reverse(f.begin(), f.end());
    const Mesh mesh = meshOf(s);
    EXPECT_GT(mesh.weigh().volume, 3.5);
    EXPECT_LT(mesh.nearest({0, 0, 0}).distance, -0.9);
    EXPECT_GT(mesh.nearest({0, 0, 2}).distance, 0.9);
}

TEST(Meshes, DistancesAreThoseOfABoxAndASphere) {
    std::mt19937 random(1);
    const Vec3d half{0.5, 0.3, 0.2};
    const Mesh box = meshOf(boxSurface(-1.0 * half, half));
    for (int k = 0; k < 3000; ++k) {
        const Vec3d p = randomPoint(random, {-1, -1, -1}, {1, 1, 1});
        const Mesh::Nearest n = box.nearest(p);
        ASSERT_NEAR(n.distance, distanceFromBox(half, p), 1e-12);
        // The normal leads away from the surface.
        ASSERT_NEAR(box.nearest(p - n.distance * n.normal).distance, 0, 1e-12);
        ASSERT_NEAR(length(n.normal), 1, 1e-12);
    }
    const Mesh sphere = meshOf(sphereSurface({0.1, 0, 0}, 1, 5));
    for (int k = 0; k < 1000; ++k) {
        const Vec3d p = randomPoint(random, {-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5});
        ASSERT_NEAR(sphere.nearest(p).distance, length(p - Vec3d{0.1, 0, 0}) - 1, 1e-3);
    }
}

// Against all triangles one by one; signs by a ray that counts how often it goes through. A torus
// is not convex anywhere inside.
TEST(Meshes, DistancesAreThoseOfTheNearestTriangle) {
    const Surface s = torusSurface(1, 0.4, 20, 12);
    const Mesh mesh = meshOf(s);
    std::mt19937 random(2);
    auto distanceTo = [&](const Mesh::Triangle& t, Vec3d p) {  // over a fine net of its points
        double best = 1e300;
        constexpr int N = 60;
        for (int i = 0; i <= N; ++i)
            for (int j = 0; i + j <= N; ++j) {
                const Vec3d a = mesh.vertices()[size_t(t[0])], b = mesh.vertices()[size_t(t[1])],
                            c = mesh.vertices()[size_t(t[2])];
                best = std::min(
                    best, length(p - (a + (double(i) / N) * (b - a) + (double(j) / N) * (c - a))));
            }
        return best;
    };
    auto inside = [&](Vec3d p) {
        const Vec3d way = normalized(Vec3d{0.318, 0.559, 0.766});
        int crossed = 0;
        for (const Mesh::Triangle& t : mesh.triangles()) {
            const Vec3d a = mesh.vertices()[size_t(t[0])], ab = mesh.vertices()[size_t(t[1])] - a,
                        ac = mesh.vertices()[size_t(t[2])] - a;
            const Vec3d h = cross(way, ac);
            const double det = dot(ab, h), u = dot(p - a, h) / det,
                         v = dot(way, cross(p - a, ab)) / det,
                         far = dot(ac, cross(p - a, ab)) / det;
            crossed += u >= 0 && v >= 0 && u + v <= 1 && far > 0;
        }
        return crossed % 2 == 1;
    };
    int triangle = -1, insides = 0;  // handed on: must change nothing
    for (int k = 0; k < 60; ++k) {
        const Vec3d p = randomPoint(random, {-1.6, -0.6, -1.6}, {1.6, 0.6, 1.6});
        const double d = mesh.nearest(p, triangle).distance;
        double brute = 1e300;
        for (const Mesh::Triangle& t : mesh.triangles()) brute = std::min(brute, distanceTo(t, p));
        EXPECT_NEAR(std::abs(d), brute, 0.01);
        EXPECT_LE(std::abs(d), brute + 1e-12);
        EXPECT_EQ(d, mesh.nearest(p).distance);
    }
    for (int k = 0; k < 5000; ++k) {
        const Vec3d p = randomPoint(random, {-1.6, -0.6, -1.6}, {1.6, 0.6, 1.6});
        insides += inside(p);
        ASSERT_EQ(mesh.nearest(p).distance < 0, inside(p)) << p.x << " " << p.y << " " << p.z;
    }
    EXPECT_GT(insides, 500);
}

// Beyond a sharp corner or edge the nearest faces disagree about which side is outside.
TEST(Meshes, SharpOnesHaveTheRightSides) {
    Surface needle;
    needle.vertices = {{0, 0, 0}, {1, 0.02, 0}, {1, -0.02, 0.03}, {1, 0, -0.03}};
    needle.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const Mesh mesh = meshOf(needle);
    std::mt19937 random(3);
    for (int k = 0; k < 20000; ++k) {
        const Vec3d p = randomPoint(random, {-0.3, -0.06, -0.06}, {1.1, 0.06, 0.06});
        bool inside = true;
        for (const Mesh::Triangle& t : mesh.triangles()) {
            const Vec3d a = mesh.vertices()[size_t(t[0])], b = mesh.vertices()[size_t(t[1])],
                        c = mesh.vertices()[size_t(t[2])];
            inside &= dot(cross(b - a, c - a), p - a) < 0;
        }
        ASSERT_EQ(mesh.nearest(p).distance < 0, inside) << p.x << " " << p.y << " " << p.z;
    }
}

TEST(Meshes, WeighWhatTheirSolidsWeigh) {
    const Mesh::Weight box = meshOf(boxSurface({1, 2, 3}, {3, 3, 3.5})).weigh();
    EXPECT_NEAR(box.volume, 1, 1e-12);
    EXPECT_NEAR(length(box.centroid - Vec3d{2, 2.5, 3.25}), 0, 1e-12);
    EXPECT_NEAR(box.inertia[0][0], (1 + 0.25) / 12, 1e-12);
    EXPECT_NEAR(box.inertia[1][1], (4 + 0.25) / 12, 1e-12);
    EXPECT_NEAR(box.inertia[2][2], (4 + 1) / 12.0, 1e-12);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_TRUE(i == j || std::abs(box.inertia[i][j]) < 1e-12);
    const Mesh::Weight sphere = meshOf(sphereSurface({5, 0, 0}, 2, 5)).weigh();
    const double pi = std::numbers::pi, volume = 4 * pi / 3 * 8;
    EXPECT_NEAR(sphere.volume / volume, 1, 2e-3);
    EXPECT_NEAR(sphere.inertia[1][1] / (0.4 * volume * 4), 1, 4e-3);
    // One that is not symmetric.
    Surface corner;
    corner.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    corner.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const Mesh::Weight quarter = meshOf(corner).weigh();
    EXPECT_NEAR(quarter.centroid.x, 0.25, 1e-12);
    EXPECT_NEAR(quarter.inertia[0][0], 2 * (1 / 60.0 - 1 / 96.0), 1e-12);
    EXPECT_NEAR(quarter.inertia[0][1], 1 / 96.0 - 1 / 120.0, 1e-12);
    // A box that is turned by 45 degrees about z has products of inertia: of half the difference.
    Surface turned = boxSurface({-1, -0.5, -0.5}, {1, 0.5, 0.5});
    for (Vec3d& p : turned.vertices)
        p = std::sqrt(0.5) * Vec3d{p.x - p.y, p.x + p.y, std::sqrt(2.0) * p.z};
    const Mesh::Weight w = meshOf(turned).weigh();
    EXPECT_NEAR(w.inertia[0][1], -0.5 * 2 * (4 + 1 - 1 - 1) / 12.0, 1e-9);
}

TEST(Meshes, ThinOnesAreFound) {
    EXPECT_EQ(meshOf(boxSurface({0, 0, 0}, {1, 1, 1})).thinnest(0.1).thickness, 0.1);
    EXPECT_NEAR(meshOf(boxSurface({0, 0, 0}, {1, 0.03, 1})).thinnest(0.1).thickness, 0.03, 1e-12);
    EXPECT_NEAR(meshOf(torusSurface(1, 0.02, 60, 12)).thinnest(0.1).thickness, 0.04, 0.004);
}

// Near the surface they are exact, elsewhere on the right side and never too far.
TEST(Meshes, FieldsHoldTheirDistances) {
    for (const Mesh& mesh :
         {meshOf(torusSurface(1, 0.4, 40, 24)), meshOf(sphereSurface({3, 2, 1}, 1, 3))}) {
        const double spacing = mesh.fieldSpacing(0.06);
        EXPECT_EQ(spacing, 0.03);
        const DistanceField f = mesh.field(spacing);
        const Vec3d middle = 0.5 * (mesh.low() + mesh.high());
        std::mt19937 random(4);
        int near = 0;
        for (int k = 0; k < 20000; ++k) {
            const Int3 at{int(random() % unsigned(f.nodes.x)), int(random() % unsigned(f.nodes.y)),
                          int(random() % unsigned(f.nodes.z))};
            const double distance =
                f.distances[(size_t(at.z) * size_t(f.nodes.y) + size_t(at.y)) * size_t(f.nodes.x) +
                            size_t(at.x)];
            const double exact =
                mesh.nearest(middle + f.low +
                             spacing * Vec3d{double(at.x), double(at.y), double(at.z)})
                    .distance;
            ASSERT_EQ(distance < 0, exact < 0);
            ASSERT_TRUE(distance < exact + 1e-6 || exact < 0) << distance << " " << exact;
            if (std::abs(exact) > 5 * spacing) continue;
            ++near;
            ASSERT_NEAR(distance, exact, 1e-6);
        }
        EXPECT_GT(near, 1000);
    }
    // A thin wall asks for a finer one, and too fine a one is refused.
    EXPECT_NEAR(meshOf(boxSurface({0, 0, 0}, {1, 0.03, 1})).fieldSpacing(0.1), 0.015, 1e-9);
    EXPECT_THROW(meshOf(boxSurface({0, 0, 0}, {1, 0.0003, 1})).fieldSpacing(0.1), Error);
}

Solid solidOf(const std::string& path) {
    Solid s;
    s.shape = Shape::Mesh, s.path = path;
    return s;
}

TEST(Meshes, ArePlacedByScaleAndOffset) {
    Solid solid = solidOf(boxSurface({-100, 0, -100}, {100, 300, 100})
                              .write(testing::TempDir() + "/millimetres.obj"));
    solid.scale = 0.001f, solid.offset = {0.5, 0.1, 0.5};
    const Convex shape = convexOf(solid, 3);
    EXPECT_NEAR(shape.middle.y, 0.25, 1e-6);
    EXPECT_NEAR(halfExtent(solid).y, 0.15, 1e-6);
    EXPECT_NEAR(shape.nearest({0, 0.1, 0}).distance, -0.05, 1e-6);
    EXPECT_NEAR(shape.nearest({0.12, 0, 0}).distance, 0.02, 1e-6);
}

// A lattice in a box, as a block of the same size has; of other shapes layers whose volume is
// theirs.
TEST(Meshes, HaveParticlesInLayers) {
    Scene scene;
    scene.simulation.spacing = 0.02f;
    scene.domain.max = {1, 1, 1};
    Solid box = solidOf(dentedBoxSurface({0.2, 0.2, 0.2}, {0.6, 0.5, 0.6})
                            .write(testing::TempDir() + "/layers.obj")),
          block;
    block.min = {0.2f, 0.2f, 0.2f}, block.max = {0.6f, 0.5f, 0.6f};
    const SolidSample a = sampleSolid(scene, box), b = sampleSolid(scene, block);
    EXPECT_EQ(a.positions.size(), b.positions.size());
    const double sumA = std::accumulate(a.volumes.begin(), a.volumes.end(), 0.0),
                 sumB = std::accumulate(b.volumes.begin(), b.volumes.end(), 0.0);
    EXPECT_NEAR(sumA, sumB, 1e-3 * sumB);
    const Solid ball =
        solidOf(sphereSurface({0.5, 0.5, 0.5}, 0.2, 4).write(testing::TempDir() + "/ball.obj"));
    const SolidSample c = sampleSolid(scene, ball);
    const double pi = std::numbers::pi, depth = 0.02 * boundaryLayers(scene),
                 layers = 4 * pi / 3 * (std::pow(0.2, 3) - std::pow(0.2 - depth, 3));
    EXPECT_NEAR(std::accumulate(c.volumes.begin(), c.volumes.end(), 0.0) * std::pow(0.02, 3),
                layers, 0.05 * layers);
    for (Vec3 p : c.positions) ASSERT_LT(length(toDouble(p) - Vec3d{0.5, 0.5, 0.5}), 0.2 + 0.002);
    for (const Solid& s : {box, ball}) {
        scene.solids = {s};
        EXPECT_LE(int64_t(sampleSolid(scene, s).positions.size()), countParticles(scene).walls);
        scene.fluid.bodies = {Body{{.max{1, 1, 1}}}};
        const Convex shape = convexOf(s, 3);
        const Placement p = placeParticles(scene);
        for (Vec3 x : p.positions) ASSERT_GT(shape.nearest(toDouble(x) - shape.middle).distance, 0);
        const double left = 1 - double(p.positions.size()) * std::pow(0.02, 3),
                     volume = shape.mesh->weigh().volume;
        EXPECT_NEAR(left, volume, 0.08 * volume);
    }
}

TEST(Meshes, ScenesNameTheirMistakes) {
    const std::string path =
        boxSurface({0.2, 0.2, 0.2}, {0.6, 0.5, 0.6}).write(testing::TempDir() + "/solid.obj");
    auto refusal = [&](const std::string& solid,
                       const std::string& more = "name=a") -> std::string {
        Scene scene;
        try {
            setKnob(scene, "solids=[" + solid + "]");
            setKnob(scene, more);
            checkScene(scene, "a");
            return "";
        } catch (const Error& e) { return e.what(); }
    };
    const std::string mesh = R"({"shape": "mesh", "path": ")" + path + "\"";
    EXPECT_EQ(refusal(mesh + "}"), "");
    EXPECT_NE(refusal(R"({"shape": "mesh"})").find("solids[0].path: \"\": no file is named"),
              std::string::npos)
        << refusal(R"({"shape": "mesh"})");
    EXPECT_NE(refusal(R"({"shape": "mesh", "path": "none.obj"})")
                  .find("solids[0].path: none.obj: can't be read"),
              std::string::npos);
    EXPECT_NE(refusal(mesh + "}", "simulation.dimensions=2")
                  .find("solids[0].shape: a mesh has three dimensions"),
              std::string::npos);
    EXPECT_NE(refusal(mesh + R"(, "scale": 1e6})")
                  .find("solids[0].scale: the mesh is 4e+05 m large, the domain 1.6 m; lower it"),
              std::string::npos);
    EXPECT_NE(
        refusal(mesh + R"(, "scale": 1000})").find("if the file is in millimetres, set it to 1"),
        std::string::npos);
    const std::string outside = refusal(mesh + R"(, "offset": [5, 0, 0]})");
    EXPECT_NE(outside.find("solids[0].offset: the mesh lies from"), std::string::npos) << outside;
    EXPECT_NE(outside.find("would put it into the domain's middle"), std::string::npos) << outside;
    EXPECT_NE(refusal(mesh + "}", R"(fluid.bodies=[{"shape": "mesh", "path": "none.obj"}])")
                  .find("fluid.bodies[0].path: none.obj: can't be read"),
              std::string::npos);
    EXPECT_NE(
        refusal(mesh + "}", "domain.max=[500000, 1, 1]").find("where numbers are 0.06 m apart"),
        std::string::npos);
    // A scene's mesh is beside it, and the saved scene knows where that was.
    std::ofstream(testing::TempDir() + "/scene.json")
        << R"({"version": 2, "solids": [{"shape": "mesh", "path": "solid.obj"}]})";
    const Scene scene = loadScene(testing::TempDir() + "/scene.json");
    EXPECT_EQ(convexOf(scene.solids[0], 3).middle.x, 0.4);
    EXPECT_EQ(writeScene(parseScene(writeScene(scene), "elsewhere/b.json")), writeScene(scene));
}

TEST(Planes, AreLayersOfParticlesInTheDomain) {
    for (int dimensions : {2, 3})
        for (Vec3 normal :
             {Vec3{0, 2, 0}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{1, 2, 0}, Vec3{1, 2, -0.5f}}) {
            if (dimensions == 2 && normal.z != 0) continue;
            SCOPED_TRACE(testing::Message()
                         << dimensions << " " << normal.x << " " << normal.y << " " << normal.z);
            Scene scene;
            scene.simulation.dimensions = dimensions;
            scene.domain.min = {-1, 0, 0}, scene.domain.max = {0, 1, 1};
            Solid plane;
            plane.shape = Shape::Plane, plane.normal = normal, plane.center = {-0.5f, 0.5f, 0.5f};
            scene.solids = {plane};
            const Convex shape = convexOf(plane, dimensions);
            const SolidSample sample = sampleSolid(scene, plane);
            std::vector<int> inLayer(size_t(boundaryLayers(scene)));
            for (Vec3 p : sample.positions) {
                Vec3d at = toDouble(p) + toDouble(scene.domain.min) - shape.middle;
                if (dimensions == 2) at.z = 0;
                const double depth = -shape.nearest(at).distance / 0.02 - 0.5;
                ASSERT_NEAR(depth, std::round(depth), 1e-3);
                ASSERT_LT(std::round(depth), boundaryLayers(scene));
                bool within = true;  // the domain
                for (int k = 0; k < dimensions; ++k) within &= p[k] > 0 && p[k] < 1;
                inLayer[size_t(std::round(depth))] += within;
            }
            const double slope = dimensions == 3 && normal.z != 0 ? std::sqrt(5.25) / 2
                                 : normal.x * normal.y != 0       ? std::sqrt(1.25)
                                                                  : 1;
            const double expected = slope * std::pow(50, dimensions - 1);
            for (int n : inLayer) EXPECT_NEAR(n, expected, 0.12 * expected);
            EXPECT_LE(int64_t(sample.positions.size()), countParticles(scene).walls);
            scene.fluid.bodies = {Body{{.min{-1, 0, 0}, .max{0, 1, 1}}}};
            for (Vec3 x : placeParticles(scene).positions) {
                Vec3d at = toDouble(x) + toDouble(scene.domain.min) - shape.middle;
                ASSERT_GT(shape.nearest(at).distance, 0);
            }
        }
}

TEST(Planes, MistakesAreNamed) {
    auto refusal = [&](const std::string& solid,
                       const std::string& more = "name=a") -> std::string {
        Scene scene;
        try {
            setKnob(scene, R"(solids=[{"shape": "plane", )" + solid + "}]");
            setKnob(scene, more);
            checkScene(scene, "a");
            return "";
        } catch (const Error& e) { return e.what(); }
    };
    const std::string plane = R"("center": [0, 0.1, 0], "normal": [0.1, 1, 0])";
    EXPECT_EQ(refusal(plane), "");
    const std::pair<std::string, const char*> mistakes[] = {
        {refusal(R"("normal": [0, 0, 0])"), "solids[0].normal: has no direction"},
        {refusal(plane + R"(, "velocity": [0, 1, 0])"), "does not move"},
        {refusal(plane + R"(, "spin": 10)"), "does not move"},
        {refusal(plane + R"(, "keyframes": [[0, 0, 0, 0], [1, 0, 1, 0]])"), "does not move"},
        {refusal(plane + R"(, "radius": 2)"), "unknown key"},
        {refusal(R"("normal": [0, 1, 1])", "simulation.dimensions=2"), "leave z 0"},
        {refusal(plane, "domain.periodic_x=true"), "x is a periodic axis"},
        {refusal(plane, R"(fluid.bodies=[{"shape": "plane"}])"), "a plane is for solids"},
    };
    for (const auto& [said, words] : mistakes)
        EXPECT_NE(said.find(words), std::string::npos) << said;
}

}  // namespace
}  // namespace spindrift
