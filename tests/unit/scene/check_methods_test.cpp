// Every combination of methods is one that docs/SCENES.md promises, or refused in a line whose
// advice leads to one.
#include "scene/check_methods.h"

#include "core/error.h"
#include "methods.h"
#include "scene/check.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

Scene sceneOf(const Method& m, int dimensions) {
    Scene s;
    setMethod(s, m);
    s.simulation.dimensions = dimensions;
    s.simulation.spacing = 0.1f;
    s.domain.max = {1, 1, 1};
    s.fluid.bodies = {Body{{.max{1, 1, 1}}}};
    return s;
}

std::string refusalOf(const Scene& s) {
    try {
        checkScene(s, "a.json");
        return "";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::Scene);
        return error.what();
    }
}

// Takes the first value that the advice names.
void follow(Scene& s, const std::string& refusal) {
    const std::string advice = refusal.substr(refusal.rfind("use "));
    size_t first = std::string::npos;
    int knobOfIt = -1, valueOfIt = -1;
    visitMethod(s, [&](int k, const char*, auto& knob) {
        for (size_t value = 0; value < enumNames(knob).size(); ++value)
            if (const size_t at = advice.find(enumNames(knob)[value]); at < first)
                first = at, knobOfIt = k, valueOfIt = int(value);
    });
    ASSERT_NE(knobOfIt, -1) << refusal;
    visitMethod(s, [&](int k, const char*, auto& knob) {
        if (k == knobOfIt) knob = std::decay_t<decltype(knob)>(valueOfIt);
    });
}

TEST(CheckMethods, AllowsWhatIsPromisedAndRefusesTheRestWithAWayOut) {
    for (const int dimensions : {2, 3}) {
        const std::vector<Method> all = allMethods();
        ASSERT_EQ(all.size(), 6u * 6 * 4 * 2 * 2 * 3);
        for (const Method& m : all) {
            Scene s = sceneOf(m, dimensions);
            std::string refusal = refusalOf(s);
            EXPECT_EQ(refusal.empty(), goesTogether(m, dimensions)) << nameOf(m) << ": " << refusal;
            for (int advice = 0; advice < 6 && !refusal.empty(); ++advice) {
                EXPECT_EQ(refusal.find('\n'), std::string::npos);
                follow(s, refusal);
                refusal = refusalOf(s);
            }
            EXPECT_EQ(refusal, "") << nameOf(m);
        }
    }
}

// Without walls nothing reflects.
TEST(CheckMethods, TransportVelocityNeedsNoParticlesInWallsThatAreNotThere) {
    Scene s = sceneOf({}, 2);
    s.simulation.formulation = Formulation::TransportVelocity, s.walls.kind = WallKind::Reflect;
    s.simulation.spacing = 0.05f, s.domain.periodicX = true;
    EXPECT_NE(refusalOf(s).find("walls.kind"), std::string::npos);
    s.domain.periodicY = true;
    EXPECT_EQ(refusalOf(s), "");
}

}  // namespace
}  // namespace spindrift
