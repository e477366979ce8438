#include "cuda_gl_interop.h"

#include "emulation.h"

struct cudaGraphicsResource {
    GLuint buffer;
    void* mapped;
    GLint64 bytes;
};

using emulation::counts, emulation::machine;

cudaError_t cudaGLGetDevices(unsigned* count, int* devices, unsigned most, cudaGLDeviceList) {
    *count = machine.drawsToo && most > 0 ? 1 : 0;
    if (*count > 0) devices[0] = 0;
    return *count > 0 ? cudaSuccess : cudaErrorNoDevice;
}
cudaError_t cudaGraphicsGLRegisterBuffer(cudaGraphicsResource** r, GLuint buffer, unsigned) {
    GLint64 bytes = 0;
    glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &bytes);
    if (machine.lost || !machine.sharesMemory || bytes == 0) return cudaErrorInvalidValue;
    *r = new cudaGraphicsResource{buffer, nullptr, bytes};
    ++counts.registrations;
    return cudaSuccess;
}
cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource* r) {
    return delete r, cudaSuccess;
}
// The default stream stands for a mistake: kernels of another one would not come behind it.
cudaError_t cudaGraphicsMapResources(int, cudaGraphicsResource** r, cudaStream_t stream) {
    if (machine.lost) return cudaErrorIllegalAddress;
    if (!stream) return cudaErrorInvalidValue;
    GLint64 bytes = 0;
    glGetNamedBufferParameteri64v((*r)->buffer, GL_BUFFER_SIZE, &bytes);
    if ((*r)->mapped || bytes != (*r)->bytes)
        return cudaErrorInvalidValue;  // mapped twice, or grown while lent
    (*r)->mapped = glMapNamedBufferRange((*r)->buffer, 0, GLsizeiptr(bytes),
                                         GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    ++counts.maps;
    return (*r)->mapped ? cudaSuccess : cudaErrorInvalidValue;
}
cudaError_t cudaGraphicsResourceGetMappedPointer(void** p, size_t* bytes, cudaGraphicsResource* r) {
    *p = r->mapped;
    *bytes = size_t(r->bytes);
    return r->mapped ? cudaSuccess : cudaErrorInvalidValue;
}
// GL goes on behind the stream's work.
cudaError_t cudaGraphicsUnmapResources(int, cudaGraphicsResource** r, cudaStream_t stream) {
    if (!(*r)->mapped || !stream) return cudaErrorInvalidValue;
    emulation::finish(stream);
    glUnmapNamedBuffer((*r)->buffer);
    (*r)->mapped = nullptr;
    return cudaSuccess;
}
