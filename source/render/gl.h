#pragma once
// OpenGL 4.5 core through GLEW, and owners for GL names.
#include <GL/glew.h>

#include <string>
#include <utility>

namespace spindrift {

// Loads the GL functions of the current context; throws Error (NoDisplay) below 4.5.
void loadGl();
// "llvmpipe (LLVM 15.0.6, 256 bits)"
std::string glName();
// Drawn by the processor, not by graphics hardware.
bool isSoftwareGl();

// Owns one GL name; `Delete` frees it while the context is current.
template <class Delete> class GlName {
public:
    explicit GlName(GLuint name = 0) : name_(name) {}
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlName() {
        if (name_) Delete()(name_);
    }
    operator GLuint() const { return name_; }

private:
    GLuint name_;
};

struct DeleteBuffer {
    void operator()(GLuint n) const { glDeleteBuffers(1, &n); }
};
struct DeleteVertexArray {
    void operator()(GLuint n) const { glDeleteVertexArrays(1, &n); }
};
struct DeleteTexture {
    void operator()(GLuint n) const { glDeleteTextures(1, &n); }
};
struct DeleteRenderbuffer {
    void operator()(GLuint n) const { glDeleteRenderbuffers(1, &n); }
};
struct DeleteFramebuffer {
    void operator()(GLuint n) const { glDeleteFramebuffers(1, &n); }
};
struct DeleteProgram {
    void operator()(GLuint n) const { glDeleteProgram(n); }
};

using GlBuffer = GlName<DeleteBuffer>;
using GlVertexArray = GlName<DeleteVertexArray>;
using GlTexture = GlName<DeleteTexture>;
using GlRenderbuffer = GlName<DeleteRenderbuffer>;
using GlFramebuffer = GlName<DeleteFramebuffer>;
using GlProgram = GlName<DeleteProgram>;

GlBuffer makeBuffer();
GlVertexArray makeVertexArray();
GlTexture makeTexture(GLenum target);
GlRenderbuffer makeRenderbuffer();
GlFramebuffer makeFramebuffer();

}  // namespace spindrift
