#pragma once

namespace spindrift {

// Does what the arguments ask for; returns what the process returns. Throws Error: Usage for a
// mistake in the arguments, and what the commands throw.
int runCommandLine(int argc, const char* const* argv);

}  // namespace spindrift
