#pragma once
// A plane through the fluid, with what a quantity is there.
#include "core/vec.h"
#include "render/gl.h"

#include <array>
#include <vector>

namespace spindrift {

// Values at the middles of cells of a rectangle, row by row along `across`.
struct SliceField {
    Vec3 corner, across, along;  // m, relative to the domain's lower corner; its sides
    int columns = 0, rows = 0;
    // The value, and how much of what is around is fluid, 0 to 1: it is shown from half on.
    std::vector<std::array<float, 2>> points;
};

class SlicePlane {
public:
    SlicePlane();  // needs a current context
    // Into the bound framebuffer, with its depths; `tables`: colours; `contourStep`: between lines
    // of one value, as the scale of colours has it, 0 = none. The frame's values are bound.
    void draw(const SliceField&, GLuint tables, float contourStep, bool smooth);

private:
    void upload(const SliceField&);

    GlProgram program_;
    GlVertexArray empty_;
    GlTexture field_;
    int columns_ = 0, rows_ = 0;
};

}  // namespace spindrift
