#include "measure/moment_folder.h"

#include "core/error.h"
#include "core/output_file.h"

#include <fmt/format.h>

#include <filesystem>

namespace spindrift {

namespace fs = std::filesystem;

namespace {

// What the scene begins with must not be written over.
void requireOwn(const std::string& folder, const std::string& path, const Scene& scene) {
    std::vector<std::string> inputs;
    for (const Body& body : scene.fluid.bodies) inputs.push_back(body.path);
    for (const Solid& solid : scene.solids) inputs.push_back(solid.path);
    for (const Object& object : scene.objects) inputs.push_back(object.path);
    std::error_code none;
    const fs::path own = fs::weakly_canonical(folder, none);
    for (const std::string& input : inputs)
        if (!input.empty() && fs::weakly_canonical(input, none).parent_path() == own)
            throw Error(Failure::Output,
                        fmt::format("{}: its folder {} holds {}, which the scene begins with; give "
                                    "the series another name",
                                    path, folder, input));
}

}  // namespace

MomentFolder::MomentFolder(const std::string& path, const std::string& extension,
                           const Scene& scene)
    : folder_(fs::path(path).replace_extension("").string()), extension_(extension) {
    requireOwn(folder_, path, scene);
    requireFolder(folder_);
}

std::string MomentFolder::file(const std::string& piece, size_t number) const {
    return (fs::path(folder_) / fmt::format("{}_{:05}{}", piece, number, extension_)).string();
}

bool MomentFolder::has(const std::string& piece, size_t number) const {
    return fs::exists(file(piece, number));
}

void MomentFolder::remove(const std::vector<std::string>& pieces) const {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_, none)) {
        const std::string name = entry.path().filename().string();
        for (const std::string& piece : pieces)
            if (name.starts_with(piece + "_") && name.ends_with(extension_))
                fs::remove(entry.path(), none);
    }
}

}  // namespace spindrift
