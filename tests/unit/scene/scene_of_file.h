#pragma once
#include "scene/scene.h"

#include <string>

namespace spindrift {

// A scene that begins with the particles of a file, a tenth of a metre apart.
inline Scene sceneOfFile(const std::string& path, Formulation formulation) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.compute.threads = 1;
    scene.simulation.formulation = formulation;
    scene.domain = {{-1, 2, 3}, {0, 3, 4}};
    scene.simulation.spacing = 0.1f;
    scene.fluid.bodies.assign(1, Body{});
    scene.fluid.bodies[0].shape = Shape::File;
    scene.fluid.bodies[0].path = path;
    return scene;
}

}  // namespace spindrift
