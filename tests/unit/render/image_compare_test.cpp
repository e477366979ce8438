#include "render/image_compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace spindrift {
namespace {

Image noise(int width, int height) {
    std::mt19937 random(7);
    Image image{width, height, std::vector<uint8_t>(size_t(width) * height * 3)};
    for (uint8_t& c : image.rgb) c = uint8_t(random() % 256);
    return image;
}

Image shade(int value) { return {40, 30, std::vector<uint8_t>(40 * 30 * 3, uint8_t(value))}; }

TEST(ImageCompare, TheSamePictureIsTheSame) {
    const Image image = noise(50, 40);
    const ImageDifference d = compareImages(image, image);
    EXPECT_EQ(d.ssim, 1);
    EXPECT_EQ(d.largest, 0);
    EXPECT_EQ(d.pixels, 0);
}

TEST(ImageCompare, FlatPicturesFollowTheFormula) {
    // Without variance SSIM is (2 a b + C1) / (a^2 + b^2 + C1), C1 = 2.55^2.
    const double expected = (2 * 100.0 * 150 + 6.5025) / (100.0 * 100 + 150.0 * 150 + 6.5025);
    const ImageDifference d = compareImages(shade(100), shade(150));
    EXPECT_NEAR(d.ssim, expected, 1e-9);
    EXPECT_EQ(d.largest, 50);
    EXPECT_EQ(d.pixels, 1200);
}

TEST(ImageCompare, UnrelatedAndInvertedPicturesAreFarApart) {
    const Image image = noise(64, 64);
    Image inverted = image, other = image;
    for (uint8_t& c : inverted.rgb) c = uint8_t(255 - c);
    std::rotate(other.rgb.begin(), other.rgb.begin() + 1001, other.rgb.end());
    EXPECT_LT(compareImages(image, inverted).ssim, -0.5);
    EXPECT_LT(std::abs(compareImages(image, other).ssim), 0.1);
}

TEST(ImageCompare, OneColourAloneCounts) {
    Image image = noise(64, 64), changed = image;
    for (size_t i = 2; i < changed.rgb.size(); i += 3)
        changed.rgb[i] = uint8_t(255 - changed.rgb[i]);
    EXPECT_LT(compareImages(image, changed).ssim, 0);
}

TEST(ImageCompare, DifferencePictureIsStretched) {
    Image a = shade(10), b = a;
    b.rgb[3] = 12;
    b.rgb[4] = 11;
    const Image d = differencePicture(a, b);
    EXPECT_EQ(d.rgb[3], 255);
    EXPECT_EQ(d.rgb[4], 127);
    EXPECT_EQ(std::count(d.rgb.begin(), d.rgb.end(), 0), 40 * 30 * 3 - 2);
}

}  // namespace
}  // namespace spindrift
