#include "render/occlusion.h"

#include "render/shader.h"

#include <string>

namespace spindrift {

Occlusion::Occlusion() : empty_(makeVertexArray()) {}

Occlusion::Tiles Occlusion::makeTiles(int width, int height) {
    Tiles tiles{makeTexture(GL_TEXTURE_2D), makeFramebuffer()};
    glTextureStorage2D(tiles.texture, 1, GL_R32F, width, height);
    glTextureParameteri(tiles.texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(tiles.texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const float farthest = 1;
    glClearTexImage(tiles.texture, 0, GL_RED, GL_FLOAT, &farthest);
    glNamedFramebufferTexture(tiles.framebuffer, GL_COLOR_ATTACHMENT0, tiles.texture, 0);
    return tiles;
}

void Occlusion::resize(const Framebuffer& target) {
    const int width = (target.width() + tileSize - 1) / tileSize,
              height = (target.height() + tileSize - 1) / tileSize, samples = target.samples();
    if (width == width_ && height == height_ && samples == samples_) return;
    if (samples != samples_)
        program_ = loadFilter("tiles", "#define SAMPLES " + std::to_string(samples) + "\n");
    width_ = width, height_ = height, samples_ = samples;
    now_ = makeTiles(width, height);
    before_ = makeTiles(width, height);
}

void Occlusion::bind() const {
    glBindTextureUnit(1, before_.texture);
    glBindTextureUnit(2, now_.texture);
}

void Occlusion::look(const Framebuffer& target) {
    glBindFramebuffer(GL_FRAMEBUFFER, now_.framebuffer);
    glViewport(0, 0, width_, height_);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(program_);
    glBindTextureUnit(0, target.depthTexture());
    glBindVertexArray(empty_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_FRAMEBUFFER, target.drawing());
    glViewport(0, 0, target.width(), target.height());
}

}  // namespace spindrift
