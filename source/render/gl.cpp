#include "render/gl.h"

#include "core/error.h"

namespace spindrift {

namespace {
// Debian builds GLEW for GLX; under EGL it reports this although every pointer is loaded.
constexpr GLenum noGlxDisplay = 4;
}  // namespace

void loadGl() {
    glewExperimental = GL_TRUE;
    const GLenum status = glewInit();
    if (status != GLEW_OK && status != noGlxDisplay)
        throw Error(Failure::NoDisplay,
                    "OpenGL could not be loaded: install a driver (libgl1-mesa-dri)");
    GLint major = 0, minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 45 || !glCreateBuffers || !glTextureStorage2DMultisample)
        throw Error(Failure::NoDisplay, "OpenGL 4.5 is needed and this driver has " +
                                            std::to_string(major) + "." + std::to_string(minor) +
                                            ": update it, or install libgl1-mesa-dri");
}

std::string glName() {
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return renderer ? renderer : "unknown";
}

bool isSoftwareGl() {
    const std::string name = glName();
    return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

GlBuffer makeBuffer() {
    GLuint n = 0;
    glCreateBuffers(1, &n);
    return GlBuffer(n);
}
GlVertexArray makeVertexArray() {
    GLuint n = 0;
    glCreateVertexArrays(1, &n);
    return GlVertexArray(n);
}
GlTexture makeTexture(GLenum target) {
    GLuint n = 0;
    glCreateTextures(target, 1, &n);
    return GlTexture(n);
}
GlRenderbuffer makeRenderbuffer() {
    GLuint n = 0;
    glCreateRenderbuffers(1, &n);
    return GlRenderbuffer(n);
}
GlFramebuffer makeFramebuffer() {
    GLuint n = 0;
    glCreateFramebuffers(1, &n);
    return GlFramebuffer(n);
}

}  // namespace spindrift
