#include "render/framebuffer.h"

#include "core/error.h"

#include <algorithm>

namespace spindrift {

Framebuffer::Framebuffer(int width, int height, int samples)
    : drawing_(makeFramebuffer()), resolved_(makeFramebuffer()) {
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples_ = std::clamp(samples, 1, most);
    resize(width, height);
}

void Framebuffer::resize(int width, int height) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    if (width < 1 || height < 1 || width > most || height > most)
        throw Error(Failure::Usage, "a picture of " + std::to_string(width) + "x" +
                                        std::to_string(height) + " can't be drawn: 1 to " +
                                        std::to_string(most) + " pixels a side");
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    // New storage needs new names: the storage of a renderbuffer in use would be kept alive by its
    // framebuffer.
    const auto attachColor = [&](GLuint framebuffer, int samples) {
        GlRenderbuffer storage = makeRenderbuffer();
        glNamedRenderbufferStorageMultisample(storage, samples > 1 ? samples : 0, GL_RGBA8, width,
                                              height);
        glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, storage);
        return storage;
    };
    const auto attachDepth = [&](GLuint framebuffer, int samples) {
        GlTexture storage = makeTexture(samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D);
        if (samples > 1)
            glTextureStorage2DMultisample(storage, samples, GL_DEPTH_COMPONENT32F, width, height,
                                          GL_TRUE);
        else
            glTextureStorage2D(storage, 1, GL_DEPTH_COMPONENT32F, width, height);
        glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, storage, 0);
        return storage;
    };
    color_ = attachColor(resolved_, 1);
    depth_ = attachDepth(resolved_, 1);
    if (samples_ > 1) {
        drawingColor_ = attachColor(drawing_, samples_);
        drawingDepth_ = attachDepth(drawing_, samples_);
    }
    if (glCheckNamedFramebufferStatus(drawing(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(Failure::NoDisplay, "the driver refuses a picture of " + std::to_string(width) +
                                            "x" + std::to_string(height) + " with " +
                                            std::to_string(samples_) +
                                            " samples: set window.samples=1 or a smaller size");
}

void Framebuffer::resolve() const {
    if (samples_ > 1)
        glBlitNamedFramebuffer(drawing_, resolved_, 0, 0, width_, height_, 0, 0, width_, height_,
                               GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

GLuint Framebuffer::resolvedDepth() const {
    if (samples_ > 1)
        glBlitNamedFramebuffer(drawing_, resolved_, 0, 0, width_, height_, 0, 0, width_, height_,
                               GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    return depth_;
}

float Framebuffer::depth(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return 1;
    const int row = height_ - 1 - y;
    if (samples_ > 1)
        glBlitNamedFramebuffer(drawing_, resolved_, x, row, x + 1, row + 1, x, row, x + 1, row + 1,
                               GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    float depth = 1;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
    glReadPixels(x, row, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    return depth;
}

Image Framebuffer::image() const {
    std::vector<uint8_t> rgba(size_t(width_) * height_ * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    Image image{width_, height_, std::vector<uint8_t>(size_t(width_) * height_ * 3)};
    for (int y = 0; y < height_; ++y) {  // GL's first row is the lowest
        const uint8_t* from = rgba.data() + size_t(height_ - 1 - y) * width_ * 4;
        uint8_t* to = image.rgb.data() + size_t(y) * width_ * 3;
        for (int x = 0; x < width_; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
    }
    return image;
}

void Framebuffer::blit(int x, int y) const {
    glBlitNamedFramebuffer(resolved_, 0, 0, 0, width_, height_, x, y, x + width_, y + height_,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace spindrift
