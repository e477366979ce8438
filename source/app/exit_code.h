#pragma once
// What the process returns to the shell (docs/RUNNING.md, "Exit codes").
#include "core/error.h"

namespace spindrift {

enum class Exit {
    Ok = 0,
    Different = 1,  // `compare` found the pictures different, `validate` an error above its target
    Usage = 2,      // from here on as Failure has it
    Scene = 3,
    Output = 4,
    NoDisplay = 5,
    NoDevice = 6,
    Memory = 7,
    Diverged = 8,  // the physics blew up (health guard)
    DeviceLost = 9,
    Invalid = 10,   // a result is outside the validity of the method, and output.strict is on
    Internal = 70,  // a bug of ours
};

constexpr Exit exitOf(Failure failure) {
    switch (failure) {
        case Failure::Usage:
            return Exit::Usage;
        case Failure::Scene:
            return Exit::Scene;
        case Failure::Output:
            return Exit::Output;
        case Failure::NoDisplay:
            return Exit::NoDisplay;
        case Failure::NoDevice:
            return Exit::NoDevice;
        case Failure::Memory:
            return Exit::Memory;
        case Failure::DeviceLost:
            return Exit::DeviceLost;
        case Failure::Invalid:
            return Exit::Invalid;
    }
    return Exit::Internal;
}

}  // namespace spindrift
