#include "app/command_line.h"
#include "core/error.h"

#include <cstdio>
#include <cstdlib>
#include <new>

// Threads that wait at the end of a loop spin for milliseconds by default, which stalls every loop as soon as the renderer
// or another program wants a core; asleep at once they cost small scenes 0.04 ms a loop. A short spin has neither
// fault. libgomp reads its settings when it is loaded, before main: hence this early.
static void spinBriefly(int, char**, char**) {
    if (!std::getenv("OMP_WAIT_POLICY")) setenv("GOMP_SPINCOUNT", "2000", 0);
}
[[gnu::section(".preinit_array"), gnu::used]] static void (*const beforeLibraries)(int, char**, char**) = spinBriefly;

int main(int argc, char** argv) {
    using spindrift::Exit;
    try {
        return spindrift::runCommandLine(argc, argv);
    } catch (const spindrift::Error& error) {
        std::fprintf(stderr, "spindrift: %s\n", error.what());
        return int(error.exit);
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "spindrift: out of memory; use a larger simulation.spacing\n");
        return int(Exit::Memory);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "spindrift: a bug: %s\n", error.what());
        return int(Exit::Internal);
    }
}
