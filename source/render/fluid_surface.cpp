#include "render/fluid_surface.h"

#include "render/shader.h"

#include <algorithm>

namespace spindrift {
namespace {

GlTexture makeLayer(int width, int height, GLenum format, GLint filter) {
    GlTexture texture = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(texture, 1, format, width, height);
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, filter);
    glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

GlFramebuffer framebufferOf(GLuint color, GLuint second = 0) {
    GlFramebuffer framebuffer = makeFramebuffer();
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, color, 0);
    if (second == 0) return framebuffer;
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT1, second, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer, 2, both);
    return framebuffer;
}

int divided(int pixels, int by) { return (pixels + by - 1) / by; }

}  // namespace

FluidSurface::FluidSurface()
    : distance_(loadProgram("fluid")),
      smooth_(loadFilter("smooth")),
      normal_(loadFilter("normals")),
      thickness_(loadProgram("fluid", "#define THICKNESS\n")),
      compose_(loadFilter("surface")),
      empty_(makeVertexArray()) {}

void FluidSurface::resize(const Framebuffer& target) {
    if (target.width() == width_ && target.height() == height_) return;
    width_ = target.width(), height_ = target.height();
    const int w = divided(width_, coarser), h = divided(height_, coarser),
              small = divided(width_, coarsest), low = divided(height_, coarsest);
    for (int k = 0; k < 2; ++k) {
        distances_[k] = makeLayer(w, h, GL_R32F, GL_NEAREST);
        into_[k] = framebufferOf(distances_[k]);
    }
    depth_ = makeLayer(w, h, GL_DEPTH_COMPONENT32F, GL_NEAREST);
    glNamedFramebufferTexture(into_[0], GL_DEPTH_ATTACHMENT, depth_, 0);
    normals_ = makeLayer(w, h, GL_RGBA32F, GL_NEAREST);
    intoNormals_ = framebufferOf(normals_);
    thicknesses_ = makeLayer(small, low, GL_R16F, GL_LINEAR);
    tints_ = makeLayer(small, low, GL_RGBA16F, GL_LINEAR);
    intoThickness_ = framebufferOf(thicknesses_, tints_);
    behind_ = makeLayer(width_, height_, GL_RGBA8, GL_LINEAR);
    intoBehind_ = framebufferOf(behind_);
}

void FluidSurface::draw(const Framebuffer& target, GLuint vertices, int count, GLuint tables) {
    resize(target);
    glBindTextureUnit(0, tables);
    findDistances(vertices, count);
    smooth();
    findNormals();
    glBindTextureUnit(0, tables);
    glBindTextureUnit(1, distances_[0]);
    glBindTextureUnit(2, target.resolvedDepth());
    findThickness(vertices, count);
    compose(target);
}

void FluidSurface::findDistances(GLuint vertices, int count) {
    const float none[4] = {0, 0, 0, 0}, farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, into_[0]);
    glViewport(0, 0, divided(width_, coarser), divided(height_, coarser));
    glClearNamedFramebufferfv(into_[0], GL_COLOR, 0, none);
    glClearNamedFramebufferfv(into_[0], GL_DEPTH, 0, &farthest);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glUseProgram(distance_);
    glUniform1f(0, 1.0f / coarser);
    glBindVertexArray(vertices);
    glDrawArrays(GL_POINTS, 0, count);
    glDisable(GL_DEPTH_TEST);
}

// There and back between the two textures, along rows and along columns.
void FluidSurface::smooth() {
    const float reach = 6;  // particle radii
    glUseProgram(smooth_);
    glBindVertexArray(empty_);
    glUniform2f(1, reach, 1.0f / coarser);
    for (int k = 0; k < 2 * smoothings; ++k) {
        glBindFramebuffer(GL_FRAMEBUFFER, into_[(k + 1) % 2]);
        glBindTextureUnit(0, distances_[k % 2]);
        glUniform2i(0, k % 2 == 0, k % 2);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
}

void FluidSurface::findNormals() {
    glBindFramebuffer(GL_FRAMEBUFFER, intoNormals_);
    glBindTextureUnit(0, distances_[0]);
    glUseProgram(normal_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FluidSurface::findThickness(GLuint vertices, int count) {
    const float nothing[4] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, intoThickness_);
    glViewport(0, 0, divided(width_, coarsest), divided(height_, coarsest));
    glClearNamedFramebufferfv(intoThickness_, GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(intoThickness_, GL_COLOR, 1, nothing);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(thickness_);
    glUniform1f(0, 1.0f / coarsest);
    glUniform2f(1, float(coarsest) / coarser, coarsest);
    glBindVertexArray(vertices);
    glDrawArrays(GL_POINTS, 0, count);
    glDisable(GL_BLEND);
}

void FluidSurface::compose(const Framebuffer& target) {
    glBlitNamedFramebuffer(target.resolved(), intoBehind_, 0, 0, width_, height_, 0, 0, width_,
                           height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, target.drawing());
    glViewport(0, 0, width_, height_);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    const GLuint layers[] = {normals_, thicknesses_, tints_, behind_};
    for (GLuint unit = 0; unit < 4; ++unit) glBindTextureUnit(unit, layers[unit]);
    glUseProgram(compose_);
    glBindVertexArray(empty_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

}  // namespace spindrift
