#pragma once
#include "render/image.h"

namespace spindrift {

struct ImageDifference {
    double ssim = 1;     // structural similarity, 1 = the same; worst of the three colours
    int largest = 0;     // largest difference of a colour of a pixel, 0..255
    int64_t pixels = 0;  // how many pixels differ at all
};

// SSIM after Wang et al. 2004: Gaussian window of 11 x 11, sigma 1.5, averaged over the picture.
// The pictures must have the same size.
ImageDifference compareImages(const Image&, const Image&);

// Absolute differences, stretched so that the largest one is white; black where the pictures are
// the same.
Image differencePicture(const Image&, const Image&);

}  // namespace spindrift
