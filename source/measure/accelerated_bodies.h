#pragma once
// Bodies that accelerate in fluid at rest, whose answers are known: cases of `spindrift validate`.
#include "measure/validation.h"

namespace spindrift {

// What solid 0 of the scene, whose keyframes let its acceleration along x grow to what it stays at,
// feels in the middle of a closed box. `coefficient` is its added mass over that of the fluid in
// its place, in fluid without an end; mean forces within `target` % are wanted at resolutions of
// `from` and above. With viscosity also the early drag of its surface.
void runAcceleratedBody(const Scene&, ValidationRun&, double coefficient, double target, int from);
// A cylinder afloat, half immersed, that is let go a little above its rest.
// Against the linear answer in the folder `data`.
void runHeave(const Scene&, ValidationRun&, const std::string& data);

}  // namespace spindrift
