#pragma once
// The closed shells of a surface, from triangles in any order that are wound either way.
#include "core/vec.h"

#include <array>
#include <string>
#include <vector>

namespace spindrift {

struct ShellNet {
    std::vector<Vec3d> vertices;
    std::vector<std::array<int, 3>> triangles;  // corners, against the clock seen from outside
    std::vector<int> shells;                    // which one each triangle is of
    int shellCount = 0;
    double precision = 0;  // what is smaller is nothing
};

// roundOff: how wrong coordinates may be. Corners that are nearly at one place become one, as do
// triangles with the same corners; walls between solids vanish. What encloses nothing goes. Throws
// Error (Scene), one line that begins with `name`, where an edge has no second triangle, or nothing
// is left.
ShellNet findShells(const std::string& name, std::vector<Vec3d> vertices,
                    std::vector<std::array<int, 3>> triangles, double roundOff);

}  // namespace spindrift
