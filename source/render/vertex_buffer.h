#pragma once
// The one GL buffer that the simulation writes and the renderer draws.
#include "core/vertex.h"
#include "render/gl.h"

namespace spindrift {

class VertexBuffer {
public:
    VertexBuffer() : buffer_(makeBuffer()) {}

    // Keeps the memory when it's large enough; the contents are lost when it grows.
    void resize(int count);
    int count() const { return count_; }

    // Host memory for count() vertices; the old contents are undefined. Nothing may be drawn until
    // unmap().
    Vertex* map();
    void unmap();

    GLuint name() const { return buffer_; }

private:
    GlBuffer buffer_;
    int count_ = 0, capacity_ = 0;
};

}  // namespace spindrift
