#pragma once
// Solids as shaded triangles with their edges.
#include "core/vec.h"
#include "render/gl.h"

#include <array>
#include <vector>

namespace spindrift {

// In its own axes, m from its middle.
struct SolidShape {
    struct Corner {
        Vec3 position, normal;
    };
    std::vector<Corner> corners;  // three a triangle
    std::vector<std::array<Vec3, 2>> edges;
};

// Where it is: its middle, m from the domain's lower corner, and its axes.
struct ShapePose {
    Vec3 middle, axis[3];
    Vec3 at(Vec3 own) const { return middle + own.x * axis[0] + own.y * axis[1] + own.z * axis[2]; }
};

// The triangles of some solids, in GL's memory.
class SolidTriangles {
public:
    SolidTriangles();
    void upload(std::vector<SolidShape>);
    // One pose for each; into the bound framebuffer, with its depths.
    void draw(const std::vector<ShapePose>&) const;
    const std::vector<SolidShape>& shapes() const { return shapes_; }

private:
    GlProgram program_;
    GlVertexArray array_;
    GlBuffer corners_;
    std::vector<SolidShape> shapes_;
};

}  // namespace spindrift
