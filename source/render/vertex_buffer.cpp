#include "render/vertex_buffer.h"

#include "core/error.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace spindrift {

void VertexBuffer::resize(int count) {
    CHECK(count >= 0 && !mapped());
    count_ = count;
    if (count <= capacity_) return;
    // While particles come it must not be made, and lent, anew at every picture.
    capacity_ = std::max(count, capacity_ + capacity_ / 2);
    loan_.end();
    glNamedBufferData(buffer_, GLsizeiptr(sizeof(Vertex)) * capacity_, nullptr, GL_STREAM_DRAW);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw Error(Failure::Memory, "no graphics memory for " + std::to_string(count) +
                                         " particles: raise simulation.spacing");
}

VertexMemory VertexBuffer::map(int device, void* stream) {
    CHECK(!mapped());
    if (count_ == 0) return {nullptr, device};
    if (device != hostMemory && !drawingDevice_) drawingDevice_ = drawingDevice();
    if (device != hostMemory && device == drawingDevice_ && !loan_.begun()) {
        if (const std::string why = loan_.begin(buffer_, device); !why.empty()) {
            std::fprintf(stderr,
                         "spindrift: OpenGL and CUDA do not share their memory (%s): vertices are "
                         "copied\n",
                         why.c_str());
            drawingDevice_ = hostMemory;
        }
    }
    if (device != hostMemory && device == drawingDevice_) {
        const VertexMemory memory{loan_.map(stream), device};
        mapped_ = Mapped::Device;
        return memory;
    }
    void* memory = glMapNamedBufferRange(buffer_, 0, GLsizeiptr(sizeof(Vertex)) * count_,
                                         GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    CHECK(memory);
    mapped_ = Mapped::Host;
    return {static_cast<Vertex*>(memory), hostMemory};
}

void VertexBuffer::unmap() {
    if (mapped_ == Mapped::Host) glUnmapNamedBuffer(buffer_);
    if (mapped_ == Mapped::Device) loan_.unmap();
    mapped_ = Mapped::Not;
}

std::vector<Vertex> VertexBuffer::read(int count) const {
    CHECK(!mapped() && count <= count_);
    std::vector<Vertex> vertices(static_cast<size_t>(count));
    if (count > 0)
        glGetNamedBufferSubData(buffer_, 0, GLsizeiptr(sizeof(Vertex)) * count, vertices.data());
    return vertices;
}

}  // namespace spindrift
