#pragma once
// The folder of a series: run for a path run.pvd, and in it fluid_00000.vtp, fluid_00001.vtp, ...
#include "scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spindrift {

class MomentFolder {
public:
    // Of files with this extension, ".vtp". Makes it; throws Error (Output) where that can't be, or
    // what the scene begins with lies there.
    MomentFolder(const std::string& path, const std::string& extension, const Scene&);
    const std::string& path() const { return folder_; }
    // Of a piece of a moment: "fluid".
    std::string file(const std::string& piece, size_t number) const;
    bool has(const std::string& piece, size_t number) const;
    // Those of an older run.
    void remove(const std::vector<std::string>& pieces) const;

private:
    std::string folder_, extension_;
};

}  // namespace spindrift
