#pragma once
// What the GPU's tests share. They are built twice: for a real GPU, where they skip themselves
// without one, and for the emulated one, which takes smaller scenes.
#include "device/cuda_devices.h"
#include "scene/check.h"
#include "scene/formulation.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "scene/thin_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#define NEED_GPU()                          \
    if (!spindrift::cudaProblem(0).empty()) \
    GTEST_SKIP() << "skipped: no CUDA device (" << spindrift::cudaProblem(0) << ")"

namespace spindrift {

#ifdef SPINDRIFT_EMULATED_GPU
inline constexpr bool emulated = true;
#else
inline constexpr bool emulated = false;
#endif

// Lists decide what thin solids hide when they are made, walks each time: backends would differ by
// more than rounding. So they are compared without those.
inline void leaveOutThin(Scene& scene) {
    std::erase_if(scene.solids,
                  [&](const Solid& s) { return thinness(scene, s) > 0 && !s.floats(); });
}

// A shipped scene; coarser on the emulated GPU, so that it has about `particles` of fluid there.
inline Scene shippedScene(const std::string& file, double particles = 400) {
    const char* folder =
        std::getenv("SPINDRIFT_CONFIGS");  // where the checkout is not where the program was built
    Scene scene =
        loadScene(std::string(folder ? folder : SPINDRIFT_SOURCE_DIR "/configs") + "/" + file);
    const double count = double(countParticles(scene).fluid);
    if (emulated && count > particles)
        scene.simulation.spacing *= float(std::cbrt(count / particles));
    leaveOutThin(scene);
    checkScene(scene, file);
    return scene;
}
inline Scene testScene(const std::string& file) { return shippedScene("test/" + file); }

}  // namespace spindrift
