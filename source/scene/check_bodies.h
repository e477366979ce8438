#pragma once
// What checkScene asks of solids and elastic objects. Messages begin with the knob's path;
// checkScene puts the file before it.
#include "core/error.h"
#include "scene/scene.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace spindrift {

// Throws Error (Scene).
[[noreturn]] inline void refuse(const std::string& path, const std::string& message) {
    throw Error(Failure::Scene, fmt::format("{}: {}", path, message));
}

// Names of probes and solids begin the names of columns.
template <class Member>
void requireColumnName(const std::vector<Member>& list, size_t index, const std::string& path) {
    const std::string &name = list[index].name, at = fmt::format("{}[{}].name", path, index);
    constexpr const char* Letters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (name.empty() || name.find_first_not_of(Letters) != std::string::npos)
        refuse(at, fmt::format("\"{}\" can't begin a column's name; use letters, digits, _ and -",
                               name));
    for (size_t other = 0; other < index; ++other)
        if (list[other].name == name)
            refuse(at, fmt::format("\"{}\" is the name of {}[{}] too; give each its own", name,
                                   path, other));
}

// Whether its file is there, a closed surface, and no larger than so many domains.
void checkMesh(const Scene&, const Form&, double mostDomains, const std::string& path);
// A mesh lies elsewhere: says where, and the offset that brings it into the domain.
[[noreturn]] void refuseMeshPlace(const Scene&, const Form&, const std::string& path);
// The same of all solids', and that collisions can work with them: before anything else looks at
// them.
void checkMeshes(const Scene&);
void checkSolids(const Scene&);
// Objects, what holds them, and what cuts them.
void checkObjects(const Scene&);

}  // namespace spindrift
