#pragma once
// What makes a run quicker that can't keep up with the clock, and what its time goes to.
#include "core/pass_time.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace spindrift {

// One click each: knobs that the run follows, a formulation that it goes on with from where it
// stands, or the scene once more from its beginning.
struct Remedy {
    enum class How { Live, GoOn, Again };
    std::string label, help;
    How how;
    Scene scene;  // with it
};
// Those that this scene can have, one of a kind: none that is there already, that checkScene
// refuses, or that would bring a remark (measure/validity.h). `isGoingOn`: the run began from a
// checkpoint, which can't begin anew.
std::vector<Remedy> remediesFor(const Scene&, bool isGoingOn);

// The two passes that take most of a step, with their shares: "forces 41 %, density 25 %".
std::string slowestPasses(const std::vector<PassTime>&);

}  // namespace spindrift
