// Mouths, what comes of them when, and what is refused.
#include "scene/sources.h"

#include "core/error.h"
#include "scene/check.h"
#include "scene/json.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace spindrift {
namespace {

Scene sceneWith(const std::vector<std::string>& knobs) {
    Scene s;
    s.simulation.spacing = 0.05f;
    s.domain.max = {1, 1, 1};
    for (const std::string& knob : knobs) setKnob(s, knob);
    return s;
}

struct TableFile {
    std::filesystem::path path;
    explicit TableFile(const std::string& text) {
        static int count = 0;
        path = std::filesystem::temp_directory_path() /
               ("spindrift_flow_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::ofstream(path) << text;
    }
    ~TableFile() { std::filesystem::remove(path); }
};

TEST(SourceLattice, HasTheVolumeOfItsMouthAndMeanOfItsProfile) {
    for (const int d : {2, 3})
        for (const Mouth mouth : {Mouth::Rectangle, Mouth::Disc})
            for (const Profile profile : {Profile::Uniform, Profile::Parabolic})
                for (const Vec3 normal : {Vec3{1, 0, 0}, Vec3{0, -3, 0}, Vec3{1, 2, 0},
                                          Vec3{0, 0, 1}, Vec3{-1, 1, 2}}) {
                    if (d == 2 && (normal.z != 0 || mouth == Mouth::Disc)) continue;
                    Scene s = sceneWith({});
                    s.simulation.dimensions = d;
                    Source source;
                    source.mouth = mouth, source.profile = profile, source.normal = normal;
                    source.width = 0.33f, source.height = 0.2f, source.radius = 0.12f;
                    const SourceLattice l = latticeOf(s, source);
                    const double n = double(l.points.size());
                    EXPECT_NEAR(n * particleVolume(s), l.area * l.apart, 1e-9);
                    EXPECT_NEAR(l.apart / 0.05, 1, 0.15);
                    EXPECT_GE(l.depth(), double(supportRadius(s)) - 1e-6);
                    double shares = 0;
                    Vec3d mean{0, 0, 0};
                    for (const SourceLattice::Point& p : l.points) {
                        shares += p.share;
                        const Vec3d arm = p.at - Vec3d{0.5, 0.5, 0.5};
                        mean = mean + arm;
                        EXPECT_NEAR(dot(arm, l.normal), 0, 1e-6);
                        EXPECT_LT(length(arm), 0.2);
                        if (profile == Profile::Uniform) { EXPECT_DOUBLE_EQ(p.share, 1); }
                    }
                    EXPECT_NEAR(shares, n, 1e-9 * n);
                    EXPECT_NEAR(length(mean), 0, 1e-6 * n);
                    if (profile == Profile::Parabolic) {
                        EXPECT_NEAR(l.largestShare(), mouth == Mouth::Disc ? 2 : 1.5,
                                    mouth == Mouth::Disc ? 0.45 : 0.1)
                            << "of so few points";
                    }
                }
}

TEST(SourceSchedule, IsTheIntegralOfWhatItsFileSays) {
    const TableFile file("t [ms], flow [l/s]\n100, 0\n300, 20\n300.5, 5\n900, 5\n");
    for (const float start : {0.0f, 0.2f})
        for (const float stop : {0.0f, 0.7f})
            for (const float volume : {0.0f, 0.003f}) {
                Scene s = sceneWith({});
                s.sources.resize(1);
                s.sources[0].path = file.path.string();
                readRates(s, "", "here");
                EXPECT_EQ(s.sources[0].path, "");
                Source& source = s.sources[0];
                source.width = 0.2f, source.height = 0.1f;
                source.start = start, source.stop = stop, source.volume = volume;
                const auto keys = scheduleOf(s, source);
                double way = 0;
                const double dt = 1e-5, area = 0.2 * 0.1;
                for (int k = 0; k < 120000; ++k) {
                    const double t = (k + 0.5) * dt;
                    double flow = t < 0.1      ? 0
                                  : t < 0.3    ? 0.02 * (t - 0.1) / 0.2
                                  : t < 0.3005 ? 0.02 - 0.015 * (t - 0.3) / 0.0005
                                               : 0.005;
                    if (t < start || (stop > 0 && t > stop)) flow = 0;
                    way += flow / area * dt;
                    if (volume > 0) way = std::min(way, double(volume) / area);
                    if (k % 1000 == 999) {
                        EXPECT_NEAR(wayAt(keys, (k + 1) * dt), way, 2e-5) << t << " " << start;
                    }
                }
                EXPECT_NEAR(largestSpeed(s, source), 1, 1e-6);
            }
}

// Wherever a ramp is cut off, what has come until then is its integral.
TEST(SourceSchedule, FollowsARampUntilItStops) {
    const TableFile ramp("t,velocity\n0,0\n10,1\n");
    for (const float stop : {1.0f, 5.0f, 10.0f, 12.0f}) {
        const Scene s = sceneWith({R"(sources=[{"path":")" + ramp.path.string() + R"("}])"});
        Source source = s.sources[0];
        source.stop = stop;
        const double due = stop <= 10 ? stop * stop / 20.0 : 5.0 + (stop - 10.0);
        EXPECT_NEAR(wayAt(scheduleOf(s, source), 20), due, 1e-6) << stop;
    }
}

// However the fluid is placed, only what is held begins before a mouth.
TEST(MouthRoom, HasOnlyWhatIsHeld) {
    for (const char* placement : {"lattice", "relaxed"}) {
        const Scene s = sceneWith({R"(sources=[{"velocity":1,"width":0.3,"height":0.3}])",
                                   std::string("simulation.placement=") + placement,
                                   R"(fluid.bodies=[{"min":[0,0,0],"max":[1,1,1]}])"});
        const Placement placed = placeParticles(s);
        const MouthRoom mouths(s);
        int64_t held = 0;
        for (size_t i = 0; i < placed.positions.size(); ++i) {
            held += placed.heldBy[i] > 0;
            if (placed.heldBy[i] == 0) {
                EXPECT_FALSE(mouths.takes(toDouble(placed.positions[i]))) << placement << " " << i;
            }
        }
        EXPECT_EQ(held, particlesInMouth(s, s.sources[0])) << placement;
        EXPECT_EQ(placed.velocities.size(), placed.positions.size());
        EXPECT_EQ(placed.pressures.size(), placed.positions.size());
    }
}

// In one line that names the knob and a way out.
TEST(SourceChecks, RefuseWhatCannotBe) {
    const std::string tap = R"(sources=[{"velocity":1%s}])";
    const auto with = [&](const std::string& more) {
        std::string knob = tap;
        return knob.replace(knob.find("%s"), 2, more);
    };
    const TableFile both("t,flow,velocity\n0,1,1\n"), back("t,velocity\n0,1\n0,2\n"),
        negative("t,velocity\n0,-1\n");
    const auto file = [&](const TableFile& f) {
        return R"(sources=[{"path":")" + f.path.string() + R"("}])";
    };
    struct Case {
        std::vector<std::string> knobs;
        std::string words;
    };
    const Case cases[] = {
        {{R"(sources=[{"center":[0.5,0.5,0.5]}])"}, "gives nothing"},
        {{with(R"(,"flow":1)")}, "more than once"},
        {{with(R"(,"normal":[0,0,0])")}, "no direction"},
        {{with(R"(,"stop":1,"start":2)")}, "not after start"},
        {{with(R"(,"width":0.01)")}, "narrower than"},
        {{with(R"(,"width":100)"), "simulation.spacing=0.01"}, "domain's diagonal"},
        {{with(R"(,"width":1.2,"height":1.2)"), "simulation.spacing=0.001"}, "are the most"},
        {{R"(sources=[{"velocity":1},{"velocity":1,"center":[0.5,0.51,0.5]}])"}, "move them apart"},
        {{with(R"(,"center":[0.5,0.95,0.5])")}, "beyond the domain"},
        {{with(""), R"(solids=[{"shape":"sphere","center":[0.5,0.6,0.5],"radius":0.05}])"},
         "solids[0] is there"},
        {{with(""), "time.mode=local"}, "set time.mode to cfl"},
        {{with(""), "time.mode=fixed", "time.step=0.1"}, "more than a spacing"},
        {{with(""), "simulation.formulation=transport_velocity"}, "transport_velocity"},
        {{with(""), "simulation.formulation=classic", "simulation.kernel=cubic_spline"}, "classic"},
        {{with(""), "fluid.bodies[0].rest_density=800", "fluid.rest_density=1000"}, "one fluid"},
        {{with(""), R"(objects=[{"min":[0.7,0.7,0.7],"max":[0.8,0.8,0.8]}])"}, "elastic objects"},
        {{with(R"(,"normal":[0,0,1])"), "simulation.dimensions=2"}, "no z in two dimensions"},
        {{with(R"(,"mouth":"disc")"), "simulation.dimensions=2"}, "disc has three dimensions"},
        {{R"(sources=[{"path":"/nowhere.csv"}])"}, "/nowhere.csv"},
        {{R"(sinks=[{"min":[0,0,0],"max":[0,1,1]}])"}, "make it larger"},
        {{R"(sinks=[{"min":[2,0,0],"max":[3,1,1]}])"}, "outside of the domain"},
        {{R"(fluid.bodies=[])", R"(sinks=[{"min":[0,0,0],"max":[1,1,1]}])"}, "is empty"},
        {{R"(sources=[{"velocities":[[1,1],[1,2]]}])"}, "put times in order"},
        {{R"(sources=[{"flows":[[0,1]],"velocity":1}])"}, "more than once"},
        {{R"(sources=[{"velocities":[[0,1,2]]}])"}, "[[t, m/s], ...]"},
        {{R"(sources=[{"velocities":[[0,-1]]}])"}, "out of range"},
        {{file(both)}, "one column"},
        {{file(back)}, "put times in order"},
        {{file(negative)}, "out of range"},
    };
    for (const Case& c : cases) try {
            const Scene s = sceneWith(c.knobs);
            checkScene(s, "here");
            EXPECT_EQ(c.words, "") << c.knobs[0] << " was taken";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(c.words), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    EXPECT_NO_THROW(checkScene(sceneWith({with(""), "fluid.bodies=[]"}), "here"));
}

// A file of rates beside rates, whichever comes first in the text; a new file alone replaces them.
TEST(Sources, SayOnceHowMuchTheyGive) {
    const TableFile file("t,flow\n0,1\n");
    const std::string path = "\"path\":\"" + file.path.string() + "\"";
    const auto sceneOf = [](const std::string& source) {
        return parseScene(R"({"version":2,"sources":[{)" + source + "}]}", "here");
    };
    for (const std::string rates : {R"("velocities":[[0,1]])", R"("flows":[[0,2]])"})
        for (const std::string& both : {rates + "," + path, path + "," + rates}) try {
                sceneOf(both);
                ADD_FAILURE() << both << " was taken";
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()).find("here: sources[0] says more than once"),
                          std::string::npos)
                    << error.what();
            }
    EXPECT_THROW(sceneWith({R"(sources=[{"velocities":[[0,1]],)" + path + "}]"}), Error);
    Scene scene = sceneOf(R"("velocities":[[0,1]])");
    setKnob(scene, "sources[0].path=" + file.path.string());
    EXPECT_TRUE(scene.sources[0].velocities.empty());
    ASSERT_EQ(scene.sources[0].flows.size(), 1u);
    EXPECT_EQ(scene.sources[0].flows[0].value, 1);
}

}  // namespace
}  // namespace spindrift
