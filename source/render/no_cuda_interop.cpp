// A build without CUDA lends nothing.
#include "render/cuda_interop.h"

namespace spindrift {

int drawingDevice() { return hostMemory; }
std::string CudaLoan::begin(GLuint, int) { return "there is no CUDA in this build"; }
void CudaLoan::end() {}
Vertex* CudaLoan::map(void*) { return nullptr; }
void CudaLoan::unmap() {}

}  // namespace spindrift
