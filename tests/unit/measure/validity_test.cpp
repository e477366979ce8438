// What is outside the validity of the method is said, once, with what would mend it; what is inside
// is not.
#include "measure/validity.h"

#include "scene/json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace spindrift {
namespace {

constexpr float Dx = 0.02f;

Scene sceneOf(const std::vector<std::string>& knobs) {
    Scene s;
    s.simulation.spacing = Dx;
    s.domain.max = {1, 1, 1};
    for (const std::string& knob : knobs) setKnob(s, knob);
    return s;
}
bool says(const std::vector<std::string>& remarks, const std::string& what) {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const std::string& r) { return r.find(what) != std::string::npos; });
}
Scene withBlock(const char* list, Vec3 low, Vec3 high) {
    Scene s = sceneOf({});
    if (std::string(list) == "solids") {
        Solid solid;
        solid.shape = Shape::Block, solid.min = low, solid.max = high;
        s.solids = {solid};
    } else {
        s.fluid.bodies[0].min = low, s.fluid.bodies[0].max = high;
    }
    return s;
}

TEST(Validity, BodiesNeedTwoSpacingsAlongEachAxis) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float spacings : {1.0f, 1.5f, 1.9f, 2.0f, 2.5f, 10.0f}) {
            Vec3 high{0.5f, 0.5f, 0.5f};
            high[axis] = spacings * Dx;
            const auto remarks = remarksOn(withBlock("bodies", {0, 0, 0}, high));
            EXPECT_EQ(says(remarks, std::string("along ") + "xyz"[axis] + ", fewer than the 2"),
                      spacings < 2)
                << axis << " " << spacings;
            EXPECT_EQ(remarks.size(), spacings < 2 ? 1u : 0u);
        }
    Scene flat = withBlock("bodies", {0, 0, 0}, {0.5f, 0.5f, Dx});
    flat.simulation.dimensions = 2;
    EXPECT_TRUE(remarksOn(flat).empty());
}

TEST(Validity, PressuresThatAreSolvedForNeedAFreeSurface) {
    for (const int dimensions : {2, 3})
        for (const char* formulation : {"wcsph", "incompressible"})
            for (const float height : {0.5f, 0.9f, 1.0f}) {
                Scene s = sceneOf({std::string("simulation.formulation=") + formulation,
                                   "simulation.dimensions=" + std::to_string(dimensions)});
                s.fluid.bodies[0].min = {0, 0, 0}, s.fluid.bodies[0].max = {1, height, 1};
                EXPECT_EQ(says(remarksOn(s), "use transport_velocity"),
                          height == 1 && formulation == std::string("incompressible"))
                    << formulation << " " << height << " " << dimensions;
            }
}

TEST(Validity, SupportsNeedTwoSpacings) {
    for (const float support : {1.5f, 1.9f, 2.0f, 2.6f, 3.2f}) {
        Scene s = sceneOf({});
        s.simulation.support = support;
        EXPECT_EQ(says(remarksOn(s), "simulation.support: "), support < 2) << support;
    }
}

// Plates separate fluid however thin they are; through rods fluid half a spacing off each side
// feels what is within the support.
TEST(Validity, RodsKeepFluidOnTheirSidesApart) {
    for (const float support : {2.0f, 2.6f, 3.2f})
        for (int axis = 0; axis < 3; ++axis)
            for (const float spacings : {0.25f, 0.9f, 1.1f, 1.5f, 1.7f, 2.1f, 2.3f, 5.0f}) {
                Vec3 low{0, 0, 0}, high{1, 1, 1};
                low[axis] = 0.5f, high[axis] = 0.5f + spacings * Dx;
                Scene plate = withBlock("solids", low, high);
                plate.simulation.support = support;
                EXPECT_FALSE(says(remarksOn(plate), "thickness")) << support << " " << spacings;
                const int other = (axis + 1) % 3;
                low[other] = 0.5f, high[other] = 0.5f + spacings * Dx;
                Scene rod = withBlock("solids", low, high);
                rod.simulation.support = support;
                EXPECT_EQ(says(remarksOn(rod), "solids[0], thickness: "), spacings < support - 1)
                    << support << " " << spacings;
            }
}

TEST(Validity, GapsNeedTwoSpacings) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float spacings : {0.0f, 0.5f, 1.0f, 1.9f, 2.0f, 3.0f}) {
            const bool narrow = spacings > 0 && spacings < 2;
            Vec3 low{0, 0, 0}, high{1, 1, 1};
            low[axis] = spacings * Dx, high[axis] = 0.4f;
            Scene wall = withBlock("solids", low, high);
            EXPECT_EQ(
                says(remarksOn(wall), std::string("the domain's beginning along ") + "xyz"[axis]),
                narrow)
                << spacings;
            low[axis] = 0, high[axis] = 0.3f;
            Scene two = withBlock("solids", low, high);
            low[axis] = 0.3f + spacings * Dx, high[axis] = 0.6f;
            two.solids.push_back(withBlock("solids", low, high).solids[0]);
            two.solids[1].name = "gate";
            EXPECT_EQ(says(remarksOn(two), "solids[0], gap: "), narrow) << spacings;
            EXPECT_EQ(says(remarksOn(two), "between it and solids[1] (gate)"), narrow) << spacings;
        }
}

TEST(Validity, OfAMeasurementIsSaidOnceUntilTheRunGoesBack) {
    Measurement m;
    m.soundSpeed = 10, m.time = 0.1;
    Validity v(sceneOf({}));
    m.densityError = 0.029, m.maxSpeed = 2.9;
    v.look(m);
    EXPECT_TRUE(v.remarks().empty());
    m.densityError = 0.24;
    v.look(m);
    m.time = 0.2, m.densityError = 0.3, m.maxSpeed = 3.1;
    v.look(m), v.look(m);
    ASSERT_EQ(v.remarks().size(), 2u);
    EXPECT_EQ(
        v.remarks()[0].text,
        "mean compression: 24 % at 0.1 s, above 3 %; leave room for the fluid that is displaced, "
        "or raise fluid.speed_ratio (fluid.sound_speed)");
    EXPECT_EQ(v.remarks()[1].text,
              "Mach number: 0.31 at 0.2 s, above 0.3; set fluid.sound_speed to 31 m/s or more");
    v.dropAfter(0.15);
    ASSERT_EQ(v.remarks().size(), 1u);
    v.look(m);
    EXPECT_EQ(v.remarks().size(), 2u);

    Validity classic(sceneOf({"simulation.formulation=classic"}));
    m.maxSpeed = 0;
    classic.look(m);
    EXPECT_TRUE(classic.remarks().empty()) << "its densities are what its masses make of them";
}

TEST(Validity, LongWavesOfPressureThatAreNotFoundAreSaid) {
    for (const int64_t rough : {0, 12, 30, 31, 500}) {
        Measurement m;
        m.solvesPressure = true, m.steps = 1000, m.solve.rough = rough;
        Validity v(sceneOf({"simulation.formulation=incompressible"}));
        v.look(m), v.look(m);
        ASSERT_EQ(v.remarks().size(), rough > 30 ? 1u : 0u) << rough;
        if (rough > 30) { EXPECT_EQ(keyOf(v.remarks()[0].text), "long waves of pressure"); }
    }
}

// Their support is their original's. (Where elastic objects hold the fluid gaps are not judged.)
TEST(Validity, OfShippedScenesOnlyTheHistoricalHaveRemarks) {
    for (const auto& entry : std::filesystem::directory_iterator(SPINDRIFT_SOURCE_DIR "/configs")) {
        if (entry.path().extension() != ".json") continue;
        const std::string name = entry.path().stem();
        const auto remarks = remarksOn(loadScene(entry.path().string()));
        const bool historical = name == "1" || name == "2" || name == "3";
        EXPECT_EQ(remarks.size(), historical ? 1u : 0u)
            << name << (remarks.empty() ? "" : ": " + remarks.front());
        EXPECT_EQ(says(remarks, "simulation.support: 1.6 spacings"), historical) << name;
    }
}

}  // namespace
}  // namespace spindrift
