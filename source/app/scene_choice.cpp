#include "app/scene_choice.h"

#include "app/go_on.h"
#include "core/error.h"
#include "measure/checkpoint.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cctype>
#include <filesystem>
#include <utility>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

// $SPINDRIFT_CONFIGS, or the folder known when the program was built.
fs::path configs() {
    const char* folder = std::getenv("SPINDRIFT_CONFIGS");
    return folder && *folder ? folder : SPINDRIFT_CONFIGS;
}

}  // namespace

std::string configsFolder() { return configs().string(); }

std::vector<std::string> shippedScenes() {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(configs(), none))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string titleOf(const Scene& scene) {
    std::string name = scene.name;
    if (name.find_first_not_of("0123456789") == std::string::npos) name = "original, file " + name;
    name[0] = char(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

std::string titleOfFile(const std::string& file) {
    try {
        return titleOf(loadScene(file));
    } catch (const Error&) { return ""; }
}

std::string findScene(const std::string& name) {
    std::error_code none;
    if (fs::exists(name, none)) return name;
    const fs::path shipped = configs() / name;
    for (const fs::path& path : {shipped, fs::path(shipped.string() + ".json")})
        if (fs::is_regular_file(path, none)) return path.string();
    const std::vector<std::string> names = shippedScenes();
    const std::string nearest = nearestName(fs::path(name).stem().string(), names);
    throw Error(Failure::Scene,
                fmt::format("{}: no such scene file; {}shipped scenes: {}", name,
                            nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest),
                            listed(names)));
}

void applyChoices(Scene& scene, const std::vector<KnobChoice>& choices) {
    for (const KnobChoice& choice : choices) {
        try {
            setKnob(scene, choice.path + "=" + choice.value, choice.option);
        } catch (const Error& error) { throw Error(Failure::Usage, error.what()); }
    }
}

namespace {

// The scene as its file says it, and that file.
std::pair<Scene, std::string> sceneOf(const std::string& name) {
    const std::string file = findScene(name.empty() ? "dam_break" : name);
    if (isCheckpoint(file))
        throw Error(Failure::Scene, file + ": is a checkpoint; here a scene is wanted");
    return {loadScene(file), file};
}

}  // namespace

Scene chooseScene(const std::string& name, const std::vector<KnobChoice>& choices) {
    auto [scene, file] = sceneOf(name);
    applyChoices(scene, choices);
    checkScene(scene, file);
    return scene;
}

std::unique_ptr<Simulation> startSimulation(const Scene& scene,
                                            const std::optional<RunState>& state) {
    return state ? makeSimulation(scene, *state) : makeSimulation(scene);
}

Start chooseStart(const std::string& name, const std::vector<KnobChoice>& choices) {
    std::error_code none;
    if (fs::is_regular_file(name, none) && isCheckpoint(name)) return goOn(name, choices);
    const auto [own, file] = sceneOf(name);
    return {chooseScene(name, choices), {}, file, own.view, own.window};
}

}  // namespace spindrift
