#pragma once
// What the simulation writes and the renderer draws: 16 bytes a particle.
namespace spindrift {

// Position in metres relative to the domain's lower corner; `value` is the scalar that colours it.
struct Vertex {
    float x, y, z, value;
};
static_assert(sizeof(Vertex) == 16);

inline constexpr int hostMemory = -1;
// Where vertices are to be written: host memory, or the memory of the CUDA device with this number.
struct VertexMemory {
    Vertex* data = nullptr;
    int device = hostMemory;
};

}  // namespace spindrift
