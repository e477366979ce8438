#include "render/overlay.h"

#include "render/font.h"
#include "render/shader.h"

#include <cmath>
#include <cstddef>

namespace spindrift {

namespace {
// The middle of the disc is solid: plain rectangles take their texture there.
constexpr std::array<float, 4> solid{Font::disc / 2, Font::disc / 2, 0, 0};
}  // namespace

Overlay::Overlay()
    : program_(loadProgram("overlay")), array_(makeVertexArray()), buffer_(makeBuffer()) {
    const auto attribute = [&](GLuint location, GLint size, size_t offset) {
        glEnableVertexArrayAttrib(array_, location);
        glVertexArrayAttribFormat(array_, location, size, GL_FLOAT, GL_FALSE, GLuint(offset));
        glVertexArrayAttribBinding(array_, location, 0);
    };
    glVertexArrayVertexBuffer(array_, 0, buffer_, 0, sizeof(Corner));
    attribute(0, 2, offsetof(Corner, x));
    attribute(1, 2, offsetof(Corner, u));
    attribute(2, 4, offsetof(Corner, color));
    textSize(14);
}

Overlay::~Overlay() = default;

void Overlay::textSize(float pixels) {
    pixels = std::round(pixels);
    if (font_ && font_->pixels() == pixels) return;
    font_ = std::make_unique<Font>(pixels);
    atlas_ = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(atlas_, 1, GL_R8, Font::side, Font::side);
    glTextureParameteri(atlas_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(atlas_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureSubImage2D(atlas_, 0, 0, 0, Font::side, Font::side, GL_RED, GL_UNSIGNED_BYTE,
                        font_->atlas().data());
}

void Overlay::quad(const std::array<float, 4>& place, const std::array<float, 4>& texture,
                   Rgba color) {
    const auto corner = [&](float right, float down) {
        return Corner{place[0] + right * place[2], place[1] + down * place[3],
                      (texture[0] + right * texture[2]) / Font::side,
                      (texture[1] + down * texture[3]) / Font::side, color};
    };
    corners_.insert(corners_.end(), {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0),
                                     corner(1, 1), corner(0, 1)});
}

void Overlay::rectangle(float x, float y, float width, float height, Rgba color) {
    quad({x, y, width, height}, solid, color);
}

void Overlay::panel(float x, float y, float width, float height, float radius, Rgba color) {
    // Nine pieces: the disc's quarters in the corners, solid between them.
    constexpr float half = Font::disc / 2;
    const float xs[] = {x, x + radius, x + width - radius, x + width};
    const float ys[] = {y, y + radius, y + height - radius, y + height};
    const float us[] = {0, half, half, 2 * half};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            quad({xs[column], ys[row], xs[column + 1] - xs[column], ys[row + 1] - ys[row]},
                 {us[column], us[row], us[column + 1] - us[column], us[row + 1] - us[row]}, color);
}

void Overlay::text(float x, float y, std::string_view text, Rgba color) {
    // Characters are drawn at whole pixels, where their pictures were made.
    while (!text.empty()) {
        const Glyph& g = font_->glyph(takeCharacter(text));
        quad({std::round(x) + g.left, std::round(y) + g.top, float(g.width), float(g.height)},
             {float(g.x), float(g.y), float(g.width), float(g.height)}, color);
        x += g.advance;
    }
}

float Overlay::textWidth(std::string_view text) const {
    float width = 0;
    while (!text.empty()) width += font_->glyph(takeCharacter(text)).advance;
    return width;
}

void Overlay::flush(int width, int height) {
    if (corners_.empty()) return;
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glNamedBufferData(buffer_, GLsizeiptr(corners_.size() * sizeof(Corner)), corners_.data(),
                      GL_STREAM_DRAW);
    glUseProgram(program_);
    glBindTextureUnit(0, atlas_);
    glBindVertexArray(array_);
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(corners_.size()));
    glDisable(GL_BLEND);
    corners_.clear();
}

}  // namespace spindrift
