#pragma once
// From what the user typed to a scene: which file, and which knobs over it.
#include "scene/scene.h"

#include <string>
#include <vector>

namespace spindrift {

// Names of the scenes in configs/, as findScene takes them.
std::vector<std::string> shippedScenes();

// The path of a scene file: `name` itself, or the shipped scene of that name ("pool_drop",
// "test/ball_drop_small"). Throws Error(Exit::Scene) naming the nearest shipped scene.
std::string findScene(const std::string& name);

// A knob that the command line sets: the option it came by, its path and value.
struct KnobChoice {
    std::string option, path, value;
};

// The scene of `name` ("" = the built-in default) with the choices applied in their order, checked
// as a whole. Throws Error: Usage for a choice's mistake, else what loadScene and checkScene throw.
Scene chooseScene(const std::string& name, const std::vector<KnobChoice>&);

}  // namespace spindrift
