#pragma once
// The two ways to fail that are not physics: a user's mistake (Error) and a bug (CHECK).
#include <stdexcept>
#include <string>

namespace spindrift {

// What a mistake is about.
enum class Failure {
    Usage,       // command line, or a function of the library: unknown option, bad value
    Scene,       // scene file: missing, malformed, unknown key, value out of range
    Output,      // a file could not be written
    NoDisplay,   // no window or no off-screen GL
    NoDevice,    // a GPU was asked for and there is none
    Memory,      // the scene needs more memory than there is
    DeviceLost,  // a GPU failed during the run
    Invalid,     // what was asked for is outside the validity of the method, and that is forbidden
};

// A mistake the user can mend. `what()` is one line: what happened, where, and how to mend it;
// control characters of what it cites, a file's name or a key, become spaces.
struct Error : std::runtime_error {
    Error(Failure, const std::string& message);
    Failure failure;
};

[[noreturn]] void failCheck(const char* expression, const char* file, int line);

}  // namespace spindrift

// A bug, not a mistake: prints expression and place, aborts.
#define CHECK(expression) \
    ((expression) ? (void)0 : ::spindrift::failCheck(#expression, __FILE__, __LINE__))
