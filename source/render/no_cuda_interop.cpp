// A build without CUDA lends nothing.
#include "core/error.h"
#include "render/cuda_interop.h"

namespace spindrift {

int drawingDevice() { return hostMemory; }
void CudaLoan::begin(GLuint, int) { CHECK(false); }
void CudaLoan::end() {}
Vertex* CudaLoan::map() { return nullptr; }
void CudaLoan::unmap() {}

}  // namespace spindrift
