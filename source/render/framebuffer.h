#pragma once
// Colour and depth off screen, multisampled and resolved.
#include "render/gl.h"
#include "render/image.h"

namespace spindrift {

class Framebuffer {
public:
    Framebuffer(int width, int height, int samples);
    void resize(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }  // what the driver gave, 1 = off

    GLuint drawing() const { return samples_ > 1 ? drawing_ : resolved_; }
    GLuint resolved() const { return resolved_; }
    // Of the drawing framebuffer, multisampled if it is.
    GLuint depthTexture() const { return samples_ > 1 ? drawingDepth_ : depth_; }
    // Averages the samples; afterwards resolved() holds the picture.
    void resolve() const;
    // The same, with one sample's depths: the texture of resolved().
    GLuint resolvedDepth() const;
    // Depth of a pixel counted from the upper left corner, 1 where nothing was drawn.
    float depth(int x, int y) const;

    Image image() const;
    void blit(int x, int y) const;

private:
    int width_ = 0, height_ = 0, samples_ = 1;
    GlFramebuffer drawing_, resolved_;
    GlRenderbuffer drawingColor_, color_;
    GlTexture drawingDepth_, depth_;
};

}  // namespace spindrift
