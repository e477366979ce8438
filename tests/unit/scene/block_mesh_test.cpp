// A mesh that is a box has all that a block has: particles, layers of fluid that meet its faces,
// and a plate's sides where it is thin.
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/lattice.h"
#include "scene/particles.h"
#include "scene/thin_solid.h"

#include "meshes.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

constexpr double Dx = 0.02;

// Two pools beside a wall that is so thick, of that shape.
Scene poolsBeside(double thick, const Solid& wall) {
    Scene scene;
    scene.simulation.spacing = float(Dx);
    scene.domain.max = {float(0.4 + thick), 0.5f, 0.2f};
    Body left, right;
    left.min = {0, 0, 0}, left.max = {0.2f, 0.4f, 0.2f};
    right.min = {float(0.2 + thick), 0, 0}, right.max = {float(0.4 + thick), 0.2f, 0.2f};
    scene.fluid.bodies = {left, right};
    scene.solids = {wall};
    return scene;
}
Solid blockOf(double thick) {
    Solid s;
    s.min = {0.2f, 0, 0}, s.max = {float(0.2 + thick), 0.5f, 0.2f};
    return s;
}
Solid meshOf(const std::string& name, const std::string& text) {
    Solid s;
    s.shape = Shape::Mesh, s.path = meshFile(name, text);
    return s;
}
// The box in pieces that touch, as a wall of bricks.
Surface bricks(Vec3d low, Vec3d high) {
    Vec3d end = high, begin = low;
    end.y = begin.y = low.y + 0.3 * (high.y - low.y);
    return several({boxSurface(low, end), boxSurface(begin, high)});
}

void expectSame(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
        ASSERT_LT(length(toDouble(a[i] - b[i])), 1e-4 * Dx) << "particle " << i;
}

TEST(BlockMeshes, AreBlocksWhateverWritesThem) {
    for (const double spacings : {0.25, 0.6, 1.0, 1.5, 2.5, 3.35, 6.0}) {
        const double thick = spacings * Dx;
        const Vec3d low{0.2, 0, 0}, high{0.2 + thick, 0.5, 0.2};
        const Surface box = boxSurface(low, high), triangles = box.inTriangles(false);
        const std::pair<const char*, Solid> meshes[] = {
            {"quads", meshOf("quads.obj", box.text())},
            {"fans", meshOf("fans.obj", box.inTriangles(true).text())},
            {"inside out", meshOf("inverted.obj", box.inverted().text())},
            {"STL", meshOf("triangles.stl", triangles.textAsStl())},
            {"binary STL", meshOf("binary.stl", triangles.textAsBinaryStl())},
            {"PLY", meshOf("box.ply", box.textAsPly())},
            {"bricks", meshOf("bricks.obj", bricks(low, high).text())}};
        const Scene block = poolsBeside(thick, blockOf(thick));
        for (const auto& [name, mesh] : meshes) {
            SCOPED_TRACE(testing::Message() << name << ", " << spacings);
            EXPECT_TRUE(isBlock(mesh));
            const Scene scene = poolsBeside(thick, mesh);
            EXPECT_LT(length(latticeStep(scene) - latticeStep(block)), 1e-5 * Dx);
            expectSame(placeParticles(scene).positions, placeParticles(block).positions);
            const SolidSample a = boundaryOf(scene, scene.solids[0]),
                              b = boundaryOf(block, block.solids[0]);
            expectSame(a.positions, b.positions);
            EXPECT_EQ(a.beyond, b.beyond);
            EXPECT_EQ(faceOfPlate(scene, scene.solids[0]), faceOfPlate(block, block.solids[0]));
        }
    }
}

TEST(BlockMeshes, AreNotThoseThatLackAnything) {
    const Vec3d low{0.2, 0, 0}, high{0.24, 0.5, 0.2};
    Surface turned = boxSurface(low, high), chamfered = boxSurface(low, high);
    for (Vec3d& p : turned.vertices) p = {p.x - 0.001 * p.y, p.y + 0.001 * p.x, p.z};
    chamfered.vertices[7].y -= 0.002;
    const std::vector<Vec3d> notched{{0.2, 0, 0},     {0.24, 0, 0},      {0.24, 0.5, 0},
                                     {0.221, 0.5, 0}, {0.221, 0.498, 0}, {0.219, 0.498, 0},
                                     {0.219, 0.5, 0}, {0.2, 0.5, 0}};
    const Surface hollow =
        several({boxSurface(low, high), boxSurface({0.21, 0.1, 0.05}, {0.23, 0.4, 0.15})});
    const std::pair<const char*, Surface> others[] = {
        {"turned", turned.inTriangles(false)},
        {"chamfered", chamfered.inTriangles(false)},
        {"dented", dentedBoxSurface(low, high)},
        {"notched", prismSurface(notched, 0, 0.2)},
        {"hollow", hollow},
        {"two with a gap",
         several({boxSurface(low, {0.24, 0.2, 0.2}), boxSurface({0.2, 0.201, 0}, high)})},
        {"sphere", sphereSurface({0.5, 0.5, 0.5}, 0.2, 2)}};
    for (const auto& [name, surface] : others)
        EXPECT_FALSE(isBlock(meshOf("other.obj", surface.text()))) << name;
}

}  // namespace
}  // namespace spindrift
