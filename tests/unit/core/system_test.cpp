// What systems do in their own way, as it is here.
#include "core/system.h"
#include "unit/core/systems.h"

namespace spindrift {
namespace {

TEST(System, WritesAndReplacesFiles) { expectToWriteAndReplaceFiles(); }
TEST(System, NotesSignalsThatAskForAnEnd) { expectToNoteSignals(); }

TEST(System, CutsFilesAndKeepsRightsOfWhatIsReplaced) {
    const Folder folder;
    const std::string file = folder.path / "file";
    os::OutFile out = os::OutFile::create(file);
    EXPECT_TRUE(out.write("whole line", 10) && out.resize(5));
    EXPECT_EQ(textOf(file), "whole");
    os::FileStatus replaced = os::statusOf(file);
    replaced.rights = 0640;
    EXPECT_TRUE(os::finish(file, replaced));
    EXPECT_EQ(os::statusOf(file).rights, 0640u);
}

TEST(System, KnowsTheMachine) {
    EXPECT_GT(os::freeMemory(), int64_t(1) << 24);
    EXPECT_LT(os::freeMemory(), int64_t(1) << 50);
    EXPECT_FALSE(os::processorName().empty());
    EXPECT_GT(os::processId(), 0);
    EXPECT_TRUE(os::isOpenForWriting(os::StandardOutput));
    EXPECT_EQ(os::openNumberOf("/dev/fd/7"), 7);
    EXPECT_EQ(os::openNumberOf("/tmp/7"), -1);
}

}  // namespace
}  // namespace spindrift
