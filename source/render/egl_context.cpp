#include "render/egl_context.h"

#include "core/error.h"
#include "render/gl.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>

namespace spindrift {

namespace {

EGLContext contextOn(EGLDisplay display) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    if (!display || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
    EGLContext context = EGL_NO_CONTEXT;
    if (eglBindAPI(EGL_OPENGL_API))
        context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
    if (context) eglDestroyContext(display, context);
    eglTerminate(display);
    return EGL_NO_CONTEXT;
}

bool isCudaDevice(EGLDeviceEXT device, int number) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(
        eglGetProcAddress("eglQueryDeviceAttribEXT"));
    EGLAttrib found = hostMemory;
    return query && query(device, EGL_CUDA_DEVICE_NV, &found) && int(found) == number;
}

// Every display worth trying, the GPU asked for first, then other GPUs: the device platform lists
// them in front of software.
std::array<EGLDisplay, 9> displays(int cudaDevice) {
    std::array<EGLDisplay, 9> found{};
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    const auto queryDevices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    if (queryDevices) queryDevices(EGLint(devices.size()), devices.data(), &count);
    if (cudaDevice != hostMemory)
        std::stable_partition(devices.begin(), devices.begin() + count, [&](EGLDeviceEXT device) {
            return isCudaDevice(device, cudaDevice);
        });
    for (EGLint i = 0; i < count; ++i)
        found[i] = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    found[count] =
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    return found;
}

}  // namespace

EglContext::EglContext(int cudaDevice) {
    for (EGLDisplay display : displays(cudaDevice)) {
        context_ = contextOn(display);
        if (!context_) continue;
        display_ = display;
        loadGl();
        return;
    }
    throw Error(Failure::NoDisplay,
                "no off-screen OpenGL 4.5 through EGL: install libegl-mesa0 and libgl1-mesa-dri");
}

void EglContext::makeCurrent() {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
        throw Error(Failure::NoDisplay, "pictures are being drawn on another thread; wait for it");
}
void EglContext::release() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

EglContext::~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

}  // namespace spindrift
