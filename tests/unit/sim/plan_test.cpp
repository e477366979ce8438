// What each shipped scene does in a step, and what it holds in memory: nothing that it doesn't
// need.
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

struct Expected {
    const char *scene, *passes;
    int bytes;
};  // bytes: a particle, at most

const char* const Still =
    "sort neighbours density walls forces extremes time-step integrate laminar-viscosity,-Monaghan "
    "artificial-viscosity";
const char* const Splash =
    "sort neighbours density walls forces gradients extremes time-step kick source begin-solve "
    "pressure-forces relax-pressure error end-solve scale-pressures pressure-kick extremes drift "
    "laminar-viscosity,-Monaghan artificial-viscosity";
const char* const SplashAtMovingSolids =
    "solids sort neighbours density walls forces gradients extremes time-step kick source "
    "begin-solve pressure-forces relax-pressure error end-solve scale-pressures pressure-kick "
    "extremes drift laminar-viscosity,-Monaghan artificial-viscosity solid-collisions";
const char* const WithMovingSolids =
    "solids sort neighbours density walls forces extremes time-step integrate "
    "laminar-viscosity,-Monaghan artificial-viscosity solid-collisions";
const char* const Classic =
    "sort neighbours density forces extremes time-step integrate classic-viscosity";
const Expected Scenes[] = {
    {"dam_break", Splash, 200},
    {"double_dam_break", Splash, 210},
    {"ball_drop", Splash, 160},
    {"pool_drop", Splash, 250},
    {"still_pool", Still, 250},
    {"wave_maker", WithMovingSolids, 290},
    {"mixer", SplashAtMovingSolids, 300},
    {"bowl", SplashAtMovingSolids, 270},
    {"floating",
     "solids sort neighbours density walls forces gradients extremes time-step kick source "
     "begin-solve pressure-forces relax-pressure error end-solve scale-pressures pressure-kick "
     "solid-forces floating-solids extremes drift laminar-viscosity,-Monaghan artificial-viscosity "
     "solid-collisions",
     345},
    {"artery",
     "solids sort neighbours density walls forces contact extremes time-step objects integrate "
     "laminar-viscosity,-Monaghan artificial-viscosity "
     "solid-collisions",
     400},
    {"oil_and_water",
     "sort neighbours density walls forces extremes time-step integrate "
     "viscosities-of-a-mixture,-Monaghan",
     265},
    {"drops",
     "sort neighbours equation-of-state forces normals surface-tension extremes time-step kick "
     "transport drift laminar-viscosity,-Monaghan "
     "artificial-viscosity",
     500},
    {"poiseuille",
     "sort neighbours equation-of-state walls forces extremes time-step kick transport drift "
     "laminar-viscosity,-Morris",
     220},
    {"1", Classic, 120},
    {"2", Classic, 150},
    {"3", Classic, 170},
};

std::string passesOf(const Simulation& simulation) {
    std::string all;
    for (const PlanRow& row : simulation.plan()) {
        if (!row.skipped.empty()) continue;
        std::string name = row.name.starts_with("forces: ") ? row.name.substr(8) : row.name;
        for (char& c : name)
            if (c == ' ') c = '-';
        all += (all.empty() ? "" : " ") + name;
    }
    return all;
}

TEST(Plan, OfEachShippedScene) {
    for (const Expected& e : Scenes) {
        SCOPED_TRACE(e.scene);
        Scene scene =
            loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/" + e.scene + ".json");
        scene.compute.backend = Backend::Cpu;
        const auto simulation = makeSimulation(scene);
        EXPECT_EQ(passesOf(*simulation), e.passes);
        const double bytes = double(simulation->bytes()) /
                             double(simulation->fluidCount() + simulation->wallCount());
        EXPECT_LE(bytes, e.bytes);
        EXPECT_GE(bytes, 0.5 * e.bytes) << "the bound says nothing any more";
    }
}

}  // namespace
}  // namespace spindrift
