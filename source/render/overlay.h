#pragma once
// Flat shapes and text over the picture, in pixels from the upper left corner.
#include "render/gl.h"

#include <array>
#include <memory>
#include <string_view>
#include <vector>

namespace spindrift {

struct Rgba {
    float r, g, b, a = 1;
};

class Font;

class Overlay {
public:
    Overlay();
    ~Overlay();

    // Text is drawn `pixels` tall from now on.
    void textSize(float pixels);
    void rectangle(float x, float y, float width, float height, Rgba color);
    // A rectangle with rounded corners.
    void panel(float x, float y, float width, float height, float radius, Rgba color);
    // UTF-8 within Latin-1; y is the base line.
    void text(float x, float y, std::string_view, Rgba color);
    float textWidth(std::string_view) const;

    // Draws and forgets all shapes; blends over the bound framebuffer.
    void flush(int width, int height);

private:
    struct Corner {
        float x, y, u, v;
        Rgba color;
    };
    void quad(const std::array<float, 4>& place, const std::array<float, 4>& texture, Rgba color);

    GlProgram program_;
    GlVertexArray array_;
    GlBuffer buffer_;
    GlTexture atlas_;
    std::unique_ptr<Font> font_;
    std::vector<Corner> corners_;
};

}  // namespace spindrift
