#pragma once
// The one GL buffer that the simulation writes and the renderer draws.
#include "core/vertex.h"
#include "render/cuda_interop.h"
#include "render/gl.h"

#include <optional>
#include <vector>

namespace spindrift {

class VertexBuffer {
public:
    // Needs a current context.
    VertexBuffer() : buffer_(makeBuffer()) {}

    // Keeps the memory when it's large enough; the contents are lost when it grows.
    void resize(int count);
    int count() const { return count_; }

    // Memory for count() vertices, of that CUDA device if it is the one that draws, of the host
    // otherwise; the old contents are undefined. Nothing may be drawn until unmap().
    // `stream` is the one that the device works on (Readable::cudaStream).
    VertexMemory map(int device = hostMemory, void* stream = nullptr);
    void unmap();
    bool mapped() const { return mapped_ != Mapped::Not; }

    GLuint name() const { return buffer_; }
    // The first so many vertices.
    std::vector<Vertex> read(int count) const;

private:
    enum class Mapped { Not, Host, Device };
    GlBuffer buffer_;
    int count_ = 0, capacity_ = 0;
    std::optional<int>
        drawingDevice_;  // asked for when a GPU steps: without one CUDA needn't start
    Mapped mapped_ = Mapped::Not;
    CudaLoan loan_;  // ends before the buffer does
};

}  // namespace spindrift
