// The real program, as a shell sees it: each mistake by its words and exit code, and what it prints
// when all is well.
#include "render/image.h"
#include "scene/json.h"
#include "scene/read_knobs.h"
#include "core/hdf5_file.h"
#include "shell.h"

#include <fmt/format.h>

#include <algorithm>

namespace spindrift {
namespace {

class CommandLine : public Shell {};

const std::string Small = "test/ball_drop_small --headless --threads 2 ";

TEST_F(CommandLine, MistakesInTheArguments) {
    expectMistake("--bogus", Exit::Usage, "--bogus");
    expectMistake("pool_drop extra", Exit::Usage, "extra");
    expectMistake(Small + "--steps", Exit::Usage, "--steps");
    expectMistake(Small + "--steps many", Exit::Usage,
                  "--steps: compute.steps: expected a whole number, found \"many\"");
    expectMistake(Small + "--steps -5", Exit::Usage, "-5 is out of range, allowed: 0 to");
    expectMistake(Small + "--threads 0", Exit::Usage, "leave it out for all cores");
    expectMistake(Small + "--size 800", Exit::Usage,
                  "--size: expected WIDTHxHEIGHT, found \"800\"");
    expectMistake(Small + "--size 0x600", Exit::Usage,
                  "window.width: 0 is out of range, allowed: 16 to 16384 px");
    expectMistake(Small + "--camera 1", Exit::Usage, "--camera: expected YAW,PITCH[,DISTANCE]");
    expectMistake(Small + "--color speed", Exit::Usage,
                  "view.color_by: expected one of plain, velocity");
    expectMistake(Small + "--set fluid.viscosty=1", Exit::Usage, "did you mean fluid.viscosity?");
    expectMistake(Small + "--set fluid.viscosity", Exit::Usage, "--set: expected path=value");
    expectMistake(Small + "--set fluid.viscosity=nan", Exit::Usage, "expected a number in Pa s");
    expectMistake(Small + "--set fluid.viscosity=-1", Exit::Usage,
                  "out of range, allowed: 0 to 1000 Pa s");
    expectMistake(Small + "--set fluid.viscosity=", Exit::Usage,
                  "expected a number in Pa s, found \"\"");
    expectMistake(Small + "--set fluid.bodies[0].height=1", Exit::Usage,
                  "unknown knob; known here: center, field, name, pressure, radius, rest_density, "
                  "shape, velocity, viscosity");
    expectMistake("compare", Exit::Usage, "required");
}

TEST_F(CommandLine, MistakesInTheScene) {
    expectMistake("nowhere.json", Exit::Scene, "nowhere.json: no such scene file");
    expectMistake("pool_dorp", Exit::Scene, "did you mean pool_drop?");
    expectMistake(".", Exit::Scene, "is a folder");
    for (const char* kind : {"obj", "STL", "ply", "gltf", "glb"})
        expectMistake(write(std::string("part.") + kind, "v 0 0 0"), Exit::Scene,
                      std::string("part.") + kind + ": is a mesh; a scene names it");
    for (const char* kind : {"csv", "h5", "hdf5"})
        expectMistake(write(std::string("cloud.") + kind, "x,y,z"), Exit::Scene,
                      std::string("cloud.") + kind + ": is no scene; one takes its particles");
    expectMistake(write("a.json", "{\"version\": 2,\n \"fluid\": {]}") + " --headless", Exit::Scene,
                  "a.json: line 2, column 12: not valid JSON");
    expectMistake(write("b.json", R"({"version": 2, "fluid": {"gmama": 7}})"), Exit::Scene,
                  "b.json: fluid.gmama: unknown key; did you mean \"gamma\"?");
    expectMistake(write("c.json", R"({"version": 2, "fluid": {"gamma": [7]}})"), Exit::Scene,
                  "c.json: fluid.gamma: expected");
    expectMistake(write("d.json", R"({"simulation": {"smooth_radius": 0}})"), Exit::Scene,
                  "d.json: simulation.smooth_radius: 0 is out of range");
    expectMistake(write("e.json", R"({"simulation": {"fluid_grid": [100, 10, 10]}})"), Exit::Scene,
                  "e.json: fluid.bodies[0]: 2.5 m along x is larger than the domain's 1 m");
    expectMistake(Small + "--threads 4000", Exit::Scene,
                  "compute.threads: 4000 threads are more than the");
    expectMistake(Small + "--set simulation.spacing=0.00001", Exit::Memory,
                  "raise simulation.spacing");
}

TEST_F(CommandLine, MistakesWithOutputsAreFoundBeforeTheRun) {
    // Steps without end: only a refusal before the first one comes back.
    const std::string endless = Small + "--steps 1000000000 ";
    for (const char* option : {"--screenshot", "--csv", "--json"})
        expectMistake(endless + option + " missing/file", Exit::Output,
                      "missing/file: can't be written");
    expectMistake(endless + "--csv .", Exit::Output, "it is a folder");
    expectMistake(endless + "--frames /proc/frames", Exit::Output,
                  "/proc/frames: can't be written");
    expectMistake(endless + "--csv - --json -", Exit::Output, "both want standard output");
    expectMistake(endless + "--csv run --json run", Exit::Output, "two outputs want this file");
    expectMistake(endless + "--csv a.csv --screenshot missing/a.png", Exit::Output,
                  "missing/a.png");
    expectMistake(endless + "--csv run --json ./run", Exit::Output, "two outputs want this file");
    for (const char* wrong : {"--screenshot x.jpg", "--screenshot x.bmp", "--csv x.h5",
                              "--json x.csv", "--hdf5 x.json", "--checkpoint x.png"})
        expectMistake(endless + wrong, Exit::Output, "give it a name that ends in .");
    EXPECT_TRUE(files().empty()) << files().front();
    write("scene.json", R"({"version": 2})");
    expectMistake("scene.json --headless --json scene.json", Exit::Output,
                  "the run is read from it");
}

TEST_F(CommandLine, AnUnnamedSceneIsNamedAfterItsFile) {
    write("my flume.json", R"({"version": 2})"),
        write("b.json", R"({"version": 2, "name": "named"})"),
        write("old.json", R"({"simulation": {}})");
    EXPECT_NE(call("'my flume.json' --print-config").text.find("\"name\": \"my flume\""),
              std::string::npos);
    EXPECT_NE(call("b.json --print-config").text.find("\"name\": \"named\""), std::string::npos);
    EXPECT_NE(call("old.json --print-config").text.find("\"name\": \"old\""), std::string::npos);
    EXPECT_EQ(
        parseScene(call("'my flume.json' --print-config --set name=other").text, "printed").name,
        "other");
}

TEST_F(CommandLine, PrintConfigIsAScene) {
    const Outcome first = call(
        "pool_drop --set fluid.viscosity=0.25 --camera -30,10.5 --size 640x480 --print-config");
    ASSERT_EQ(first.code, 0) << first.text;
    const Scene scene = parseScene(first.text, "printed");
    EXPECT_EQ(scene.fluid.viscosity, 0.25f);
    EXPECT_EQ(scene.view.camera.yaw, -30);
    EXPECT_EQ(scene.window.height, 480);
    EXPECT_EQ(scene.fluid.bodies.size(), 2u);
    const Outcome again = call(write("again.json", first.text) + " --print-config");
    EXPECT_EQ(again.text, first.text);
    // Without a scene it is the dam break.
    const std::string dam = call("dam_break --print-config").text;
    EXPECT_EQ(call("--print-config").text, dam);
    EXPECT_EQ(call("run --print-config").text, dam);
}

TEST_F(CommandLine, SchemaIsJson) {
    const Outcome outcome = call("schema");
    EXPECT_EQ(outcome.code, 0);
    const Json schema = parseJson(outcome.text, "schema");
    EXPECT_EQ(schema["properties"]["simulation"]["properties"]["spacing"]["type"], "number");
    const std::string tables = call("schema --markdown").text;
    EXPECT_NE(tables.find("\n| `fluid.viscosity` | 0.001 |"), std::string::npos) << tables;
}

TEST_F(CommandLine, HelpHasOptionsAndKnobs) {
    const Outcome outcome = call("--help");
    EXPECT_EQ(outcome.code, 0);
    for (const char* text :
         {"--screenshot", "compare", "schema", "fluid.viscosity", "0 to 1000 Pa s"})
        EXPECT_NE(outcome.text.find(text), std::string::npos) << text;
    EXPECT_EQ(call("--version").text.find("spindrift "), 0u);
}

TEST_F(CommandLine, SeriesGoesToStandardOutputAlone) {
    const Outcome outcome = call(Small + "--time 0.02 --fps 1000 --csv -", "2>/dev/null");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.text.find("time [s],step,dt [s],kinetic_energy [J],"), 0u) << outcome.text;
    EXPECT_GE(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 4) << outcome.text;
    const std::string last =
        outcome.text.substr(outcome.text.rfind('\n', outcome.text.size() - 2) + 1);
    EXPECT_GE(std::stod(last), 0.02);
}

// Once, on standard error, also when a run is quiet.
TEST_F(CommandLine, ProbesInsideASolidAreNamed) {
    const auto said = [&](const char* x) {
        return call(fmt::format("test/solids_small --headless --quiet --steps 40 --set "
                                "'output.probes=[{{\"name\":\"p\",\"position\":[{},0.15,0.4]}}]'",
                                x),
                    "2>&1 >/dev/null")
            .text;
    };
    const std::string inside =
        "spindrift: output.probes[0] (p) is inside solids[2]: no fluid can be "
        "read there; move one of the two\n";
    const std::string text = said("0.75");
    EXPECT_EQ(text.find(inside), text.rfind(inside)) << text;
    EXPECT_NE(text.find(inside), std::string::npos) << text;
    EXPECT_EQ(said("0.5").find("output.probes"), std::string::npos);
}

TEST_F(CommandLine, ProbesAreColumnsInEveryFormat) {
    const std::string probes =
        R"( --set 'output.probes=[{"name":"wall","position":[0,0.1,0.3]},{"kind":"height",)"
        R"("name":"gauge","position":[0.1,0,0.3]}]')";
    const Outcome outcome = call(
        "dam_break --headless --backend cpu --quiet --set simulation.spacing=0.04 "
        "--set simulation.formulation=wcsph --steps 30 --csv run.csv --json run.json --hdf5 run.h5 "
        "--set output.sample_every=0.001 --frames "
        "frames --size 64x48" +
        probes);
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const std::string csv = slurp(folder_ / "run.csv");
    const std::string header = csv.substr(0, csv.find('\n'));
    EXPECT_NE(header.find("max_speed [m/s],evaluations,wall.pressure [Pa],wall.density "
                          "[kg/m³],wall.velocity_x [m/s],"),
              std::string::npos)
        << header;
    EXPECT_NE(header.find("gauge.height [m],sort [ms]"), std::string::npos) << header;
    const Json series = parseJson(slurp(folder_ / "run.json"), "series");
    const hdf5::Handle file = hdf5::openFile((folder_ / "run.h5").string());
    const std::vector<double> height = hdf5::readNumbers(file, "gauge.height"),
                              time = hdf5::readNumbers(file, "time");
    ASSERT_EQ(height.size(), series["rows"].size());
    EXPECT_NEAR(height[0], 0.48, 0.002);
    EXPECT_GT(hdf5::readNumbers(file, "wall.pressure").back(), 100);
    for (size_t k = 1; k + 1 < time.size(); ++k)
        EXPECT_GE(std::floor(time[k] / 0.001 + 1e-6), double(k)) << "a row at each millisecond";
    EXPECT_GT(time.size(), 10u);
    size_t frames = 0;
    for (const std::string& name : files()) frames += name.ends_with(".png");
    EXPECT_LT(frames, time.size() / 2) << "frames keep their own rate";
}

TEST_F(CommandLine, WritesWhatWasAskedFor) {
    const Outcome outcome =
        call(Small +
             "--steps 20 --fps 1000 --size 160x120 --json run.json --csv run.csv "
             "--frames frames --screenshot last.png");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("particles      "), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find((folder_ / "last.png").string()), std::string::npos)
        << outcome.text;
    const Json series = parseJson(slurp(folder_ / "run.json"), "series");
    EXPECT_EQ(series["columns"][0]["unit"], "s");
    EXPECT_EQ(series["rows"].back()[1], 20);
    EXPECT_EQ(series["rows"].back().size(), series["columns"].size());
    EXPECT_EQ(readPng((folder_ / "last.png").string()).width, 160);
    EXPECT_EQ(readPng((folder_ / "frames/frame_00000.png").string()).height, 120);
    EXPECT_TRUE(fs::exists(folder_ / "frames/frame_00001.png"));
    for (const std::string& name : files())
        EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST_F(CommandLine, ADivergedRunSaysSoAndKeepsItsData) {
    const Outcome outcome = call(
        Small + "--steps 1000000 --set time.mode=fixed --set time.step=0.1 --csv run.csv --quiet");
    EXPECT_EQ(outcome.code, int(Exit::Diverged)) << outcome.text;
    EXPECT_NE(outcome.text.find("diverged at step "), std::string::npos) << outcome.text;
    EXPECT_NE(slurp(folder_ / "run.csv").find("time [s]"), std::string::npos);
}

TEST_F(CommandLine, ARunInTroubleGoesOnWithShorterSteps) {
    const Outcome outcome = call(Small +
                                 "--steps 1500 --set time.mode=fixed --set time.step=0.02 --csv "
                                 "run.csv --set output.fps=1000 --quiet");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("back to step 0 (0 s), on with 0.5 of the time step, try 1 of 3"),
              std::string::npos)
        << outcome.text;
    // Time runs forward in what was written.
    std::ifstream csv(folder_ / "run.csv");
    std::string line;
    double last = -1;
    int rows = 0;
    for (std::getline(csv, line); std::getline(csv, line); ++rows) {
        if (line.starts_with('#')) continue;  // a remark
        EXPECT_GT(std::stod(line), last);
        last = std::stod(line);
    }
    EXPECT_GT(rows, 100);
}

TEST_F(CommandLine, AGivenUpRunLeavesItsLastGoodState) {
    const Outcome outcome = call(Small +
                                 "--steps 1000000 --set time.mode=fixed --set time.step=0.5 "
                                 "--checkpoint last.h5 --quiet --set time.retries=1");
    EXPECT_EQ(outcome.code, int(Exit::Diverged)) << outcome.text;
    EXPECT_NE(outcome.text.find("; particle "), std::string::npos) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 3)
        << "one line a try, one for the compression, one for the end: " << outcome.text;
    EXPECT_EQ(call("last.h5 --headless --quiet --set time.mode=cfl --steps 50").code, 0);
}

TEST_F(CommandLine, AGpuThatIsMissingIsAnError) {
    const Outcome outcome = call(Small + "--steps 1 --backend cuda");
    if (outcome.code == 0) GTEST_SKIP() << "this machine has one";
    EXPECT_EQ(outcome.code, int(Exit::NoDevice)) << outcome.text;
    EXPECT_NE(outcome.text.find("cuda"), std::string::npos) << outcome.text;
}

TEST_F(CommandLine, ComparesPictures) {
    Image image{32, 32, std::vector<uint8_t>(32 * 32 * 3)};
    for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = uint8_t(i * 37 % 251);
    writePng((folder_ / "a.png").string(), image);
    image.rgb[500] = uint8_t(image.rgb[500] ^ 8);
    writePng((folder_ / "b.png").string(), image);
    writePng((folder_ / "c.png").string(), Image{2, 2, std::vector<uint8_t>(12)});

    EXPECT_EQ(call("compare a.png a.png").text,
              "SSIM 1.000000, largest difference 0 of 255, 0 of 1024 pixels differ\n");
    EXPECT_EQ(call("compare a.png a.png").code, 0);
    const Outcome differing = call("compare a.png b.png --diff d.png");
    EXPECT_EQ(differing.code, 1);
    EXPECT_NE(differing.text.find("largest difference 8 of 255, 1 of 1024"), std::string::npos)
        << differing.text;
    EXPECT_EQ(readPng((folder_ / "d.png").string()).rgb[500], 255);
    EXPECT_EQ(call("compare a.png b.png --max-difference 8").code, 0);
    EXPECT_EQ(call("compare a.png b.png --max-difference 7").code, 1);
    EXPECT_EQ(call("compare a.png b.png --min-ssim 0.9").code, 0);
    EXPECT_EQ(call("compare a.png b.png --min-ssim 1").code, 1);
    EXPECT_EQ(call("compare a.png c.png").code, 1);
    expectMistake("compare a.png missing.png", Exit::Scene, "missing.png");
    expectMistake("compare a.png " + write("no.png", "text"), Exit::Scene, "no.png");
    expectMistake("compare a.png b.png --diff missing/d.png", Exit::Output,
                  "missing/d.png: can't be written");
}

}  // namespace
}  // namespace spindrift
