#include "app/command_line.h"
#include "core/error.h"

#include <cstdio>
#include <new>

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
