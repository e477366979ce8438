#pragma once
// An OpenGL context without a window: surfaceless on Mesa, a GPU's device platform otherwise.

namespace spindrift {

class EglContext {
public:
    // Makes a 4.5 core context current on this thread; throws Error (NoDisplay).
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace spindrift
