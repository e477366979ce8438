#pragma once
#include "scene/scene.h"

#include "scene/particles.h"

#include <optional>
#include <string>

namespace spindrift {

// Refuses a scene that can't run or makes no sense: values out of range, bodies outside the domain,
// no fluid, more particles than fit. Throws Error: Failure::Memory when the machine is too small,
// else Failure::Scene; one line with `place` (the file), path and remedy. `begun`: the particles of
// a run that goes on; where its bodies had theirs from no longer matters, nor
// what its view asks for: that is drawn as far as it can be.
void checkScene(const Scene&, const std::string& place = "scene",
                std::optional<ParticleCount> begun = {});

}  // namespace spindrift
