#include "render/vertex_buffer.h"

#include "core/error.h"

namespace spindrift {

void VertexBuffer::resize(int count) {
    CHECK(count >= 0);
    count_ = count;
    if (count <= capacity_) return;
    capacity_ = count;
    glNamedBufferData(buffer_, GLsizeiptr(sizeof(Vertex)) * count, nullptr, GL_STREAM_DRAW);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw Error(Exit::Memory, "no graphics memory for " + std::to_string(count) +
                                      " particles: raise simulation.spacing");
}

Vertex* VertexBuffer::map() {
    if (count_ == 0) return nullptr;
    void* memory = glMapNamedBufferRange(buffer_, 0, GLsizeiptr(sizeof(Vertex)) * count_,
                                         GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    CHECK(memory);
    return static_cast<Vertex*>(memory);
}

void VertexBuffer::unmap() {
    if (count_ > 0) glUnmapNamedBuffer(buffer_);
}

}  // namespace spindrift
