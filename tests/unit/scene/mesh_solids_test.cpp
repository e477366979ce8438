// What solid a file of triangles means, however it was written.
#include "core/error.h"
#include "meshes.h"
#include "scene/convex.h"
#include "scene/mesh.h"
#include "scene/particles.h"
#include "scene/sample_solid.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

namespace spindrift {
namespace {

Mesh meshOf(const Surface& s, double roundOff = 0) {
    std::vector<Mesh::Triangle> triangles;
    for (const auto& f : s.inTriangles(false).faces) triangles.push_back({f[0], f[1], f[2]});
    return Mesh("surface", s.vertices, triangles, roundOff);
}
void windAtRandom(Surface& s, std::mt19937& random) {
    for (auto& face : s.faces)
        if (random() % 2) std::reverse(face.begin(), face.end());
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

// Concave polygons are none for a fan from the middle of their corners.
bool isConvex(const std::string& name) { return name != "L"; }

// The same particles, of the solid and of the fluid around it, in the same order. (Where a corner
// is no round number: rounding must not decide whether a point of a lattice is nearer than the skin
// that stays free.)
TEST(MeshSolids, AreTheSameInEachWriting) {
    std::mt19937 random(3);
    for (const auto& [name, surface] : solids()) {
        SCOPED_TRACE(name);
        const Mesh quads = *readMesh(meshFile("writing.obj", surface.text()));
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
            solid.path = meshFile(file, text);
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
        EXPECT_NEAR(readMesh(meshFile("weight.obj", all[k].second.text()))->weigh().volume,
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
        const auto mesh = readMesh(meshFile("star" + std::to_string(trial) + ".obj",
                                            prismSurface(outline, 0, 0.5).text()));
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
    const auto mesh = readMesh(meshFile("survey.obj", text + box.text()));
    EXPECT_NEAR(mesh->weigh().volume, 0.008, 1e-9);
    EXPECT_NEAR(mesh->nearest({500123, 450.08, 649776}).distance, -0.02, 1e-9);
}

// The same cube in every kind of file.
TEST(MeshSolids, GltfIsWhatObjIs) {
    const Surface box = boxSurface({0.25, -0.5, 0.125}, {0.75, 0.25, 0.625}).inTriangles(false);
    const Vec3d moved{1, 2, -3};
    const auto obj = readMesh(meshFile("cube.obj", box.text()));
    const std::tuple<const char*, std::string, Vec3d, double> files[] = {
        {"cube.gltf", box.textAsGltf(), {0, 0, 0}, 1},
        {"cube.glb", box.textAsGlb(), {0, 0, 0}, 1},
        {"moved.gltf", box.textAsGltf(moved, 2), moved, 2}};
    for (const auto& [name, text, offset, scale] : files) {
        const auto mesh = readMesh(meshFile(name, text));
        EXPECT_EQ(mesh->triangles().size(), obj->triangles().size()) << name;
        EXPECT_NEAR(mesh->weigh().volume, std::pow(scale, 3) * obj->weigh().volume, 1e-6) << name;
        for (const Vec3d p : {Vec3d{0.5, 0, 0.4}, {0.3, 0.2, 0.2}, {0, 0, 0}, {1, -1, 1}})
            EXPECT_NEAR(mesh->nearest(offset + scale * p).distance,
                        scale * obj->nearest(p).distance, 1e-6)
                << name;
    }
}

// Also where only its box is near: in the notch of an L, in a ring, between boxes.
TEST(MeshSolids, AreAsFarAsTheirSurface) {
    std::mt19937 random(6);
    for (const auto& [name, surface] : solids()) {
        SCOPED_TRACE(name);
        Solid solid;
        solid.shape = Shape::Mesh, solid.scale = 0.5f, solid.offset = {0.1, -0.2, 0.3};
        solid.path = meshFile("far.obj", surface.text());
        if (isBlock(solid)) continue;
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

TEST(MeshSolids, MistakesAreNamed) {
    const auto complaint = [](const std::string& file, const std::string& text) -> std::string {
        try {
            readMesh(meshFile(file, text));
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
