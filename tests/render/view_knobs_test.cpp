// Each knob of the view shows, those without effect leave the picture as it is, and a path is where
// its particle has been.
#include "app/frame.h"
#include "picture.h"
#include "scene/json.h"
#include "sim/make_simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace spindrift {
namespace {

Scene collapse() {
    Scene scene;
    scene.simulation.spacing = 0.06f;
    scene.compute.threads = 1, scene.compute.backend = Backend::Cpu;
    return scene;
}

struct Watched {
    std::unique_ptr<Simulation> simulation;
    Frame frame;
    Watched(const Scene& scene, int width = 320, int height = 240)
        : simulation((rendererOf(16, 16), makeSimulation(scene))), frame(width, height, 4) {}
    Image picture(const Scene& scene) {
        frame.update(*simulation, scene);
        frame.draw(scene);
        return frame.image();
    }
};

Scene with(Scene scene, const std::vector<std::string>& knobs) {
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}

TEST(ViewKnobs, AreSeen) {
    const std::string file = testing::TempDir() + "view_knobs_colours.csv";
    std::ofstream(file) << "r,g,b\n255,0,255\n0,255,0\n";
    const std::vector<std::vector<std::string>> knobs = {
        {"view.clip.min=[0.2,0,0]"},
        {"view.clip.max=[1,0.2,1]"},
        {"view.slice.axis=x", "view.slice.position=0.1"},
        {"view.slice.axis=y", "view.slice.position=0.2"},
        {"view.slice.axis=z"},
        {"view.threshold.on=true", "view.threshold.max=0.3", "view.threshold.min=0.2"},
        {"view.arrows.count=20"},
        {"view.theme=light"},
        {"view.show_axes=true"},
        {"view.show_scale=true"},
        {"view.projection=orthographic"},
        {"view.color_scale=logarithmic"},
        {"view.color_map=file", "view.color_file=" + file},
        {"view.color_by=velocity_x"},
        {"view.color_by=velocity_y"},
        {"view.color_by=velocity_z"},
        {"view.color_by=vorticity"},
        {"view.color_by=shear_rate"},
        {"view.color_by=divergence"},
        {"view.color_by=neighbours"},
        {"view.path_of=5"},
    };
    const Scene plain = collapse();
    for (const char* style : {"spheres", "surface"}) {
        const Scene base = with(plain, {std::string("view.style=") + style});
        for (const auto& set : knobs) {
            Watched run(base);
            run.simulation->step(60);
            run.picture(with(base, set));
            run.simulation->step(20);  // a path has to have two places
            const Image after = run.picture(with(base, set)), moved = run.picture(base);
            EXPECT_GE(changed(moved, after, 20), set[0] == "view.path_of=5" ? 3 : 30)
                << style << " " << set[0];
        }
    }
}

TEST(ViewKnobs, WithoutEffectLeaveThePicture) {
    const Scene base = collapse();
    Watched run(base);
    run.simulation->step(20);
    const Image before = run.picture(base);
    for (const char* knob :
         {"view.slice.position=0.1", "view.slice.contours=9", "view.slice.fluid=true",
          "view.threshold.min=0.2", "view.threshold.max=0.3", "view.arrows.length=3",
          "view.color_file=none.csv", "view.clip.solids=true", "view.path_of=-1"})
        EXPECT_EQ(run.picture(with(base, {knob})), before) << knob;
}

// The window says so in the legend, and draws on.
TEST(ViewKnobs, ColorsThatCanNotBeReadAreSaid) {
    const Scene base = with(collapse(), {"view.color_map=viridis"});
    const Scene bad = with(base, {"view.color_map=file", "view.color_file=/no/such.csv"});
    Watched run(base, 800, 600);
    const Image before = run.picture(base), after = run.picture(bad);
    const int difference = changed(before, after);
    EXPECT_GT(difference, 100) << "the note";
    EXPECT_LT(difference, 5000) << "all the rest";
}

// Amber pixels, which nothing else has here.
int amber(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Rgb c = pixel(image, x, y);
            count += c.r > 220 && std::abs(c.g - 204) < 30 && std::abs(c.b - 77) < 60;
        }
    return count;
}

TEST(Path, GrowsWithTheRunAndIsForgottenWithIt) {
    const Scene base = with(collapse(), {"view.color_map=viridis", "view.color_by=plain"}),
                path = with(base, {"view.path_of=700"});
    Watched run(base);
    std::vector<int> lengths;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 10; ++i)
            run.simulation->step(20), run.frame.update(*run.simulation, path);
        lengths.push_back(amber(run.picture(path)));
    }
    EXPECT_GT(lengths[0], 3);
    EXPECT_GT(lengths[1], lengths[0]);
    EXPECT_GT(lengths[2], lengths[1]);
    EXPECT_EQ(amber(run.picture(base)), 0);
    run.picture(path);
    run.frame.restart();
    EXPECT_EQ(amber(run.picture(path)), 0);
}

Scene tap() {
    return with(collapse(),
                {"simulation.formulation=delta_sph", "simulation.dimensions=2",
                 "simulation.spacing=0.02", "domain.max=[0.6,0.5,0.1]",
                 R"(sources=[{"center":[0.2,0.4,0],"normal":[0,-1,0],"width":0.08,"velocity":1}])",
                 R"(sinks=[{"min":[0.5,-0.1,0],"max":[0.7,0.03,0]}])",
                 R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.6,0.1,0.1]}])",
                 "view.color_map=viridis", "view.color_by=plain"});
}

// One that came later has numbers beyond how many there are.
TEST(Path, IsDrawnOfAParticleThatCame) {
    Watched run(tap());
    while (run.simulation->clock().time < 0.2) run.simulation->step();
    const int id = run.simulation->particles().back().id;
    ASSERT_GE(id, run.simulation->fluidCount());
    const Scene path = with(tap(), {"view.path_of=" + std::to_string(id)});
    for (int i = 0; i < 20; ++i) run.simulation->step(5), run.frame.update(*run.simulation, path);
    ASSERT_TRUE(run.simulation->find(id));
    EXPECT_GT(amber(run.picture(path)), 3);
}

TEST(Path, EndsWhereItsParticleLeaves) {
    Watched run(tap());
    int id = -1;
    double least = 1;  // m, from the drain
    for (const Particle& p : run.simulation->particles())
        if (const double far = std::hypot(p.position.x - 0.5, p.position.y - 0.03);
            p.position.x < 0.5 && p.position.y > 0.03 && far < least)
            least = far, id = p.id;
    const Scene path = with(tap(), {"view.path_of=" + std::to_string(id)});
    while (run.simulation->find(id) && run.simulation->clock().time < 2)
        run.simulation->step(5), run.frame.update(*run.simulation, path);
    ASSERT_FALSE(run.simulation->find(id)) << "it has not left";
    const int length = amber(run.picture(path));
    EXPECT_GT(length, 3);
    run.simulation->step(100);
    EXPECT_EQ(amber(run.picture(path)), length);
}

// A moment of before shows what was known then where it was, by the colours of the whole run; and
// now is as it was.
TEST(LookingBack, LeavesRangeAndPathAsTheyAre) {
    const Scene scene = with(collapse(), {"view.path_of=700"});
    Watched run(scene);
    std::vector<RunState> states;
    std::vector<int> lengths;
    for (int k = 0; k < 10; ++k) {
        run.simulation->step(40);
        states.push_back(run.simulation->state());
        lengths.push_back(amber(run.picture(scene)));
    }
    const auto lookAt = [&](size_t moment) {
        run.simulation->restart(states[moment]);
        run.frame.update(*run.simulation, scene, true);
        run.frame.draw(scene);
        return run.frame.image();
    };
    const Range range = run.frame.range(scene.view);
    const Image now = lookAt(9), before = lookAt(3);
    EXPECT_EQ(run.frame.range(scene.view).max, range.max) << "the colours compare";
    EXPECT_LT(amber(before), amber(now));
    EXPECT_NEAR(amber(before), lengths[3], 6) << "the path ends where its particle was";
    EXPECT_EQ(lookAt(9), now);
    // The run goes on from there: its path goes another way.
    lookAt(3);
    run.simulation->step(1);
    EXPECT_NEAR(amber(run.picture(scene)), lengths[3], 6);
    EXPECT_LT(amber(lookAt(9)), amber(now)) << "what came after is forgotten";
}

TEST(ShownFluid, IsWithinThresholdsAndClipBox) {
    const Scene scene = collapse();
    Watched run(scene);
    run.simulation->step(100);
    const auto shown = [&](const std::vector<std::string>& knobs) {
        const Scene view = with(scene, knobs);
        run.frame.update(*run.simulation, view);
        return run.frame.shownFluid(view).size();
    };
    size_t fast = 0, low = 0;
    for (const Particle& p : run.simulation->particles()) {
        const bool isFast = length(p.velocity) >= 0.5, isLow = p.position.y <= 0.25;
        fast += isFast, low += isLow;
    }
    const size_t all = size_t(run.simulation->fluidCount());
    ASSERT_GT(fast, 10u);
    ASSERT_LT(fast, all);
    ASSERT_LT(low, all);
    EXPECT_EQ(shown({}), all);
    EXPECT_EQ(shown({"view.threshold.on=true", "view.threshold.min=0.5", "view.threshold.max=100"}),
              fast);
    const float height = scene.domain.max.y - scene.domain.min.y;
    EXPECT_EQ(shown({"view.clip.max=[1," + std::to_string(0.25f / height) + ",1]"}), low);
}

}  // namespace
}  // namespace spindrift
