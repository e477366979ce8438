#pragma once
// An OpenGL context without a window: surfaceless on Mesa, a GPU's device platform otherwise.
#include "core/vertex.h"

namespace spindrift {

class EglContext {
public:
    // Makes a 4.5 core context current on this thread, on that CUDA device if it can draw; throws
    // Error (NoDisplay).
    explicit EglContext(int cudaDevice = hostMemory);
    ~EglContext();
    EglContext(const EglContext&) = delete;
    // Of this thread from now on, or of none, so that another thread can take it.
    void makeCurrent();
    void release();
    EglContext& operator=(const EglContext&) = delete;

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace spindrift
