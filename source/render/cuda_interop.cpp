#include "render/cuda_interop.h"

#include "core/error.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <cuda_gl_interop.h>

#include <string>
#include <utility>

namespace spindrift {

static void require(cudaError_t code, const char* what) {
    if (code == cudaSuccess) return;
    cudaGetLastError();
    throw Error(Failure::DeviceLost, std::string("the GPU was lost while ") + what + ": " +
                                         cudaGetErrorString(code) +
                                         "; start again, or use --backend cpu");
}

// Off screen the display knows its device.
static int deviceOfDisplay() {
    const EGLDisplay display = eglGetCurrentDisplay();
    if (display == EGL_NO_DISPLAY) return hostMemory;
    const auto queryDisplay = reinterpret_cast<PFNEGLQUERYDISPLAYATTRIBEXTPROC>(
        eglGetProcAddress("eglQueryDisplayAttribEXT"));
    const auto queryDevice = reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(
        eglGetProcAddress("eglQueryDeviceAttribEXT"));
    EGLAttrib device = 0, number = hostMemory;
    if (!queryDisplay || !queryDevice || !queryDisplay(display, EGL_DEVICE_EXT, &device))
        return hostMemory;
    if (!queryDevice(reinterpret_cast<EGLDeviceEXT>(device), EGL_CUDA_DEVICE_NV, &number))
        return hostMemory;
    return int(number);
}

int drawingDevice() {
    unsigned count = 0;
    int device = hostMemory;
    if (cudaGLGetDevices(&count, &device, 1, cudaGLDeviceListAll) == cudaSuccess && count > 0)
        return device;
    cudaGetLastError();
    return deviceOfDisplay();
}

std::string CudaLoan::begin(GLuint buffer, int device) {
    end();
    require(cudaSetDevice(device), "choosing a device");
    const cudaError_t code =
        cudaGraphicsGLRegisterBuffer(&resource_, buffer, cudaGraphicsRegisterFlagsWriteDiscard);
    device_ = device;
    if (code == cudaSuccess) return "";
    resource_ = nullptr;
    cudaGetLastError();
    return cudaGetErrorString(code);
}

void CudaLoan::end() {
    if (!resource_) return;
    cudaSetDevice(device_);
    cudaGraphicsUnregisterResource(std::exchange(resource_, nullptr));
}

Vertex* CudaLoan::map(void* stream) {
    require(cudaSetDevice(device_), "choosing a device");
    stream_ = stream;
    require(cudaGraphicsMapResources(1, &resource_, static_cast<cudaStream_t>(stream)),
            "mapping the vertex buffer");
    void* memory = nullptr;
    size_t bytes = 0;
    require(cudaGraphicsResourceGetMappedPointer(&memory, &bytes, resource_),
            "mapping the vertex buffer");
    return static_cast<Vertex*>(memory);
}

// What fails here was lost before, and the next call says so.
void CudaLoan::unmap() {
    cudaSetDevice(device_);
    cudaGraphicsUnmapResources(1, &resource_, static_cast<cudaStream_t>(stream_));
}

}  // namespace spindrift
