// Scenes whose values are in range and still make no sense: each refused with path and remedy.
#include "scene/check.h"
#include "scene/memory.h"

#include "core/error.h"
#include "scene/json.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <optional>

namespace spindrift {
namespace {

struct Verdict {
    std::optional<Failure> failure;
    std::string text;
};
Verdict verdict(const std::vector<std::string>& knobs) {
    Scene scene;
    for (const std::string& knob : knobs) setKnob(scene, knob);
    try {
        checkScene(scene, "a.json");
    } catch (const Error& error) { return {error.failure, error.what()}; }
    return {std::nullopt, ""};
}

TEST(CheckScene, AcceptsTheDefaultsAndAllConfigs) {
    EXPECT_NO_THROW(checkScene(Scene{}));
    for (auto& entry :
         std::filesystem::recursive_directory_iterator(SPINDRIFT_SOURCE_DIR "/configs"))
        if (entry.path().extension() == ".json") {
            EXPECT_NO_THROW(checkScene(loadScene(entry.path().string()))) << entry.path();
        }
}

TEST(CheckScene, RefusesNonsenseByPathAndRemedy) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"fluid.surface_tension=0.07"},
         "a.json: fluid.surface_tension: needs particles that are kept evenly spread, or surfaces "
         "tear themselves apart; "
         "wcsph does not, use simulation.formulation delta_plus"},
        {{"simulation.formulation=delta_sph", "fluid.air_density=1"},
         "a.json: fluid.air_density: who is at the surface is known by summed densities, "
         "which delta_sph does not have; use wcsph, or 0"},
        {{"simulation.formulation=delta_sph", "simulation.pressure_form=mean"},
         "a.json: simulation.pressure_form: mean is one of wcsph; delta_sph has "
         "its own, use squares"},
        {{"fluid.buoyancy=1", "simulation.gravity_ramp=1"},
         "a.json: fluid.buoyancy: goes with the whole gravity at once; set simulation.gravity_ramp "
         "or it to 0"},
        {{"simulation.formulation=classic", "simulation.kernel=cubic_spline",
          "domain.max=0.9,0.9,0.9", "fluid.dissipation=1"},
         "a.json: fluid: velocity_transfer, buoyancy and dissipation are not of classic; use "
         "wcsph, delta_sph or delta_plus, or set them to 0"},
        {{"domain.max=0,1,1"}, "a.json: domain.max: x = 0 m is not above domain.min x = 0 m"},
        {{"domain.max=0.01,1,1"}, "domain: 0.01 m along x is less than the support radius"},
        {{"simulation.support=1.2"}, "simulation.support: 1.2 leaves particles without neighbours"},
        {{"simulation.formulation=classic"}, "domain: the classic formulation needs a cube"},
        {{"simulation.formulation=classic", "simulation.kernel=cubic_spline",
          "domain.max=1.6,1.6,1.6", "time.integrator=velocity_verlet"},
         "time.integrator: the classic formulation is stepped by symplectic_euler"},
        {{"fluid.bodies[0].field=sound_wave", "simulation.formulation=delta_sph"},
         "a sound wave needs a fluid.sound_speed"},
        {{"fluid.bodies[0].field=sound_wave", "fluid.sound_speed=10"},
         "and a formulation that carries density"},
        {{"fluid.bodies=[]"}, "fluid.bodies: is empty; add a body"},
        {{"fluid.bodies[0].max=0.5,0.5,5"},
         "fluid.bodies[0]: 5 m along z is larger than the domain's 0.6 m"},
        {{"fluid.bodies[0].min=-0.1,0,0"},
         "fluid.bodies[0]: spans -0.1 to 0.5 m along x, outside the domain's 0 to 1.6 m"},
        {{"fluid.bodies[0].max=0,0.5,0.5"},
         "fluid.bodies[0].max: x = 0 m is not above min x = 0 m"},
        {{"fluid.bodies[0].max=0.005,0.5,0.5"},
         "fluid.bodies[0]: 0.005 m along x is too thin for a particle"},
        {{"fluid.bodies[0].shape=sphere", "fluid.bodies[0].radius=0.2"}, "outside the domain's"},
        {{"compute.threads=4000", "fluid.bodies[0].max=0.1,0.1,0.1"},
         "compute.threads: 4000 threads are more than the 125 particles"},
        {{"simulation.formulation=transport_velocity"},
         "has no free surfaces, and fluid fills 19 % of the domain"},
        {{"walls.moving_face=x_min", "walls.velocity=1,0,0"},
         "walls.velocity: x = 1 m/s leads out of the face"},
        {{"walls.moving_face=x_min", "domain.periodic_x=true"},
         "walls.moving_face: there is no wall at x_min"},
        {{"walls.moving_face=y_max", "walls.kind=reflect"},
         "walls.moving_face: nothing sticks to it"},
        {{"walls.moving_face=y_max", "fluid.viscosity=0"},
         "walls.moving_face: nothing sticks to it"},
        {{"walls.slip=-0.5"}, "walls.slip: -0.5 m is no length; use -1"},
        {{"walls.slip_max=0,-0.2,0"}, "walls.slip_max: -0.2 m is no length"},
        {{"walls.slip=0.1", "walls.kind=reflect"}, "walls.slip: walls that reflect have"},
        {{"walls.slip_min=0.1,0,0", "domain.periodic_x=true"},
         "walls.slip_min: there is no wall across x"},
        {{R"(solids=[{"min":[0,0,0],"max":[0.2,0.2,0.6],"slip":-0.5}])"},
         "solids[0].slip: -0.5 m is no length"},
        {{"walls.moving_face=y_max", "walls.velocity=1,0,0", "walls.slip=-1"},
         "walls.moving_face: fluid slides freely on it"},
        {{"simulation.formulation=transport_velocity", "fluid.viscosity_form=monaghan"},
         "fluid.viscosity_form: monaghan is without what"},
        {{R"(output.probes=[{"position":[0.1,0.1,0.7]}])"},
         "output.probes[0].position: z = 0.7 m is outside the domain's 0 to 0.6 m"},
        {{R"(output.probes=[{"kind":"line","from":[0,0,0],"to":[1,2,0]}])"},
         "output.probes[0].to: y = 2 m is outside"},
        {{R"(output.probes=[{"kind":"height","position":[-1,5,0]}])"},
         "output.probes[0].position: x = -1 m is outside"},
        {{R"(output.probes=[{"name":"a"},{"kind":"front","name":"a"}])"},
         "output.probes[1].name: \"a\" is the name of output.probes[0] too"},
        {{R"(output.probes=[{"name":"a,b"}])"},
         "output.probes[0].name: \"a,b\" can't begin a column's name"},
        {{R"(output.probes=[{"name":""}])"}, "output.probes[0].name: \"\" can't"},
        {{R"(output.probes=[{"kind":"front","axis":"z"}])", "simulation.dimensions=2"},
         "output.probes[0].axis: there is no z in two dimensions"},
        {{"output.particles=end.txt"},
         "output.particles: \"end.txt\" is of no known kind; name a file that ends in .csv or .h5"},
        {{R"(fluid.bodies=[{"shape":"file","path":"/no/such.csv"}])"},
         "fluid.bodies: /no/such.csv: no such file"},
        {{R"(fluid.bodies=[{"shape":"file"}])"}, "no file is named"},
        {{"simulation.placement=relaxed", "simulation.jitter=0.1"},
         "simulation.jitter: moves particles of a lattice"},
        {{"view.range=fixed", "view.range_min=2"},
         "view.range_max: 1 is not above view.range_min 2"},
    };
    for (const auto& [knobs, words] : cases) {
        const Verdict v = verdict(knobs);
        EXPECT_EQ(v.failure, Failure::Scene) << words;
        EXPECT_NE(v.text.find(words), std::string::npos) << words << "\nin: " << v.text;
    }
}

TEST(CheckScene, RefusesABillionParticlesBeforeAllocating) {
    // 1.6 x 0.9 x 0.6 m at 1 mm is 162 million fluid particles; at 0.1 mm 162 billion.
    const Verdict large = verdict({"simulation.spacing=0.0001"});
    EXPECT_EQ(large.failure, Failure::Memory);
    EXPECT_NE(large.text.find("a.json: simulation.spacing: "), std::string::npos) << large.text;
    EXPECT_NE(large.text.find("more than the 1000000000"), std::string::npos) << large.text;
}

TEST(CheckScene, RefusesMoreThanTheMachinesMemory) {
    const double physical = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (physical > 300e9) GTEST_SKIP() << "this machine could hold it";
    const Verdict heavy =
        verdict({"simulation.spacing=0.00056"});  // 923 million particles: over 300 GB
    EXPECT_EQ(heavy.failure, Failure::Memory);
    EXPECT_NE(heavy.text.find("GiB of memory"), std::string::npos) << heavy.text;
}

TEST(CheckScene, MemoryGrowsWithParticles) {
    Scene scene;
    auto memory = [&] { return estimateMemory(scene, countParticles(scene)); };
    const int64_t coarse = memory();
    scene.simulation.spacing = 0.01f;
    EXPECT_GT(coarse, 20250 * 400);
    EXPECT_GT(memory(), 5 * coarse);
    EXPECT_LT(memory(), 9 * coarse);
    const int64_t before = memory();
    setKnob(
        scene,
        R"(objects=[{"shape":"block","min":[0.1,0.1,0.1],"max":[0.4,0.4,0.4],"spacing":0.005}])");
    EXPECT_GT(memory(), before + 61 * 61 * 61 * 1000);
}

}  // namespace
}  // namespace spindrift
