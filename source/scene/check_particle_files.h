#pragma once
// What checkScene asks of the particles that bodies take from files.
#include "scene/scene.h"

namespace spindrift {

// That they are in the domain, of fluids that there are, one by one, and as dense and as far apart
// as the scene says. Throws Error (Scene).
void checkParticleFiles(const Scene&);

}  // namespace spindrift
