// What solid a file of triangles means, however it was written.
#include "core/error.h"
#include "meshes.h"
#include "scene/check.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/mesh.h"
#include "scene/particles.h"
#include "scene/sample_object.h"
#include "scene/sample_solid.h"
#include "sim/make_simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

namespace spindrift {
namespace {

std::string fileOf(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + "/" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}
Mesh meshOf(const Surface& s, double roundOff = 0) {
    std::vector<Mesh::Triangle> triangles;
    for (const auto& f : s.inTriangles(false).faces) triangles.push_back({f[0], f[1], f[2]});
    return Mesh("surface", s.vertices, triangles, roundOff);
}
void windAtRandom(Surface& s, std::mt19937& random) {
    for (auto& face : s.faces)
        if (random() % 2) std::reverse(face.begin(), face.end());
}
// Of an outline in x and y.
Surface prismSurface(const std::vector<Vec3d>& outline, double low, double high) {
    Surface s;
    const int n = int(outline.size());
    std::vector<int> bottom, top;
    for (int k = 0; k < n; ++k) {
        s.vertices.push_back({outline[size_t(k)].x, outline[size_t(k)].y, low}),
            s.vertices.push_back({outline[size_t(k)].x, outline[size_t(k)].y, high});
        const int next = (k + 1) % n;
        s.faces.push_back({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
        bottom.insert(bottom.begin(), 2 * k), top.push_back(2 * k + 1);
    }
    s.faces.push_back(bottom), s.faces.push_back(top);
    return s;
}
Surface several(const std::vector<Surface>& parts) {
    Surface s;
    for (const Surface& part : parts) s.add(part);
    return s;
}
// Triangles by themselves, in single precision.
Surface rounded(const Surface& s) {
    Surface out;
    for (const auto& face : s.faces) {
        out.faces.emplace_back();
        for (int v : face)
            out.faces.back().push_back(int(out.vertices.size())),
                out.vertices.push_back(toDouble(toFloat(s.vertices[size_t(v)])));
    }
    return out;
}

// Boxes with corners at whole numbers from 0 to Most: they cross, touch with faces, edges and
// corners, are the same, and lie in each other.
constexpr int Most = 5;
struct Blocks {
    struct Block {
        Int3 low, high;
    };
    std::vector<Block> blocks;
    std::vector<int> bodies;
    bool filled[Most][Most][Most] = {};

    Blocks(std::mt19937& random, int count) {
        for (int b = 0; b < count; ++b) {
            const auto stretch = [&](int& low, int& high) {
                low = int(random() % Most), high = low + 1 + int(random() % unsigned(Most - low));
            };
            Block block;
            stretch(block.low.x, block.high.x), stretch(block.low.y, block.high.y),
                stretch(block.low.z, block.high.z);
            blocks.push_back(block), bodies.push_back(b);
        }
        for (int pass = 0; pass < count; ++pass)
            for (size_t a = 0; a < blocks.size(); ++a)
                for (size_t b = 0; b < blocks.size(); ++b)
                    if (meet(blocks[a], blocks[b]))
                        bodies[a] = bodies[b] = std::min(bodies[a], bodies[b]);
        for (int i = 0; i < Most * Most * Most; ++i) {
            const int x = i % Most, y = i / Most % Most, z = i / (Most * Most);
            std::map<int, bool> in;
            for (size_t b = 0; b < blocks.size(); ++b) {
                const auto& [low, high] = blocks[b];
                in[bodies[b]] |= x >= low.x && x < high.x && y >= low.y && y < high.y &&
                                 z >= low.z && z < high.z;
            }
            for (const auto& [body, is] : in) filled[z][y][x] ^= is;
        }
    }
    // Whether their surfaces do.
    static bool meet(const Block& a, const Block& b) {
        bool apart = false, aInB = true, bInA = true;
        const int lowA[] = {a.low.x, a.low.y, a.low.z}, highA[] = {a.high.x, a.high.y, a.high.z};
        const int lowB[] = {b.low.x, b.low.y, b.low.z}, highB[] = {b.high.x, b.high.y, b.high.z};
        for (int k = 0; k < 3; ++k) {
            apart |= highA[k] < lowB[k] || highB[k] < lowA[k];
            aInB &= lowA[k] > lowB[k] && highA[k] < highB[k];
            bInA &= lowB[k] > lowA[k] && highB[k] < highA[k];
        }
        return !apart && !aInB && !bInA;
    }
    Surface surface() const {
        Surface s;
        const auto toVec = [](Int3 a) { return Vec3d{double(a.x), double(a.y), double(a.z)}; };
        for (const Block& b : blocks) s.add(boxSurface(toVec(b.low), toVec(b.high)));
        return s;
    }
    bool isFilled(int x, int y, int z) const {
        return std::min({x, y, z}) >= 0 && std::max({x, y, z}) < Most && filled[z][y][x];
    }
    double volume() const {
        int cells = 0;
        for (const auto& plane : filled)
            for (const auto& row : plane)
                for (const bool cell : row) cells += cell;
        return cells;
    }
    // To the nearest cell of the other kind; beyond the box there are others to a width of one.
    double distance(Vec3d p) const {
        const bool inside =
            isFilled(int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z)));
        double least = 1e300;
        for (int z = -1; z <= Most; ++z)
            for (int y = -1; y <= Most; ++y)
                for (int x = -1; x <= Most; ++x) {
                    if (isFilled(x, y, z) == inside) continue;
                    const auto beyond = [](double a, int low) {
                        return std::max({low - a, a - low - 1, 0.0});
                    };
                    least = std::min(least,
                                     length(Vec3d{beyond(p.x, x), beyond(p.y, y), beyond(p.z, z)}));
                }
        return inside ? -least : least;
    }
};

// The columns of a rotation by a random quaternion.
std::array<Vec3d, 3> randomAxes(std::mt19937& random) {
    double q[4], sum = 0;
    for (double& a : q) a = random() / 2147483648.0 - 1, sum += a * a;
    for (double& a : q) a /= std::sqrt(sum);
    const auto [w, x, y, z] = std::tuple(q[0], q[1], q[2], q[3]);
    return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            Vec3d{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

TEST(MeshSolids, ShellsTouchCrossAndNest) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        SCOPED_TRACE(trial);
        const bool asStl = trial % 4 == 1;  // without a word on which corners belong together
        const Blocks blocks(random, 1 + int(random() % (asStl ? 4 : 6)));
        if (blocks.volume() == 0) continue;
        Surface surface = blocks.surface().inTriangles(trial % 2);
        windAtRandom(surface, random);
        // As they are, turned and far away, and as STL has them.
        const auto axes = randomAxes(random);
        const Vec3d away{1000 * double(trial % 3), 0, -500};
        const auto placed = [&](Vec3d p) {
            return trial % 4 == 0 ? p : p.x * axes[0] + p.y * axes[1] + p.z * axes[2] + away;
        };
        for (Vec3d& p : surface.vertices) p = placed(p);
        if (asStl) surface = rounded(surface);
        const double roundOff = asStl ? 1.2e-7 * (length(away) + 2 * Most) : 0,
                     precision = 2e-5 + 4 * roundOff;
        const Mesh mesh = meshOf(surface, roundOff);
        const Mesh::Weight w = mesh.weigh();
        ASSERT_NEAR(w.volume, blocks.volume(), 50 * precision);
        for (int k = 0; k < 200; ++k) {
            Vec3d p;
            for (int c = 0; c < 3; ++c) p[c] = (random() / 4294967296.0) * (Most + 1.6) - 0.8;
            const double exact = blocks.distance(p);
            ASSERT_NEAR(mesh.nearest(placed(p)).distance, exact, precision)
                << p.x << " " << p.y << " " << p.z;
        }
    }
}

// Cubes of a lattice that fill some of it, each with its own six faces: they share faces, edges and
// corners, and enclose hollows. Written as STL does, with nothing that says which corners belong
// together; as that and with corners of their own they are the same.
TEST(MeshSolids, ThatShareFacesAreOneSolid) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 300; ++trial) {
        SCOPED_TRACE(trial);
        const int side = 2 + trial % 3;
        const unsigned full = 1 + random() % 9;  // of ten
        std::set<std::array<int, 3>> filled;
        for (int i = 0; i < side * side * side; ++i)
            if (random() % 10 < full) filled.insert({i % side, i / side % side, i / side / side});
        if (filled.empty()) continue;
        const auto axes = randomAxes(random);
        Surface cubes;
        for (const auto& [x, y, z] : filled)
            cubes.add(boxSurface({double(x), double(y), double(z)}, {x + 1.0, y + 1.0, z + 1.0}));
        for (Vec3d& p : cubes.vertices)
            if (trial % 2) p = p.x * axes[0] + p.y * axes[1] + p.z * axes[2];
        Surface soup = rounded(cubes.inTriangles(trial % 3 == 0));
        std::shuffle(soup.faces.begin(), soup.faces.end(), random);
        if (trial % 4) windAtRandom(soup, random);
        const Mesh welded = meshOf(soup, 1e-6), own = meshOf(cubes);
        ASSERT_NEAR(welded.weigh().volume, double(filled.size()), 1e-4);
        ASSERT_NEAR(own.weigh().volume, double(filled.size()), 1e-4);
        for (int k = 0; k < 200; ++k) {
            Vec3d p;
            for (int c = 0; c < 3; ++c) p[c] = (random() / 4294967296.0) * (side + 1.0) - 0.5;
            const bool inside =
                filled.contains({int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))});
            if (trial % 2) p = p.x * axes[0] + p.y * axes[1] + p.z * axes[2];
            const double far = welded.nearest(p).distance;
            ASSERT_EQ(far < 0, inside);
            ASSERT_NEAR(far, own.nearest(p).distance, 1e-5);
        }
    }
}

// Round ones cross in no plane that they have in common.
TEST(MeshSolids, RoundShellsCross) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Surface> balls;
        for (int b = 0; b < 3; ++b) {
            Vec3d center;
            for (int k = 0; k < 3; ++k) center[k] = 0.8 * random() / 4294967296.0;
            balls.push_back(sphereSurface(center, 0.5 + 0.3 * random() / 4294967296.0, 2));
        }
        const auto holds = [](const Surface& ball, Vec3d p) {  // it is convex
            return std::all_of(ball.faces.begin(), ball.faces.end(), [&](const auto& f) {
                const Vec3d a = ball.vertices[size_t(f[0])], b = ball.vertices[size_t(f[1])],
                            c = ball.vertices[size_t(f[2])];
                return dot(cross(b - a, c - a), p - a) <= 0;
            });
        };
        Surface all = several({balls[0], balls[1].inverted(), balls[2]});
        windAtRandom(all, random);
        const Mesh mesh = meshOf(all);
        int inside = 0;
        constexpr int Points = 4000;
        for (int k = 0; k < Points; ++k) {
            Vec3d p;
            for (int c = 0; c < 3; ++c) p[c] = -0.8 + 2.4 * random() / 4294967296.0;
            const bool exact = std::any_of(balls.begin(), balls.end(),
                                           [&](const Surface& ball) { return holds(ball, p); });
            inside += exact;
            ASSERT_EQ(mesh.nearest(p).distance < 0, exact);
        }
        const double volume = std::pow(2.4, 3) * inside / Points;
        EXPECT_NEAR(mesh.weigh().volume, volume,
                    4 * std::pow(2.4, 3) * std::sqrt(inside) / Points);  // four standard deviations
    }
}

std::vector<std::pair<const char*, Surface>> solids() {
    const Surface box = boxSurface({0.2, 0.2, 0.2}, {0.6, 0.5, 0.6});
    const std::vector<Vec3d> L{{0.2, 0.2, 0}, {0.6, 0.2, 0}, {0.6, 0.3, 0},
                               {0.3, 0.3, 0}, {0.3, 0.6, 0}, {0.2, 0.6, 0}};
    return {{"box", box},
            {"L", prismSurface(L, 0.2, 0.6)},
            {"overlapping", several({box, boxSurface({0.413, 0.337, 0.411}, {0.8, 0.437, 0.511})})},
            {"touching", several({box, boxSurface({0.6, 0.2, 0.2}, {0.8, 0.5, 0.6})})},
            {"by an edge", several({box, boxSurface({0.6, 0.5, 0.2}, {0.8, 0.7, 0.6})})},
            {"hollow", several({box, boxSurface({0.3, 0.3, 0.3}, {0.5, 0.4, 0.5})})}};
}
// Concave polygons are none for a fan from the middle of their corners.
bool isConvex(const std::string& name) { return name != "L"; }

// The same particles, of the solid and of the fluid around it, in the same order. (Where a corner
// is no round number: rounding must not decide whether a point of a lattice is nearer than the skin
// that stays free.)
TEST(MeshSolids, AreTheSameInEachWriting) {
    std::mt19937 random(3);
    for (const auto& [name, surface] : solids()) {
        SCOPED_TRACE(name);
        const Mesh quads = *readMesh(fileOf("writing.obj", surface.text()));
        // Of the faces as they are, cut up by the reader.
        Surface cut{quads.vertices(), {}};
        for (const Mesh::Triangle& t : quads.triangles()) cut.faces.push_back({t[0], t[1], t[2]});
        Surface wound = surface, shuffled = cut;
        windAtRandom(wound, random);
        std::shuffle(shuffled.faces.begin(), shuffled.faces.end(), random);
        windAtRandom(shuffled, random);
        std::vector<std::pair<std::string, std::string>> files{
            {"quads.obj", surface.text()},
            {"cut.obj", cut.text()},
            {"inverted.obj", surface.inverted().text()},
            {"wound.obj", wound.text()},
            {"faces.ply", wound.textAsPly()},
            {"cut.ply", shuffled.textAsPly()},
            {"text.stl", cut.textAsStl()},
            {"wound.stl", shuffled.textAsStl()},
            {"binary.STL", shuffled.textAsBinaryStl()},
            {"bom.obj", "\xEF\xBB\xBF" + surface.text()}};
        if (isConvex(name))
            files.push_back({"fan.obj", surface.inTriangles(true).text()}),
                files.push_back({"fan.stl", surface.inTriangles(true).textAsStl()});
        Scene scene;
        scene.simulation.spacing = 0.05f;
        scene.domain.max = {0.8f, 0.6f, 0.6f};
        scene.fluid.bodies = {Body{{.max{0.8f, 0.6f, 0.6f}}}};
        Solid solid;
        solid.shape = Shape::Mesh;
        SolidSample first;
        Placement firstFluid;
        for (const auto& [file, text] : files) {
            SCOPED_TRACE(file);
            solid.path = fileOf(file, text);
            const SolidSample sample = sampleSolid(scene, solid);
            scene.solids = {solid};
            const Placement fluid = placeParticles(scene);
            if (first.positions.empty()) first = sample, firstFluid = fluid;
            ASSERT_EQ(sample.positions.size(), first.positions.size());
            for (size_t i = 0; i < sample.positions.size(); ++i) {
                ASSERT_LT(length(sample.positions[i] - first.positions[i]), 1e-5f);
                ASSERT_NEAR(sample.volumes[i], first.volumes[i], 1e-4f);
            }
            ASSERT_EQ(fluid.positions.size(), firstFluid.positions.size());
            for (size_t i = 0; i < fluid.positions.size(); ++i)
                ASSERT_LT(length(fluid.positions[i] - firstFluid.positions[i]),
                          1e-2f * scene.simulation.spacing);  // packing amplifies what files round
            const Mesh::Weight w = readMesh(solid.path)->weigh(), expected = quads.weigh();
            EXPECT_NEAR(w.volume, expected.volume, 1e-6 * expected.volume);
            EXPECT_LT(length(w.centroid - expected.centroid), 1e-6);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    EXPECT_NEAR(w.inertia[i][j], expected.inertia[i][j],
                                1e-6 * expected.inertia[0][0]);
        }
        EXPECT_GT(first.positions.size(), 100u);
    }
}

TEST(MeshSolids, WeighWhatTheyAreOnce) {
    const double box = 0.4 * 0.3 * 0.4;
    const double volumes[] = {box,
                              (0.4 * 0.1 + 0.1 * 0.3) * 0.4,
                              box + 0.2 * 0.1 * 0.1,
                              box + 0.2 * 0.3 * 0.4,
                              box + 0.2 * 0.2 * 0.4,
                              box - 0.2 * 0.1 * 0.2};
    const auto all = solids();
    for (size_t k = 0; k < all.size(); ++k)
        EXPECT_NEAR(readMesh(fileOf("weight.obj", all[k].second.text()))->weigh().volume,
                    volumes[k], 1e-9)
            << all[k].first;
    // Two halves that overlap are the whole.
    const Mesh::Weight w =
        meshOf(several({boxSurface({0, 0, 0}, {0.7, 1, 1}), boxSurface({0.4, 0, 0}, {1, 1, 1})}))
            .weigh();
    EXPECT_NEAR(w.volume, 1, 1e-12);
    EXPECT_NEAR(w.centroid.x, 0.5, 1e-12);
    EXPECT_NEAR(w.inertia[0][0], 1 / 6.0, 1e-12);
    EXPECT_NEAR(w.inertia[0][1], 0, 1e-12);
}

// Polygons with many corners, concave ones and such with three in a line, keep their area.
TEST(MeshSolids, ConcavePolygonsAreCutUp) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 100; ++trial) {
        const int n = 3 + int(random() % 40);
        std::vector<Vec3d> outline;
        double area = 0;
        for (int k = 0; k < n; ++k) {  // a star
            const double angle = 2 * std::numbers::pi * k / n,
                         r = 0.2 + 0.8 * (random() / 4294967296.0);
            outline.push_back({r * std::cos(angle), r * std::sin(angle), 0});
            if (random() % 4 == 0 && k > 0)
                outline.insert(outline.end() - 1,
                               0.5 * (outline.back() + outline[outline.size() - 2]));
        }
        if (trial % 2) std::reverse(outline.begin(), outline.end());
        for (size_t k = 0; k < outline.size(); ++k)
            area += 0.5 * cross(outline[k], outline[(k + 1) % outline.size()]).z;
        const auto mesh = readMesh(
            fileOf("star" + std::to_string(trial) + ".obj", prismSurface(outline, 0, 0.5).text()));
        ASSERT_NEAR(mesh->weigh().volume, std::abs(area) / 2, 1e-7);
    }
}

// Ramps as sharp as one likes; a plate is thin at any angle.
TEST(MeshSolids, MayHaveSharpEdges) {
    for (double degrees : {1.0, 2.0, 5.0, 9.0, 14.0, 15.0, 17.9, 18.1, 30.0}) {
        SCOPED_TRACE(degrees);
        const double slope = std::tan(degrees * std::numbers::pi / 180);
        const Mesh ramp =
            meshOf(prismSurface({{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.3 * slope, 0}}, 0, 0.2));
        EXPECT_EQ(ramp.fieldSpacing(0.02), 0.01);
    }
    EXPECT_LT(meshOf(boxSurface({0, 0, 0}, {0.3, 0.004, 0.2})).fieldSpacing(0.02), 0.0021);
    // Walls that are curved, or not quite parallel.
    const Mesh bowl =
        meshOf(several({sphereSurface({0, 0, 0}, 0.2, 3), sphereSurface({0, 0, 0}, 0.196, 3)}));
    EXPECT_LT(bowl.fieldSpacing(0.02), 0.0021);
    EXPECT_LT(meshOf(prismSurface({{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.008, 0}, {0, 0.004, 0}}, 0, 0.2))
                  .fieldSpacing(0.02),
              0.0022);
}

TEST(MeshSolids, ObjKeepsTheCoordinatesOfASurvey) {
    Surface box = boxSurface({500122.9, 449.9, 649775.9}, {500123.1, 450.1, 649776.1});
    std::string text;
    for (const Vec3d& p : box.vertices)
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) +
                "\n";
    box.vertices.clear();
    const auto mesh = readMesh(fileOf("survey.obj", text + box.text()));
    EXPECT_NEAR(mesh->weigh().volume, 0.008, 1e-9);
    EXPECT_NEAR(mesh->nearest({500123, 450.08, 649776}).distance, -0.02, 1e-9);
}

// The same cube in every kind of file.
TEST(MeshSolids, GltfIsWhatObjIs) {
    const Surface box = boxSurface({0.25, -0.5, 0.125}, {0.75, 0.25, 0.625}).inTriangles(false);
    const Vec3d moved{1, 2, -3};
    const auto obj = readMesh(fileOf("cube.obj", box.text()));
    const std::tuple<const char*, std::string, Vec3d, double> files[] = {
        {"cube.gltf", box.textAsGltf(), {0, 0, 0}, 1},
        {"cube.glb", box.textAsGlb(), {0, 0, 0}, 1},
        {"moved.gltf", box.textAsGltf(moved, 2), moved, 2}};
    for (const auto& [name, text, offset, scale] : files) {
        const auto mesh = readMesh(fileOf(name, text));
        EXPECT_EQ(mesh->triangles().size(), obj->triangles().size()) << name;
        EXPECT_NEAR(mesh->weigh().volume, std::pow(scale, 3) * obj->weigh().volume, 1e-6) << name;
        for (const Vec3d p : {Vec3d{0.5, 0, 0.4}, {0.3, 0.2, 0.2}, {0, 0, 0}, {1, -1, 1}})
            EXPECT_NEAR(mesh->nearest(offset + scale * p).distance,
                        scale * obj->nearest(p).distance, 1e-6)
                << name;
    }
}

// Coordinates of a national grid, brought into the domain by the offset that the refusal names.
TEST(MeshSolids, OfASurveyArePlacedByTheirOffset) {
    Surface box = boxSurface({500122.9, 449.9, 649775.9}, {500123.1, 450.1, 649776.1});
    std::string text;
    for (const Vec3d& p : box.vertices) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    box.vertices.clear();
    const std::string path = fileOf("grid.obj", text + box.text());
    const std::string named[] = {"solids", "fluid.bodies", "objects"};
    for (const std::string& list : named) {
        Scene scene;
        scene.simulation.spacing = 0.02f;
        scene.domain.max = {0.8f, 0.6f, 0.6f};
        scene.fluid.bodies = {Body{{.max{0.1f, 0.1f, 0.1f}}}};
        const auto complaint = [&](const std::string& offset) -> std::string {
            try {
                setKnob(scene,
                        fmt::format("{}=[{{\"shape\":\"{}\",\"path\":\"{}\",\"offset\":[{}]}}]",
                                    list, list == "objects" ? "shell" : "mesh", path, offset));
                checkScene(scene, "a");
            } catch (const Error& error) { return error.what(); }
            return "";
        };
        const std::string said = complaint("0.3,0.3,0.3");
        EXPECT_NE(said.find(list + "[0].offset: the mesh lies from (500123.2, 450.2, 649776.2) to "
                                   "(500123.4, 450.4, 649776.4) m, the domain from (0, 0, 0) to "
                                   "(0.8, 0.6, 0.6); [-500122.6, -449.7, -649775.7] would put it"),
                  std::string::npos)
            << said;
        EXPECT_EQ(complaint("-500122.6, -449.7, -649775.7"), "");
        const Scene again = parseScene(writeScene(scene), "again");
        Vec3d middle{0, 0, 0};
        if (list == "solids") middle = convexOf(again.solids[0], 3).middle;
        if (list == "fluid.bodies") middle = convexOf(again.fluid.bodies[0], 3).middle;
        if (list == "objects") {
            const ObjectSample sample = sampleObjects(again);
            for (const Vec3& p : sample.positions)
                middle = middle + (1 / double(sample.size())) * toDouble(p);
        }
        EXPECT_NEAR(length(middle - Vec3d{0.4, 0.3, 0.3}), 0, 1e-6) << list;
    }
}

// Obstacles may be larger than the tank; what must be in it may not.
TEST(MeshSolids, TellThatTheirFileMayBeInMillimetres) {
    const std::string path = fileOf("part.obj", boxSurface({0, 0, 0}, {200, 150, 100}).text());
    const std::pair<const char*, const char*> cases[] = {
        {"fluid.bodies", "mesh"}, {"objects", "shell"}, {"solids", "mesh"}};
    for (const auto& [list, shape] : cases)
        for (const float side : {1.0f, 9.0f, 15.0f, 150.0f, 250.0f}) {
            Scene scene;
            scene.domain.max = {side, side, side};
            scene.simulation.spacing = std::max(0.01f * side, 0.02f);
            scene.fluid.bodies = {Body{{.max{1, 1, 1}}}};
            std::string said;
            try {
                setKnob(scene,
                        fmt::format(R"({}=[{{"shape":"{}","path":"{}"}}])", list, shape, path));
                checkScene(scene, "a");
            } catch (const Error& error) { said = error.what(); }
            const bool solid = std::string(list) == "solids";
            const bool expected = 200 > (solid ? 20 : 1) * side;
            const bool units =
                said.find(fmt::format("{}[0].scale: the mesh is 200 m large, the domain "
                                      "{:g} m; ",
                                      list, side)) != std::string::npos;
            EXPECT_EQ(units, expected) << list << " in " << side << ": " << said;
            if (side == 1) {
                EXPECT_NE(said.find("if the file is in millimetres, set it to 0.001"),
                          std::string::npos)
                    << said;
            }
        }
}

// Whatever covers all fluid: a mesh several tanks large, a block, a plane.
TEST(MeshSolids, ThatLeaveNoFluidAreRefused) {
    const std::string path = fileOf("large.obj", boxSurface({-1, -1, -1}, {3, 3, 3}).text());
    for (const std::string& solid : {R"("shape":"mesh","path":")" + path + "\"",
                                     std::string(R"("min":[-1,-1,-1],"max":[3,3,3])"),
                                     std::string(R"("shape":"plane","center":[0,2,0])")}) {
        Scene scene;
        scene.simulation.spacing = 0.1f;
        scene.domain.max = {1, 1, 1};
        setKnob(scene, "solids=[{" + solid + "}]");
        try {
            makeSimulation(scene);
            ADD_FAILURE() << solid;
        } catch (const Error& error) {
            EXPECT_EQ(error.exit, Exit::Scene);
            EXPECT_NE(std::string(error.what()).find("fluid.bodies: not one particle fits"),
                      std::string::npos)
                << error.what();
        }
    }
}

// Boxes that overlap, that touch by an edge, and of which one is inside out.
TEST(MeshSolids, KeepFluidOut) {
    const Vec3d corners[][4] = {
        {{0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}, {0.25, 0.25, 0.25}, {0.45, 0.35, 0.35}},
        {{0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}, {0.4, 0.4, 0.2}, {0.5, 0.5, 0.4}},
        {{0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}, {0.5, 0.2, 0.2}, {0.6, 0.4, 0.4}}};
    for (const auto& c : corners)
        for (const bool turned : {false, true}) {
            const Surface second = boxSurface(c[2], c[3]);
            Scene scene;
            scene.simulation.spacing = 0.02f;
            scene.domain.max = {0.8f, 0.6f, 0.6f};
            scene.fluid.bodies = {Body{{.max{0.8f, 0.6f, 0.6f}}}};
            Solid solid;
            solid.shape = Shape::Mesh;
            solid.path = fileOf(
                "boxes.obj",
                several({boxSurface(c[0], c[1]), turned ? second.inverted() : second}).text());
            scene.solids = {solid};
            size_t expected = 0;  // a lattice without the boxes, where that fits to them
            const auto inBoxes = [&](Vec3d p, double skin) {
                for (int box = 0; box < 2; ++box) {
                    Vec3d beyond;
                    for (int k = 0; k < 3; ++k)
                        beyond[k] = std::max({c[2 * box][k] - p[k], p[k] - c[2 * box + 1][k], 0.0});
                    if (length(beyond) <= skin) return true;
                }
                return false;
            };
            for (int i = 0; i < 40 * 30 * 30; ++i)
                expected +=
                    !inBoxes(0.02 * Vec3d{i % 40 + 0.5, i / 40 % 30 + 0.5, i / 1200 + 0.5}, 1e-6);
            const Placement fluid = placeParticles(scene);
            for (const Vec3& p : fluid.positions) ASSERT_FALSE(inBoxes(toDouble(p), 0));
            // Else as many as there is room for: 12.5 layers beside each face of the first two.
            const bool fits = c[2].x != 0.25;
            const double boxes = 0.2 * 0.2 * 0.2 + 0.2 * 0.1 * 0.1 - 0.15 * 0.1 * 0.1,
                         room = 36000 - boxes / (0.02 * 0.02 * 0.02);
            if (fits)
                EXPECT_EQ(fluid.positions.size(), expected);
            else
                EXPECT_NEAR(double(fluid.positions.size()) / room, 1, 3e-4);
        }
}

// Also where only its box is near: in the notch of an L, in a ring, between boxes.
TEST(MeshSolids, AreAsFarAsTheirSurface) {
    std::mt19937 random(6);
    for (const auto& [name, surface] : solids()) {
        SCOPED_TRACE(name);
        Solid solid;
        solid.shape = Shape::Mesh, solid.scale = 0.5f, solid.offset = {0.1, -0.2, 0.3};
        solid.path = fileOf("far.obj", surface.text());
        const Convex shape = convexOf(solid, 3);
        const auto mesh = readMesh(solid.path);
        for (int k = 0; k < 500; ++k) {
            Vec3d p;
            for (int c = 0; c < 3; ++c) p[c] = 2 * (random() / 4294967296.0) - 1;
            ASSERT_NEAR(shape.nearest(p).distance,
                        0.5 * mesh->nearest(2.0 * (p + shape.middle - solid.offset)).distance,
                        1e-6);
        }
    }
}

// Whatever their shape, and wherever the lattice meets them: fluid that is packed stays beside
// them, and none is squeezed.
TEST(MeshSolids, HaveFluidPackedBesideThem) {
    for (const auto& [name, surface] : solids())
        for (const double over : {0.0, 0.5}) {
            SCOPED_TRACE(testing::Message() << name << ", " << over);
            const double dx = 0.04;
            Scene scene;
            scene.simulation.spacing = float(dx);
            scene.domain.max = {1.2f, 0.96f, 0.96f};
            scene.fluid.bodies = {Body{{.max = scene.domain.max}}};
            Solid solid;
            solid.shape = Shape::Mesh, solid.path = fileOf("packed.obj", surface.text());
            solid.offset = Vec3d{0.1, 0.1, 0.1} + (over * dx) * Vec3d{1, 0.7, 0.4};
            scene.solids = {solid};
            const Convex shape = convexOf(solid, 3);
            const std::vector<Vec3> at = placeParticles(scene).positions;
            for (const Vec3& x : at) {
                const Vec3d p = toDouble(x);
                double off = 0;  // a lattice that fits to the box
                for (int k = 0; k < 3; ++k)
                    off = std::max(off, std::abs(std::remainder(p[k] / dx - 0.5, 1)));
                if (off > 0.01) { ASSERT_LT(shape.nearest(p - shape.middle).distance, 3.5 * dx); }
            }
            const auto simulation = makeSimulation(scene);
            EXPECT_LT(simulation->measure().maxDensityError, 0.05);
        }
}

// Bodies of fluid: as full as their volume, and not beyond their surface.
TEST(MeshSolids, HoldFluid) {
    const double dx = 0.025;
    Scene scene;
    scene.simulation.spacing = float(dx);
    scene.domain.max = {1, 0.8f, 0.8f};
    Body block, body;
    block.min = {0.2f, 0.2f, 0.2f}, block.max = {0.6f, 0.5f, 0.6f};
    body.shape = Shape::Mesh;
    scene.fluid.bodies = {block};
    const Placement ofBlock = placeParticles(scene);
    for (const auto& [name, surface] : solids())
        for (const StartPlaces places : {StartPlaces::Lattice, StartPlaces::Relaxed}) {
            const bool isRelaxed = places == StartPlaces::Relaxed;
            if (isRelaxed && name != std::string("hollow")) continue;  // takes its time
            SCOPED_TRACE(name);
            scene.simulation.placement = places;
            body.path = fileOf("fluid.obj", surface.text());
            scene.fluid.bodies = {body};
            const Placement p = placeParticles(scene);
            const auto mesh = readMesh(body.path);
            EXPECT_NEAR(double(p.positions.size()) * dx * dx * dx, mesh->weigh().volume,
                        (isRelaxed ? 0.001 : 0.07) * mesh->weigh().volume);
            EXPECT_LE(int64_t(p.positions.size()), countParticles(scene).fluid);
            for (const Vec3& x : p.positions)
                ASSERT_LT(mesh->nearest(toDouble(x)).distance, 0.1 * dx);
            if (name == std::string("box")) {
                EXPECT_EQ(p.positions.size(), ofBlock.positions.size());
            }
        }
}

TEST(MeshSolids, MistakesAreNamed) {
    const auto complaint = [](const std::string& file, const std::string& text) -> std::string {
        try {
            readMesh(fileOf(file, text));
            return "";
        } catch (const Error& e) { return e.what(); }
    };
    Surface open = boxSurface({0.1, 0, 0}, {1, 1, 1}).inTriangles(false),
            far = boxSurface({5001, 0, 0}, {5001.5, 1, 1});
    far = far.inTriangles(false);
    open.faces.pop_back();
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    const std::pair<std::string, const char*> mistakes[] = {
        {complaint("open.stl", open.textAsStl()),
         "the edge from (0.1, 0, 1) to (0.1, 1, 1) belongs to one triangle"},
        {complaint("far.stl", far.textAsStl()), "too far for the single precision"},
        {complaint("none.ply", vertices), "has no faces"},
        {complaint("wrong.ply", "ply\nformat"), "can't be read"},
        {complaint("empty.stl", ""), "can't be read"},
        {complaint("wrong.gltf", "{}"), "can't be read"},
        {complaint("mesh.doc", "solid"), "is of no kind that is known"},
    };
    for (const auto& [said, words] : mistakes)
        EXPECT_NE(said.find(words), std::string::npos) << said << " instead of " << words;
}

}  // namespace
}  // namespace spindrift
