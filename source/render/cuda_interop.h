#pragma once
// GL buffers lent to CUDA, so that a kernel writes what GL draws.
#include "core/vertex.h"
#include "render/gl.h"

#include <string>

struct cudaGraphicsResource;

namespace spindrift {

// The CUDA device on which the current GL context draws, as CUDA says, and where it says nothing as
// EGL does; hostMemory where GL runs elsewhere or there is no CUDA.
int drawingDevice();

// One GL buffer, registered with CUDA: costly, so it is done once and again only when the buffer
// has grown. Later errors of CUDA are Errors (DeviceLost).
class CudaLoan {
public:
    CudaLoan() = default;
    ~CudaLoan() { end(); }
    CudaLoan(const CudaLoan&) = delete;
    CudaLoan& operator=(const CudaLoan&) = delete;

    bool begun() const { return resource_ != nullptr; }
    // Why CUDA doesn't take the buffer, although it may be told that its device draws: "" when it
    // does.
    std::string begin(GLuint buffer, int device);
    void end();  // before the buffer gets other memory

    // Device memory for work on this stream, a cudaStream_t, until unmap(); GL must not touch the
    // buffer in between. That work comes behind GL's reading of the last picture, GL's next behind
    // that work, without waiting for it.
    Vertex* map(void* stream);
    void unmap();

private:
    cudaGraphicsResource* resource_ = nullptr;
    int device_ = hostMemory;
    void* stream_ = nullptr;
};

}  // namespace spindrift
