#pragma once
// CUDA's loans of GL buffers, on the host: lent memory is the buffer mapped by GL.
#include <GL/glew.h>

#include "cuda_runtime.h"

struct cudaGraphicsResource;
enum cudaGLDeviceList { cudaGLDeviceListAll = 1 };
inline constexpr unsigned cudaGraphicsRegisterFlagsWriteDiscard = 2;

cudaError_t cudaGLGetDevices(unsigned* count, int* devices, unsigned most, cudaGLDeviceList);
cudaError_t cudaGraphicsGLRegisterBuffer(cudaGraphicsResource**, GLuint, unsigned flags);
cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource*);
cudaError_t cudaGraphicsMapResources(int count, cudaGraphicsResource**, cudaStream_t);
cudaError_t cudaGraphicsResourceGetMappedPointer(void**, size_t*, cudaGraphicsResource*);
cudaError_t cudaGraphicsUnmapResources(int count, cudaGraphicsResource**, cudaStream_t);
