// The program where there is no display, and where there is no OpenGL either.
#include "render/image.h"
#include "shell.h"

namespace spindrift {
namespace {

class NoDisplay : public Shell {};

// The command line of a plain start; nothing in it speaks of pictures or of running without a
// window.
const std::string Start = "test/ball_drop_small --steps 5 --size 160x120 ";
// As if no driver for OpenGL were installed.
const char* const NoVendor = "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent";

TEST_F(NoDisplay, RendersOffScreenSavesAPictureAndSaysSo) {
    const Outcome outcome = call(Start);
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    for (const std::string& words :
         {std::string("rendering off screen, to spindrift.png"), std::string("particles      "),
          std::string("steps          5"), std::string("density error"),
          "picture        " + (folder_ / "spindrift.png").string()})
        EXPECT_NE(outcome.text.find(words), std::string::npos) << words << "\nin: " << outcome.text;
    const Image image = readPng((folder_ / "spindrift.png").string());
    EXPECT_EQ(image.width, 160);
    EXPECT_EQ(image.height, 120);
    EXPECT_NE(*std::max_element(image.rgb.begin(), image.rgb.end()),
              *std::min_element(image.rgb.begin(), image.rgb.end()));
    EXPECT_EQ(files(), std::vector<std::string>{"spindrift.png"});
}

TEST_F(NoDisplay, KeepsTheNameOfThePictureThatWasAskedFor) {
    const Outcome outcome = call(Start + "--screenshot mine.png");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(files(), std::vector<std::string>{"mine.png"});
}

// /proc takes no files from anyone, root included.
TEST_F(NoDisplay, AFolderThatCannotBeWrittenIsAMistake) {
    expectMistake(Start + "--headless --screenshot /proc/a.png", Exit::Output,
                  "/proc/a.png: can't be written");
    where_ = "/proc";
    const Outcome outcome = call(Start);
    EXPECT_EQ(outcome.code, int(Exit::Output)) << outcome.text;
    EXPECT_NE(outcome.text.find("spindrift.png: can't be written"), std::string::npos)
        << outcome.text;
}

TEST_F(NoDisplay, WithoutOpenGlItIsOneLineAndNoPicture) {
    environment_ = NoVendor;
    expectMistake(Start + "--headless --screenshot a.png", Exit::NoDisplay,
                  "no off-screen OpenGL 4.5 through EGL: install libegl-mesa0");
    EXPECT_TRUE(files().empty()) << files().front();
    EXPECT_EQ(call(Start).code, int(Exit::NoDisplay));
}

TEST_F(NoDisplay, WithoutOpenGlASeriesIsStillComputed) {
    environment_ = NoVendor;
    const Outcome outcome = call(Start + "--headless --csv run.csv");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(files(), std::vector<std::string>{"run.csv"});
}

TEST_F(NoDisplay, AnotherPlatformOfEglDoesNotMatter) {
    environment_ = "EGL_PLATFORM=wayland";
    const Outcome outcome = call(Start + "--headless --screenshot a.png");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
}

}  // namespace
}  // namespace spindrift
