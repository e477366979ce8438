#include "app/exit_code.h"
#include "app/command_line.h"

#include "app/bench.h"
#include "app/ceilings_bench.h"
#include "app/compare.h"
#include "app/error_bench.h"
#include "app/frame_bench.h"
#include "app/local_bench.h"
#include "app/real_time_bench.h"
#include "app/explain.h"
#include "app/fluid_mesh.h"
#include "app/headless.h"
#include "app/scene_choice.h"
#include "app/stress.h"
#include "app/surface.h"
#include "app/validate.h"
#include "core/error.h"
#include "core/output_file.h"
#include "core/system.h"
#include "scene/json.h"
#ifdef SPINDRIFT_WINDOW
#include "app/window/window.h"
#endif

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace spindrift {
namespace {

// Options that are short for one knob; ranges and names are the schema's.
struct Shortcut {
    const char *option, *path, *placeholder, *help;
};
constexpr Shortcut Shortcuts[] = {
    {"--steps", "compute.steps", "N", "time steps to run, from the beginning of the run on"},
    {"--time", "output.time", "SECONDS", "simulated time to run, from the beginning of the run on"},
    {"--screenshot", "output.screenshot", "FILE", "saves the last state as PNG"},
    {"--color", "view.color_by", "QUANTITY", "what colours the particles"},
    {"--frames", "output.frames", "FOLDER", "saves a PNG for each frame"},
    {"--video", "output.video", "FILE", "a film of the run: mp4, mkv, webm (needs ffmpeg)"},
    {"--series", "output.series", "FILE",
     "particles at every frame, for ParaView and others: pvd, xdmf, ply, csv"},
    {"--surface", "output.surface", "FILE", "the fluid's surface at every frame: ply, obj, vdb"},
    {"--fps", "output.fps", "RATE", "frames and rows a second of simulated time"},
    {"--csv", "output.csv", "FILE", "time series as CSV, - = standard output"},
    {"--json", "output.json", "FILE", "time series as JSON, - = standard output"},
    {"--hdf5", "output.hdf5", "FILE", "time series as HDF5"},
    {"--checkpoint", "output.checkpoint", "FILE", "writes a file from which the run can go on"},
    {"--backend", "compute.backend", "NAME", "auto, cpu or cuda"},
    {"--threads", "compute.threads", "N",
     "CPU threads; without it all cores, or fewer while others use them"},
    {"--device", "compute.device", "N", "number of the GPU; the one that draws without it"},
};

struct RunOptions {
    std::string scene;
    std::vector<KnobChoice> choices;
    bool quiet = false, printConfig = false;
};

[[noreturn]] void misuse(const std::string& message) { throw Error(Failure::Usage, message); }

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

// "--size 800x600" and "--camera 30,20,2" set several knobs at once; the first `least` of them are
// required.
std::vector<KnobChoice> splitChoices(const std::string& option, const std::string& text,
                                     char separator, size_t least,
                                     const std::vector<std::string>& paths, const char* form) {
    const std::vector<std::string> parts = split(text, separator);
    if (parts.size() < least || parts.size() > paths.size())
        misuse(fmt::format("{}: expected {}, found \"{}\"", option, form, text));
    std::vector<KnobChoice> choices;
    for (size_t i = 0; i < parts.size(); ++i) choices.push_back({option, paths[i], parts[i]});
    return choices;
}

KnobChoice setChoice(const std::string& text) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        misuse(fmt::format("--set: expected path=value, e.g. fluid.viscosity=0.1, found \"{}\"",
                           text));
    return {"--set", text.substr(0, equals), text.substr(equals + 1)};
}

[[maybe_unused]] bool given(const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value;
}

// Why no window can be shown; "" when one can be tried.
std::string whyNoWindow() {
#ifdef SPINDRIFT_WINDOW
    // Some drivers of SDL need neither; naming one is a wish to be followed.
    if (given("DISPLAY") || given("WAYLAND_DISPLAY") || given("SDL_VIDEODRIVER")) return "";
    return "no display (DISPLAY and WAYLAND_DISPLAY are not set)";
#else
    return "this build has no window";
#endif
}

// Goes on as spindrift-surface, which has OpenVDB, where that lies beside this program.
void becomeMesher(const char* const* argv) {
    if (!canMeshFluid()) os::becomeNeighbour("spindrift-surface", const_cast<char**>(argv));
}

int runScene(const RunOptions& options, const char* const* argv) {
    Start start = chooseStart(options.scene, options.choices);
    Scene& scene = start.scene;
    if (options.printConfig) {
        writeText("-", writeScene(scene));
        return int(Exit::Ok);
    }
    if (const std::string why = whyNoWindow(); !scene.output.headless && !why.empty()) {
        scene.output.headless = true;
        if (scene.output.screenshot.empty()) scene.output.screenshot = "spindrift.png";
        fmt::print(stderr, "spindrift: {}: rendering off screen, to {}\n", why,
                   scene.output.screenshot);
    }
#ifdef SPINDRIFT_WINDOW
    if (!scene.output.headless) {
        const Output& output = scene.output;
        for (const std::string& wanted :
             {output.screenshot, output.frames, output.video, output.csv, output.json, output.hdf5,
              output.particles, output.series, output.surface, output.checkpoint})
            if (!wanted.empty())
                fmt::print(stderr, "spindrift: {}: not written by the window; add --headless\n",
                           wanted);
        return runWindow(std::move(start));
    }
#endif
    if (!scene.output.surface.empty()) becomeMesher(argv);
    return runHeadless(start, options.quiet);
}

void addSetOption(CLI::App& command, std::vector<KnobChoice>& choices) {
    command
        .add_option_function<std::vector<std::string>>(
            "--set",
            [&](const std::vector<std::string>& sets) {
                for (const std::string& set : sets) choices.push_back(setChoice(set));
            },
            "sets any knob; may be repeated")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false);
}

// The shortcuts, in the order in which they are applied; --set comes last, so that it overrides any
// of them.
void addKnobOptions(CLI::App& command, std::vector<KnobChoice>& choices) {
    for (const Shortcut& shortcut : Shortcuts)
        command
            .add_option_function<std::string>(
                shortcut.option,
                [&choices, shortcut](const std::string& value) {
                    // 0 stands for "all cores" in a file; who types it here means something else.
                    if (shortcut.option == std::string("--threads") && value == "0")
                        misuse(
                            "--threads: 0 threads can't compute; give 1 or more, or leave it out "
                            "for all cores");
                    choices.push_back({shortcut.option, shortcut.path, value});
                },
                shortcut.help)
            ->type_name(shortcut.placeholder)
            ->take_last();
    const auto addSplit = [&](const char* option, char separator, size_t least,
                              std::vector<std::string> paths, const char* form, const char* help) {
        command
            .add_option_function<std::string>(
                option,
                [=, &choices](const std::string& value) {
                    for (KnobChoice& c : splitChoices(option, value, separator, least, paths, form))
                        choices.push_back(c);
                },
                help)
            ->type_name(form)
            ->take_last();
    };
    addSplit("--size", 'x', 2, {"window.width", "window.height"}, "WIDTHxHEIGHT",
             "size of the picture, px");
    addSplit("--camera", ',', 2, {"view.camera.yaw", "view.camera.pitch", "view.camera.distance"},
             "YAW,PITCH[,DISTANCE]", "camera about the centre, degrees and m");
    command.add_flag_callback(
        "--headless",
        [&] {
            choices.push_back({"--headless", "output.headless", "true"});
        },
        "runs without a window");
    command.add_flag_callback(
        "--strict",
        [&] {
            choices.push_back({"--strict", "output.strict", "true"});
        },
        "results outside the validity of the method end a run without a window, exit code 10");
    addSetOption(command, choices);
}

CLI::App* addRun(CLI::App& app, RunOptions& options) {
    CLI::App* command =
        app.add_subcommand("run", "runs a scene, in a window or without one; the default");
    command->add_option(
        "scene", options.scene,
        "scene file, the name of a shipped scene, or a checkpoint; a dam break without it");
    addKnobOptions(*command, options.choices);
    command->add_flag("--print-config", options.printConfig,
                      "writes the full effective scene and ends");
    command->add_flag("--quiet", options.quiet, "no progress, no summary");
    return command;
}

CLI::App* addExplain(CLI::App& app, RunOptions& options) {
    CLI::App* command = app.add_subcommand(
        "explain",
        "what a step of a scene does, skips and costs; with --steps also the time of each pass");
    command->add_option("scene", options.scene, "scene file, or the name of a shipped scene");
    addKnobOptions(*command, options.choices);
    return command;
}

CLI::App* addCompare(CLI::App& app, CompareOptions& options) {
    CLI::App* command =
        app.add_subcommand("compare", "compares two PNG pictures: SSIM and largest difference");
    command->add_option("a", options.a, "PNG file")->required();
    command->add_option("b", options.b, "PNG file")->required();
    command->add_option("--diff", options.diff, "writes the differences as PNG")->type_name("FILE");
    command
        ->add_option("--min-ssim", options.minSsim, "different below this similarity; 1 = the same")
        ->check(CLI::Range(-1.0, 1.0));
    command
        ->add_option("--max-difference", options.maxDifference,
                     "different above this; 0 to 255; 0 without thresholds")
        ->check(CLI::Range(0, 255));
    return command;
}

struct BenchChoice {
    BenchOptions steps;
    ErrorBenchOptions error;
    bool byError = false, byLocalSteps = false, byFrames = false, byCeilings = false,
         byRealTime = false;
};

int runBench(const BenchChoice& choice) {
    if (choice.byFrames) return benchFrames();
    if (choice.byCeilings) return benchCeilings();
    if (choice.byRealTime) return benchRealTime(choice.steps.only);
    if (choice.byLocalSteps) return benchLocalSteps({choice.steps.only, choice.error.out});
    return choice.byError ? benchError(choice.error) : bench(choice.steps);
}

CLI::App* addBench(CLI::App& app, BenchChoice& choice) {
    BenchOptions& options = choice.steps;
    CLI::App* command = app.add_subcommand("bench", "times whole steps and their passes");
    command->add_option("--only", options.only, "cases whose name contains this")
        ->type_name("TEXT");
    command->add_option("--json", options.json, "writes the figures as JSON")->type_name("FILE");
    command
        ->add_option("--baseline", options.baseline,
                     "says what is slower than in this file of an earlier run, and notes cases "
                     "that it has not")
        ->type_name("FILE");
    command->add_option("--threads", options.threads, "CPU threads; all cores without it")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command->add_option("--simd", options.simd, "avx512, avx2 or sse; the best without it")
        ->type_name("NAME");
    command->add_flag("--gpu", options.gpu,
                      "the GPU's cases instead: up to 100 million particles, frames, switching");
    command->add_option("--most", options.most, "leaves out the GPU's cases with more particles")
        ->type_name("N")
        ->check(CLI::PositiveNumber);
    command->add_flag("--error", choice.byError,
                      "run time against error instead, of flows with known answers; half an hour");
    command->add_flag("--local", choice.byLocalSteps,
                      "local steps against the step of all instead; an hour");
    command->add_flag("--frames", choice.byFrames,
                      "pictures of up to 200 thousand particles instead, drawn off screen");
    command->add_flag("--real-time", choice.byRealTime,
                      "simulated time per time of the shipped scenes instead, incompressible "
                      "and not; six minutes");
    command->add_flag(
        "--ceilings", choice.byCeilings,
        "what the passes make of the machine's arithmetic and memory instead; a minute");
    command
        ->add_option("--case", choice.error.cases, "with --error: only this flow; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    command->add_flag("--coarsest", choice.error.coarsest,
                      "with --error: only the coarsest resolution, minutes");
    command
        ->add_option("--out", choice.error.out,
                     "with --error and --local: folder for tables and charts")
        ->type_name("FOLDER");
    return command;
}

CLI::App* addStress(CLI::App& app, StressOptions& options) {
    CLI::App* command =
        app.add_subcommand("stress", "runs that are meant to break the physics; half a minute");
    command
        ->add_option("--only", options.only,
                     "tortures whose name contains this, or random, or maps")
        ->type_name("TEXT");
    command->add_option("--random", options.random, "number of random scenes")
        ->type_name("N")
        ->check(CLI::Range(0, 1000000));
    command->add_option("--seed", options.seed, "of the first random scene")->type_name("N");
    command->add_flag("--full", options.full,
                      "also what takes many minutes, and maps of what is stable");
    command->add_option("--out", options.out, "folder for stability.json and stability.md")
        ->type_name("FOLDER");
    command
        ->add_option("--handled", options.handled,
                     "instead: a hand drags and stirs this scene at random, as the mouse would; "
                     "may be repeated, and --seed says how")
        ->type_name("SCENE")
        ->allow_extra_args(false);
    command->add_option("--seconds", options.seconds, "how long the hand does")
        ->type_name("S")
        ->check(CLI::Range(0.1, 1e6));
    addSetOption(*command, options.choices);
    return command;
}

CLI::App* addValidate(CLI::App& app, ValidateOptions& options) {
    CLI::App* command = app.add_subcommand(
        "validate",
        "runs flows with known answers and says how wrong they are, and what that cost");
    command->add_option("cases", options.cases, "names of cases; all without them");
    command->add_flag("--list", options.list, "names the cases and ends");
    command->add_flag("--quick", options.quick, "coarse runs of some cases, half a minute");
    command
        ->add_option("--resolution", options.resolutions,
                     "instead of the case's own; may be repeated")
        ->type_name("N")
        ->check(CLI::Range(4, 100000))
        ->allow_extra_args(false);
    command->add_option("--out", options.out, "folder for validation.json and a chart of each run")
        ->type_name("FOLDER");
    addSetOption(*command, options.choices);
    return command;
}

CLI::App* addSurface(CLI::App& app, SurfaceOptions& options) {
    CLI::App* command = app.add_subcommand(
        "surface", "the surface around the particles of files, of any program, as triangles");
    command->add_option("files", options.files, "CSV or HDF5 tables with x, y and z in m")
        ->required();
    command
        ->add_option("--out", options.out,
                     "the surface's file, or a folder; beside the table without it")
        ->type_name("PATH");
    command->add_option("--format", options.format, "ply, obj or vdb; ply without it")
        ->type_name("NAME");
    command->add_option("--spacing", options.spacing, "of the particles, m; found without it")
        ->check(CLI::PositiveNumber);
    command->add_option("--cell", options.method.cell, "of the grid, in spacings; 0.5 without it")
        ->check(CLI::Range(0.1, 2.0));
    command
        ->add_option("--smooth", options.method.smoothings,
                     "how often it is smoothed; 3 without it, 1 with --anisotropic")
        ->check(CLI::Range(0, 100));
    command->add_flag("--anisotropic", options.method.anisotropic,
                      "of kernels that are flat along the surface: smoother, and slower");
    return command;
}

// Everything that isn't the name of a command or a general option belongs to `run`.
std::vector<std::string> withCommand(int argc, const char* const* argv, const CLI::App& app) {
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    const std::string first = arguments.empty() ? "" : arguments[0];
    const auto commands = app.get_subcommands(nullptr);
    const bool named = std::any_of(commands.begin(), commands.end(),
                                   [&](auto* c) { return c->check_name(first); });
    const bool general = first == "--help" || first == "-h" || first == "--version";
    if (!named && !general) arguments.insert(arguments.begin(), "run");
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    return arguments;
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
    CLI::App app{"Spindrift, a laboratory for particle fluids", "spindrift"};
    app.set_version_flag("--version", "spindrift " SPINDRIFT_VERSION);
    app.require_subcommand(1);
    RunOptions run;
    CompareOptions comparison;
    const CLI::App* runCommand = addRun(app, run);
    RunOptions explained;
    const CLI::App* explainCommand = addExplain(app, explained);
    const CLI::App* compareCommand = addCompare(app, comparison);
    BenchChoice benchmark;
    const CLI::App* benchCommand = addBench(app, benchmark);
    ValidateOptions validation;
    const CLI::App* validateCommand = addValidate(app, validation);
    SurfaceOptions surfaces;
    const CLI::App* surfaceCommand = addSurface(app, surfaces);
    StressOptions stressOptions;
    const CLI::App* stressCommand = addStress(app, stressOptions);
    CLI::App* schemaCommand = app.add_subcommand("schema", "writes the JSON Schema of scene files");
    bool asMarkdown = false;
    schemaCommand->add_flag("--markdown", asMarkdown,
                            "writes all knobs as Markdown tables instead");
    app.set_help_flag();
    app.set_help_all_flag("-h,--help", "this text");
    app.footer("\n" + knobTable());
    try {
        app.parse(withCommand(argc, argv, app));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // help, version
        misuse(fmt::format("{}; `spindrift --help` lists all options", error.what()));
    }
    if (*runCommand) return runScene(run, argv);
    if (*explainCommand) return explain(chooseScene(explained.scene, explained.choices));
    if (*compareCommand) return compare(comparison);
    if (*benchCommand) return runBench(benchmark);
    if (*stressCommand) return stress(stressOptions);
    if (*validateCommand) return validate(validation);
    if (*surfaceCommand) {
        becomeMesher(argv);
        return makeSurfaces(surfaces);
    }
    if (*schemaCommand) writeText("-", asMarkdown ? knobReference() : jsonSchema());
    return int(Exit::Ok);
}

}  // namespace spindrift
