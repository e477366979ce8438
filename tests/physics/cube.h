#pragma once
// The scene that most tests of solids and objects begin with.
#include "scene/json.h"

#include <string>
#include <vector>

namespace spindrift {

// A cubic metre, 20 spacings wide, on the CPU; the knobs are set one after the other.
inline Scene cubeWith(const std::vector<std::string>& knobs) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.domain.max = {1, 1, 1};
    scene.simulation.spacing = 0.05f;
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}

// The same with just a little fluid in a corner, where nobody meets it.
inline Scene dryCubeWith(const std::vector<std::string>& knobs) {
    std::vector<std::string> all{"fluid.bodies[0].max=0.1,0.1,0.1"};
    all.insert(all.end(), knobs.begin(), knobs.end());
    return cubeWith(all);
}

}  // namespace spindrift
