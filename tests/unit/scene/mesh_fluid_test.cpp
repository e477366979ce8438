// Scenes with meshes: where fluid is beside them, and in bodies of fluid that are meshes.
#include "core/error.h"
#include "meshes.h"
#include "scene/check.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/mesh.h"
#include "scene/particles.h"
#include "scene/sample_object.h"
#include "sim/make_simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Coordinates of a national grid, brought into the domain by the offset that the refusal names.
TEST(MeshesAndFluid, OfASurveyArePlacedByTheirOffset) {
    Surface box = boxSurface({500122.9, 449.9, 649775.9}, {500123.1, 450.1, 649776.1});
    std::string text;
    for (const Vec3d& p : box.vertices) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    box.vertices.clear();
    const std::string path = meshFile("grid.obj", text + box.text());
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
TEST(MeshesAndFluid, TellThatTheirFileMayBeInMillimetres) {
    const std::string path = meshFile("part.obj", boxSurface({0, 0, 0}, {200, 150, 100}).text());
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
TEST(MeshesAndFluid, ThatLeaveNoFluidAreRefused) {
    const std::string path = meshFile("large.obj", boxSurface({-1, -1, -1}, {3, 3, 3}).text());
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
            EXPECT_EQ(error.failure, Failure::Scene);
            EXPECT_NE(std::string(error.what()).find("fluid.bodies: not one particle fits"),
                      std::string::npos)
                << error.what();
        }
    }
}

// Boxes that overlap, that touch by an edge, and of which one is inside out.
TEST(MeshesAndFluid, KeepFluidOut) {
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
            solid.path = meshFile(
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

// Whatever their shape, and wherever the lattice meets them: fluid that is packed stays beside
// them, and none is squeezed.
TEST(MeshesAndFluid, HaveFluidPackedBesideThem) {
    for (const auto& [name, surface] : solids())
        for (const double over : {0.0, 0.5}) {
            SCOPED_TRACE(testing::Message() << name << ", " << over);
            const double dx = 0.04;
            Scene scene;
            scene.simulation.spacing = float(dx);
            scene.domain.max = {1.2f, 0.96f, 0.96f};
            scene.fluid.bodies = {Body{{.max = scene.domain.max}}};
            Solid solid;
            solid.shape = Shape::Mesh, solid.path = meshFile("packed.obj", surface.text());
            solid.offset = Vec3d{0.1, 0.1, 0.1} + (over * dx) * Vec3d{1, 0.7, 0.4};
            scene.solids = {solid};
            if (isBlock(solid)) continue;  // layers meet its faces
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
TEST(MeshesAndFluid, HoldFluid) {
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
            body.path = meshFile("fluid.obj", surface.text());
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

}  // namespace
}  // namespace spindrift
