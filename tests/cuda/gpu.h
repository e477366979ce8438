#pragma once
// What the GPU's tests share. They are built twice: for a real GPU, where they skip themselves
// without one, and for the emulated one, which takes smaller scenes.
#include "device/cuda_devices.h"
#include "scene/check.h"
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

// Lists see past moving thin solids as these stood when they were made, walks as they stand now:
// backends would differ by more than rounding. So these stand still.
inline void hold(const Scene& scene, Solid& solid) {
    if (!(thinness(scene, solid) > 0) || solid.floats()) return;
    solid.keyframes.clear();
    solid.velocity = {}, solid.spin = 0;
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
    for (Solid& solid : scene.solids) hold(scene, solid);
    checkScene(scene, file);
    return scene;
}
inline Scene testScene(const std::string& file) { return shippedScene("test/" + file); }

}  // namespace spindrift
