#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace spindrift {
namespace {

std::string oneLine(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return text;
}

}  // namespace

Error::Error(Failure kind, const std::string& message)
    : std::runtime_error(oneLine(message)), failure(kind) {}

void failCheck(const char* expression, const char* file, int line) {
    std::fprintf(stderr, "spindrift: bug: %s is false at %s:%d\n", expression, file, line);
    std::abort();
}

}  // namespace spindrift
