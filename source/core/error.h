#pragma once
// The two ways to fail that are not physics: a user's mistake (Error) and a bug (CHECK).
#include <stdexcept>
#include <string>

namespace spindrift {

// What the process returns to the shell; each kind of mistake has its own number (docs/RUNNING.md,
// "Exit codes").
enum class Exit {
    Ok = 0,
    Different = 1,   // `compare` found the pictures different, `validate` an error above its target
    Usage = 2,       // command line: unknown option, bad value
    Scene = 3,       // scene file: missing, malformed, unknown key, value out of range
    Output = 4,      // a file could not be written
    NoDisplay = 5,   // no window or no off-screen GL
    NoDevice = 6,    // a GPU was asked for and there is none
    Memory = 7,      // the scene needs more memory than there is
    Diverged = 8,    // the physics blew up (health guard)
    DeviceLost = 9,  // a GPU failed during the run
    Invalid = 10,    // a result is outside the validity of the method, and output.strict is on
    Internal = 70,   // a bug of ours
};

// A mistake the user can mend. `what()` is one line: what happened, where, and how to mend it;
// control characters of what it cites, a file's name or a key, become spaces.
struct Error : std::runtime_error {
    Error(Exit code, const std::string& message);
    Exit exit;
};

[[noreturn]] void failCheck(const char* expression, const char* file, int line);

}  // namespace spindrift

// A bug, not a mistake: prints expression and place, aborts.
#define CHECK(expression) \
    ((expression) ? (void)0 : ::spindrift::failCheck(#expression, __FILE__, __LINE__))
