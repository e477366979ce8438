#pragma once
// Fluid as one surface, found in the picture (van der Laan 2009): how far the nearest particle is
// at each pixel, made smooth with the narrow-range filter (Truong & Yuksel 2018); how thick the
// fluid is there; then light that the surface mirrors, bends and swallows.
#include "render/framebuffer.h"
#include "render/gl.h"

namespace spindrift {

class FluidSurface {
public:
    FluidSurface();  // needs a current context
    // Over what the target shows, hidden by what is in front; the target's depths are those of the
    // surface then. `vertices`: an array whose first `count` are fluid; `tables`: colours. The
    // frame's values are bound.
    void draw(const Framebuffer& target, GLuint vertices, int count, GLuint tables);

private:
    // Distances and colours need fewer pixels than the picture has, thickness still fewer.
    static constexpr int coarser = 2, coarsest = 4;
    static constexpr int smoothings = 2;

    void resize(const Framebuffer&);
    void findDistances(GLuint vertices, int count);
    void smooth();
    void findNormals();
    void findThickness(GLuint vertices, int count);
    void compose(const Framebuffer&);

    GlProgram distance_, smooth_, normal_, thickness_, compose_;
    GlVertexArray empty_;
    int width_ = 0, height_ = 0;
    GlTexture distances_[2], depth_, normals_, thicknesses_, tints_, behind_;
    GlFramebuffer into_[2], intoNormals_, intoThickness_, intoBehind_;
};

}  // namespace spindrift
