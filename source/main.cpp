#include "app/command_line.h"
#include "app/exit_code.h"
#include "core/system.h"

#include <cstdio>
#include <cstdlib>
#include <new>

// Threads that wait at the end of a loop spin for milliseconds by default, which stalls every loop
// as soon as the renderer or another program wants a core; asleep at once they cost small scenes
// 0.04 ms a loop. A short spin has neither fault. libgomp reads its settings when it is loaded,
// before main: hence the program starts itself once more. Where this fails it works as well, only
// less smoothly.
static void startWithShortSpin(char** argv) {
    if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
    spindrift::os::restartWith("GOMP_SPINCOUNT", "20000", argv);
}

int main(int argc, char** argv) {
    using spindrift::Exit;
    startWithShortSpin(argv);
    try {
        return spindrift::runCommandLine(argc, argv);
    } catch (const spindrift::Error& error) {
        std::fprintf(stderr, "spindrift: %s\n", error.what());
        return int(exitOf(error.failure));
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "spindrift: out of memory; use a larger simulation.spacing\n");
        return int(Exit::Memory);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "spindrift: a bug: %s\n", error.what());
        return int(Exit::Internal);
    }
}
