#pragma once
// From what the user typed to a scene: which file, and which knobs over it.
#include "measure/checkpoint.h"
#include "scene/scene.h"
#include "sim/simulation.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

// Names of the scenes in configs/, as findScene takes them.
std::vector<std::string> shippedScenes();
// What lists call a scene: its name, with a capital. Those of the original program have numbers for
// names.
std::string titleOf(const Scene&);
// The same of the scene in a file; "" when it can't be read.
std::string titleOfFile(const std::string& file);
// The folder that the shipped scenes are in.
std::string configsFolder();

// The path of a scene file: `name` itself, or the shipped scene of that name ("pool_drop",
// "test/ball_drop_small"). Throws Error(Failure::Scene) naming the nearest shipped scene.
std::string findScene(const std::string& name);

// A knob that the command line sets: the option it came by, its path and value.
struct KnobChoice {
    std::string option, path, value;
};

// What a run starts from: a scene, and the state of a checkpoint's run.
struct Start {
    Scene scene;
    std::optional<RunState> state;
    std::string file = {};  // that both were read from
    View view = {};  // the scene's own looks, without the choices, which are for one run only:
                     // those of its checkpoints
    Window window = {};
    std::vector<CurvePoint> before = {};  // what curves show of the run until then
    std::string said = {};  // of a run that goes on: one line about what it does and doesn't
};
// Sets the knobs, in order. Throws Error (Usage).
void applyChoices(Scene&, const std::vector<KnobChoice>&);

// The simulation of a scene, from its beginning or from a state.
std::unique_ptr<Simulation> startSimulation(const Scene&, const std::optional<RunState>&);

// As chooseScene; `name` may also be a checkpoint (go_on.h).
Start chooseStart(const std::string& name, const std::vector<KnobChoice>&);

// The scene of `name` ("" = the dam break) with the choices applied in their order, checked
// as a whole. Throws Error: Usage for a choice's mistake, else what loadScene and checkScene throw.
Scene chooseScene(const std::string& name, const std::vector<KnobChoice>&);

}  // namespace spindrift
