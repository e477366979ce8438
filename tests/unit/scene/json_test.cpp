// Reading scenes and knobs: what is accepted, and each mistake by its words and exit code.
#include "core/error.h"
#include "scene/json.h"
#include "scene/suggest.h"

#include <gtest/gtest.h>

#include <functional>

namespace spindrift {
namespace {

// The message of the Error(Failure::Scene) that `act` throws; "" when it throws none.
std::string complaint(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        EXPECT_EQ(int(error.failure), int(Failure::Scene)) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos)
            << "one line: " << error.what();
        return error.what();
    }
    return "";
}
std::string complaintOf(const std::string& text) {
    return complaint([&] { parseScene(text, "a.json"); });
}
std::string setComplaint(const std::string& text) {
    Scene scene;
    const std::string before = writeScene(scene),
                      message = complaint([&] { setKnob(scene, text); });
    EXPECT_EQ(writeScene(scene), before) << "a refused knob changes nothing";
    return message;
}

TEST(ReadScene, KeepsDefaultsAndIgnoresComments) {
    const Scene scene =
        parseScene("// water\n{ \"version\": 2, // two\n \"fluid\": {\"gamma\": 5} }", "a.json");
    EXPECT_EQ(scene.fluid.gamma, 5);
    EXPECT_EQ(scene.simulation.spacing, Scene{}.simulation.spacing);
    EXPECT_NO_THROW(parseScene("{\"version\": 2, \"$schema\": \"scene.schema.json\"}", "a.json"));
}

TEST(ReadScene, ReadsBodiesByShape) {
    const Scene scene = parseScene(R"({"version": 2, "fluid": {"bodies": [
        {"min": [0.1, 0, 0]},
         {"shape": "cylinder", "axis": "z", "radius": 0.2, "velocity": [1, 2, 3]}]}})",
                                   "a.json");
    ASSERT_EQ(scene.fluid.bodies.size(), 2u);
    EXPECT_EQ(scene.fluid.bodies[0].min.x, 0.1f);
    EXPECT_EQ(scene.fluid.bodies[1].axis, Axis::Z);
    EXPECT_EQ(scene.fluid.bodies[1].velocity, (Vec3{1, 2, 3}));
    EXPECT_TRUE(
        parseScene(R"({"version": 2, "fluid": {"bodies": []}})", "a.json").fluid.bodies.empty());
}

TEST(ReadScene, NamesPlaceAndRemedyOfEachMistake) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"{\"version\": 2,\n  \"fluid\": {,}}",
         "a.json: line 2, column 13: not valid JSON: syntax error"},
        {"", "a.json: line 1, column 1: not valid JSON"},
        {"[1, 2]", "a.json: the file: expected an object {...}, found [1,2]"},
        {"{\"version\": 2, \"time\": 3}", "a.json: time: expected an object {...}, found 3"},
        {R"({"version": 2, "fluid": {"viscosty": 1}})",
         "a.json: fluid.viscosty: unknown key; did you mean \"viscosity\"?"},
        {R"({"version": 2, "viscosity": 1})",
         "a.json: viscosity: unknown key; did you mean fluid.viscosity?"},
        {R"({"version": 2, "fluid.viscosity": 1})", "unknown key; did you mean fluid.viscosity?"},
        {R"({"version": 2, "domain": {"qqqqqqqq": 1}})",
         "domain.qqqqqqqq: unknown key; known here: max, min"},
        {R"({"version": 2, "fluid": {"viscosity": "thick"}})",
         "fluid.viscosity: expected a number in Pa s, found \"thick\""},
        {R"({"version": 2, "fluid": {"viscosity": -1}})",
         "fluid.viscosity: -1 is out of range, allowed: 0 to 1000 Pa s"},
        {R"({"version": 2, "fluid": {"viscosity": NaN}})", "not valid JSON"},
        {R"({"version": 2, "fluid": {"viscosity": 1e999}})",
         "not valid JSON: number overflow parsing '1e999'"},
        {R"({"version": 2, "simulation": {"spacing": 0}})",
         "simulation.spacing: 0 is out of range, allowed: 1e-07 to 10000 m"},
        {R"({"version": 2, "simulation": {"gravity": -9.8}})",
         "simulation.gravity: expected three numbers [x, y, z] in m/s², found -9.8"},
        {R"({"version": 2, "simulation": {"gravity": [0, -981, 0]}})",
         "[0,-981,0] is out of range"},
        {R"({"version": 2, "simulation": {"kernel": "wendland"}})",
         "expected one of wendland_c2, cubic_spline, wendland_c4, wendland_c6, quintic_spline, "
         "mueller, found \"wendland\"; did you mean "
         "\"wendland_c2\"?"},
        {R"({"version": 2, "compute": {"threads": 1.5}})",
         "compute.threads: expected a whole number, found 1.5"},
        {R"({"version": 2, "compute": {"threads": -1}})", "compute.threads: -1 is out of range"},
        {R"({"version": 2, "compute": {"steps": 99999999999999}})",
         "compute.steps: 99999999999999 is out of range"},
        {R"({"version": 2, "view": {"show_walls": 1}})",
         "view.show_walls: expected true or false, found 1"},
        {R"({"version": 2, "name": 1})", "name: expected text in quotes, found 1"},
        {R"({"version": 7})", "version: 7 is out of range, allowed: 2"},
        {R"({"version": 2, "name": "a", "name": "b"})",
         "the key \"name\" stands twice in one object"},
        {R"({"version": 2, "fluid": {"bodies": 3}})",
         "fluid.bodies: expected a list of objects [{...}], found 3"},
        {R"({"version": 2, "fluid": {"bodies": [3]}})",
         "fluid.bodies[0]: expected an object {...}, found 3"},
        {R"({"version": 2, "fluid": {"bodies": [{"radius": 1}]}})",
         "fluid.bodies[0].radius: unknown key; known here: field, max, min, name, pressure, "
         "rest_density, shape, velocity, viscosity"},
        {R"({"version": 2, "output": {"probes": [{"kind": "heigth"}]}})",
         "output.probes[0].kind: expected one of point, line, height, front, found \"heigth\"; did "
         "you mean \"height\"?"},
        {R"({"version": 2, "output": {"probes": [{"kind": "front", "radius": 1}]}})",
         "output.probes[0].radius: unknown key; known here: axis, kind, name"},
        {R"({"version": 2, "fluid": {"bodies": [{}, {"shape": "cube"}]}})",
         "fluid.bodies[1].shape: expected one of"},
        {"{\"version\": 2, \"name\": " + std::string(100000, '[') + "}",
         "nested more than 32 levels deep"},
    };
    for (const auto& [text, words] : cases)
        EXPECT_NE(complaintOf(text).find(words), std::string::npos)
            << words << "\nin: " << complaintOf(text);
}

TEST(ReadScene, RefusesWhatIsNoFile) {
    EXPECT_NE(complaint([] { loadScene("/no/such.json"); }).find("/no/such.json: no such file"),
              std::string::npos);
    EXPECT_NE(complaint([] { loadScene("/tmp"); }).find("/tmp: is a folder"), std::string::npos);
    EXPECT_NE(complaint([] { loadScene("/dev/zero"); }).find("larger than 16 MiB"),
              std::string::npos);
}

TEST(SetKnob, TakesLooseValues) {
    Scene scene;
    for (const char* text :
         {"fluid.viscosity=0.25", "simulation.kernel=cubic_spline", "simulation.gravity=1,2,3",
          "view.show_walls=true", "window.title=7 seas", "output.csv=1", "domain.max=[3,4,5]",
          "fluid.bodies=[{\"shape\": \"sphere\"}, {}]", "fluid.bodies[0].radius=0.3"})
        EXPECT_EQ(complaint([&] { setKnob(scene, text); }), "");
    EXPECT_EQ(scene.fluid.viscosity, 0.25f);
    EXPECT_EQ(scene.simulation.kernel, Kernel::CubicSpline);
    EXPECT_EQ(scene.simulation.gravity, (Vec3{1, 2, 3}));
    EXPECT_TRUE(scene.view.showWalls);
    EXPECT_EQ(scene.window.title, "7 seas");
    EXPECT_EQ(scene.output.csv, "1");
    EXPECT_EQ(scene.domain.max, (Vec3{3, 4, 5}));
    ASSERT_EQ(scene.fluid.bodies.size(), 2u);
    EXPECT_EQ(scene.fluid.bodies[0].radius, 0.3f);
}

TEST(SetKnob, NamesTheMistake) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"fluid.viscosity", "--set: fluid.viscosity: expected path=value"},
        {"fluid.viscosty=1", "unknown knob; did you mean fluid.viscosity?"},
        {"viscosity=1", "unknown knob; did you mean fluid.viscosity?"},
        {"fluid.viscosity=nan", "expected a number in Pa s, found \"nan\""},
        {"fluid.viscosity=-3", "-3 is out of range, allowed: 0 to 1000 Pa s"},
        {"fluid.bodies[7].radius=1", "unknown knob"},
        {"=", "unknown knob"},
        {"compute.threads=many", "expected a whole number"},
    };
    for (const auto& [text, words] : cases)
        EXPECT_NE(setComplaint(text).find(words), std::string::npos)
            << words << "\nin: " << setComplaint(text);
}

TEST(Historical, BecomesTheClassicFormulation) {
    const Scene scene = loadScene(SPINDRIFT_SOURCE_DIR "/configs/2.json");
    EXPECT_EQ(scene.simulation.formulation, Formulation::Classic);
    EXPECT_EQ(scene.simulation.kernel, Kernel::CubicSpline);
    EXPECT_EQ(supportRadius(scene), 0.04f);
    EXPECT_EQ(particleMass(scene), 0.0000765f);
    EXPECT_EQ(scene.simulation.gravity, (Vec3{0, -9.8f, 0}));
    EXPECT_EQ(scene.simulation.accelerationLimit, 1000);
    EXPECT_EQ(scene.domain.max, (Vec3{1.2f, 1.2f, 1.2f}));
    EXPECT_EQ(scene.walls.kind, WallKind::Particles);
    EXPECT_EQ(scene.walls.restitution, 1);
    EXPECT_EQ(scene.walls.margin, 0.001f);
    EXPECT_EQ(scene.time.mode, TimeMode::Fixed);
    EXPECT_EQ(scene.time.step, 0.0025f);
    EXPECT_EQ(scene.fluid.stiffness, 10);
    EXPECT_EQ(scene.fluid.restDensity, 1);
    EXPECT_EQ(scene.fluid.viscosity, 0.05f);
    EXPECT_EQ(scene.window.width, 800);
    EXPECT_EQ(scene.compute.backend, Backend::Auto);
}

TEST(Historical, ReadsEveryKey) {
    const Scene scene = parseScene(R"({
        "window": {"title": "t", "width": 640, "height": 480, "point_size": 5},
        "compute": {"cli": true, "gpu": false, "gpu_threads": 256, "omp_threads": 3, "steps": 77},
        "simulation": {"delta": 0.001, "space_size": 2, "smooth_radius": 0.05,
         "fluid_grid": [4, 5, 6],
                       "box_boundary": true},
        "fluid": {"gravity": -1, "mass": 1e-4, "density": 2, "viscosity": 0.1, "stiffness": 20}})",
                                   "old.json");
    EXPECT_EQ(scene.window.title, "t");
    EXPECT_EQ(scene.window.pointSize, 5);
    EXPECT_TRUE(scene.output.headless);
    EXPECT_EQ(scene.compute.backend, Backend::Cpu);
    EXPECT_EQ(scene.compute.threads, 3);
    EXPECT_EQ(scene.compute.steps, 77);
    EXPECT_EQ(scene.walls.kind, WallKind::Reflect);
    EXPECT_EQ(scene.simulation.support, 2);
    const Body& body = scene.fluid.bodies[0];
    EXPECT_NEAR(body.max.y - body.min.y, 0.125, 1e-6);
    EXPECT_NEAR(body.max.z + body.min.z, 2, 1e-6);
}

TEST(Historical, RefusesMistakesLikeTheNewLayout) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {R"({"fluid": {"gravty": 1}})",
         "a.json: fluid.gravty: unknown key; did you mean \"gravity\"? (without \"version\""},
        {R"({"domain": {}})", "domain: unknown key"},
        {R"({"simulation": {"smooth_radius": 0}})", "simulation.smooth_radius: 0 is out of range"},
        {R"({"compute": {"omp_threads": 0}})",
         "compute.omp_threads: 0 is out of range, allowed: 1 to 4096"},
        {R"({"simulation": {"fluid_grid": [1, 2]}})", "expected three whole numbers"},
        {R"({"simulation": {"fluid_grid": [1, 2, 0]}})",
         "simulation.fluid_grid: 0 is out of range"},
    };
    for (const auto& [text, words] : cases)
        EXPECT_NE(complaintOf(text).find(words), std::string::npos)
            << words << "\nin: " << complaintOf(text);
}

TEST(Suggest, FindsTheNearestName) {
    EXPECT_EQ(editDistance("kitten", "sitting"), 3);
    EXPECT_EQ(editDistance("gmama", "gamma"), 1);  // swapped neighbours are one mistake
    EXPECT_EQ(editDistance("", "abc"), 3);
    EXPECT_EQ(nearestName("colour_by", {"color_map", "color_by", "range"}), "color_by");
    EXPECT_EQ(nearestName("zzzz", {"color_map", "min"}), "");
    EXPECT_EQ(nearestName(std::string(100000, 'a'), {"aaa"}), "");
}

}  // namespace
}  // namespace spindrift
