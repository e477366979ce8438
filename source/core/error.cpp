#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace spindrift {

void failCheck(const char* expression, const char* file, int line) {
    std::fprintf(stderr, "spindrift: bug: %s is false at %s:%d\n", expression, file, line);
    std::abort();
}

}  // namespace spindrift
