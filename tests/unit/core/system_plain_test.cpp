// The system that the standard library alone can be, which no build here links.
#define os plainOs
#include "unit/core/systems.h"
#include "core/system_plain.cpp"

#include <limits>

namespace spindrift {
namespace {

TEST(PlainSystem, WritesAndReplacesFiles) { expectToWriteAndReplaceFiles(); }
TEST(PlainSystem, NotesSignalsThatAskForAnEnd) { expectToNoteSignals(); }
TEST(PlainSystem, SaysThatItDoesNotKnow) {
    EXPECT_EQ(os::freeMemory(), std::numeric_limits<int64_t>::max());
    EXPECT_EQ(os::openNumberOf("/dev/fd/7"), -1);
    EXPECT_FALSE(os::OutFile().resize(1));
}

}  // namespace
}  // namespace spindrift
