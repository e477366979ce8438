#include "app/command_line.h"
#include "core/error.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <system_error>

// Threads that wait at the end of a loop spin for milliseconds by default, which stalls every loop
// as soon as the renderer or another program wants a core; asleep at once they cost small scenes
// 0.04 ms a loop. A short spin has neither fault. libgomp reads its settings when it is loaded,
// before main: hence the program starts itself once more.
static void startWithShortSpin(char** argv) {
    if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
    setenv("GOMP_SPINCOUNT", "20000", 0);
    // By its path, so that it keeps its name. Where this fails the program works as well, only less
    // smoothly.
    std::error_code none;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", none);
    if (!none) execv(self.c_str(), argv);
}

int main(int argc, char** argv) {
    using spindrift::Exit;
    startWithShortSpin(argv);
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
