// Which solids are thin, and which walls their sides have.
#include "scene/thin_solid.h"

#include "meshes.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spindrift {
namespace {

constexpr double Dx = 0.02;

Scene sceneOf(int dimensions) {
    Scene scene;
    scene.simulation.dimensions = dimensions;
    scene.simulation.spacing = float(Dx);
    scene.domain.max = {1, 1, 1};
    return scene;
}
Solid blockOf(Vec3 low, Vec3 high) {
    Solid solid;
    solid.shape = Shape::Block, solid.min = low, solid.max = high;
    return solid;
}
Solid meshOf(const Surface& surface, const std::string& name) {
    Solid solid;
    solid.shape = Shape::Mesh, solid.path = surface.write(testing::TempDir() + "/" + name);
    return solid;
}

TEST(ThinSolid, ArePlatesAndShellsWhoseFacesShareParticles) {
    for (const int dimensions : {2, 3})
        for (int axis = 0; axis < dimensions; ++axis)
            for (const double spacings : {0.25, 1.0, 1.5, 1.7, 2.0, 3.5, 3.7, 5.0})
                for (const bool floats : {false, true}) {
                    Vec3 high{0.8f, 0.8f, 0.8f};
                    high[axis] = float(0.3 + spacings * Dx);
                    Solid plate = blockOf({0.3f, 0.3f, 0.3f}, high);
                    plate.density = floats ? 500 : 0;
                    const Scene scene = sceneOf(dimensions);
                    SCOPED_TRACE(testing::Message() << spacings << " " << floats);
                    const bool isThin = spacings < (floats ? 1.6 : 3.6);  // R -+ dx
                    EXPECT_NEAR(thinness(scene, plate), isThin ? spacings * Dx : 0, 1e-6);
                    EXPECT_EQ(needsScreen(scene, plate), spacings < 1.6);
                    EXPECT_EQ(faceOfPlate(scene, plate), isThin ? 2 * axis : -1);
                }
    // Fluid feels its way around rods and small pieces.
    EXPECT_EQ(thinness(sceneOf(3), blockOf({0.3f, 0.3f, 0.3f}, {0.8f, 0.32f, 0.32f})), 0);
    EXPECT_EQ(thinness(sceneOf(2), blockOf({0.3f, 0.3f, 0}, {0.32f, 0.32f, 1})), 0);
    const Surface sheet = dentedBoxSurface({0.2, 0.2, 0.2}, {0.8, 0.204, 0.8});
    EXPECT_NEAR(thinness(sceneOf(3), meshOf(sheet, "sheet.obj")), 0.004, 1e-6);
    EXPECT_EQ(thinness(sceneOf(3), meshOf(sphereSurface({0.5, 0.5, 0.5}, 0.2, 2), "b.obj")), 0);
}

// Fluid at half a spacing in front of either face has behind it all that it can see of a wall.
TEST(ThinSolid, EachSideHasAWallOfItsOwn) {
    for (const int dimensions : {2, 3})
        for (const double spacings : {0.25, 0.5, 1.0, 1.5, 2.0, 3.0})
            for (const bool mesh : {false, true}) {
                if (mesh && (dimensions == 2 || spacings > 1.5)) continue;
                SCOPED_TRACE(testing::Message() << dimensions << " " << spacings << " " << mesh);
                const double end = 0.4 + spacings * Dx;
                const Scene scene = sceneOf(dimensions);
                const Solid plate =
                    mesh ? meshOf(dentedBoxSurface({0.4, 0.2, 0.2}, {end, 0.8, 0.8}), "plate.obj")
                         : blockOf({0.4f, 0.2f, 0.2f}, {float(end), 0.8f, 0.8f});
                const SolidSample sides = sampleSides(scene, plate);
                for (const double sign : {-1.0, 1.0}) {
                    double volume = 0, moment = 0;  // of a column behind the face
                    for (size_t i = 0; i < sides.positions.size(); ++i) {
                        const Vec3 p = sides.positions[i];
                        if (std::abs(p.y - 0.5f) > 0.1f - 1e-4f ||
                            (dimensions == 3 && std::abs(p.z - 0.5f) > 0.1f - 1e-4f) ||
                            double(sides.faces[i].x) * sign > 0)
                            continue;
                        const double depth = sign > 0 ? end - p.x : p.x - 0.4;
                        EXPECT_NEAR(length(sides.faces[i]), depth, 0.3 * Dx);
                        if (mesh && depth > 1.99 * Dx) continue;
                        volume += sides.volumes[i], moment += sides.volumes[i] * depth / Dx;
                    }
                    volume /= std::pow(10, dimensions - 1), moment /= std::pow(10, dimensions - 1);
                    EXPECT_GT(volume, 1.49);  // of R - dx/2 that can be seen
                    EXPECT_LT(volume, 3.01);
                    EXPECT_NEAR(moment, volume * volume / 2, mesh ? 0.5 : 1e-3);  // without gaps
                }
            }
}

}  // namespace
}  // namespace spindrift
