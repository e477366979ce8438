// What thin solids hide is hidden for every engine: lists of clusters and rows of cells agree,
// whatever the solid is and however it is turned, and pairs that are summed once with those that
// are summed twice.
#include "sim/make_simulation.h"

#include "core/error.h"
#include "meshes.h"
#include "scene/json.h"
#include "scene/particles.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

constexpr Simd Engines[] = {Simd::Avx512, Simd::Avx2, Simd::Sse};

Scene sceneWith(const std::string& solids, int dimensions, const char* formulation) {
    Scene scene;
    for (const std::string& knob :
         {std::string("domain.max=0.8,0.6,0.6"), std::string("simulation.spacing=0.04"),
          "simulation.dimensions=" + std::to_string(dimensions),
          std::string("simulation.jitter=0.2"), "solids=" + solids,
          std::string("simulation.formulation=") + formulation, std::string("fluid.viscosity=1"),
          std::string(R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.8,0.4,0.6]}])")})
        setKnob(scene, knob);
    return scene;
}

std::string meshPlate() {
    const std::string path = several({boxSurface({0.3, 0, 0.1}, {0.33, 0.5, 0.3}),
                                      boxSurface({0.3, 0, 0.3}, {0.33, 0.45, 0.5})})
                                 .write(testing::TempDir() + "/screen.obj");
    return R"([{"shape":"mesh","path":")" + path + "\"}]";
}

TEST(Screens, HideTheSameFromListsAndRows) {
    const std::pair<std::string, int> scenes[] = {
        {R"([{"shape":"block","min":[0.3,0,0],"max":[0.31,0.6,0.6]}])", 2},
        {R"([{"shape":"block","min":[0.3,0,0],"max":[0.34,0.6,0.6]}])", 3},
        {R"([{"shape":"block","min":[0.3,0.1,0.2],"max":[0.4,0.5,0.6],"spin":90},
             {"shape":"block","min":[0.5,0.1,0.1],"max":[0.505,0.3,0.5],"velocity":[0.5,0,0]}])",
         3},
        {R"([{"shape":"cylinder","axis":"x","center":[0.4,0.2,0.3],"radius":0.2,"height":0.02}])",
         3},
        {meshPlate(), 3}};
    for (const auto& [solids, dimensions] : scenes)
        for (const char* formulation : {"wcsph", "delta_sph"}) {
            SCOPED_TRACE(testing::Message() << solids << " " << formulation);
            const Scene scene = sceneWith(solids, dimensions, formulation);
            const Placement placement = placeParticles(scene);
            const auto exact = makeDoubleSimulation(scene, placement, 2);
            exact->step();
            double most = 0;
            for (const Particle& p : exact->particles())
                most = std::max(most, length(p.acceleration));
            for (const Simd simd : Engines) {
                Scene own = scene;
                own.compute.simd = simd;
                std::unique_ptr<Simulation> lists;
                try {
                    lists = makeSimdSimulation(own, placement, 2);
                } catch (const Error&) { continue; }  // this machine lacks the instructions
                lists->step();
                const std::vector<Particle> a = exact->particles(), b = lists->particles();
                for (size_t i = 0; i < a.size(); ++i) {
                    ASSERT_NEAR(b[i].density / a[i].density, 1, 1e-5) << i;
                    ASSERT_LT(length(b[i].acceleration - a[i].acceleration), 1e-3 * most) << i;
                }
            }
        }
}

}  // namespace
}  // namespace spindrift
