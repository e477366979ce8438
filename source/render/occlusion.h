#pragma once
// What a picture shows in front, tile by tile: spheres all of which lie behind it need not be
// drawn. Particles are drawn in two calls: first those that the tiles of the picture before don't
// hide, then, by the tiles of what this has drawn, those of the others that were left out wrongly.
// The picture is the same as if all had been drawn.
#include "render/framebuffer.h"
#include "render/gl.h"

#include <utility>

namespace spindrift {

class Occlusion {
public:
    Occlusion();  // needs a current context
    // For pictures of this size and number of samples; what was known is forgotten when they
    // change. Throws Error when a shader is missing or broken.
    void resize(const Framebuffer&);
    // Binds the tiles for the particles' shader.
    void bind() const;
    // Reads what has been drawn into the tiles that are bound as now; the frame's values are bound.
    void look(const Framebuffer&);
    // The tiles of this picture are those of the picture before.
    void endPicture() { std::swap(now_, before_); }

private:
    static constexpr int tileSize = 8;  // px, as in shaders/frame.glsl
    struct Tiles {
        GlTexture texture;
        GlFramebuffer framebuffer;
    };
    static Tiles makeTiles(int width, int height);

    GlProgram program_;
    GlVertexArray empty_;
    Tiles now_, before_;
    int width_ = 0, height_ = 0, samples_ = 0;
};

}  // namespace spindrift
