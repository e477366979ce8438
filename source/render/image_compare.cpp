#include "render/image_compare.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace spindrift {
namespace {

using Plane = std::vector<double>;
constexpr int Radius = 5;  // of the window

std::array<double, 2 * Radius + 1> gaussian() {
    std::array<double, 2 * Radius + 1> weights{};
    for (int i = -Radius; i <= Radius; ++i)
        weights[size_t(i + Radius)] = std::exp(-i * i / (2 * 1.5 * 1.5));
    return weights;
}

// Weighted mean along one direction; beyond the border there is nothing, and the weights there
// count for nothing.
Plane blurAlong(const Plane& in, int count, int lines, int step, int lineStep) {
    static const auto weights = gaussian();
    Plane out(in.size());
    for (int line = 0; line < lines; ++line)
        for (int i = 0; i < count; ++i) {
            double sum = 0, total = 0;
            for (int k = std::max(-Radius, -i); k <= std::min(Radius, count - 1 - i); ++k) {
                const double weight = weights[size_t(k + Radius)];
                sum += weight * in[size_t(line) * lineStep + size_t(i + k) * step];
                total += weight;
            }
            out[size_t(line) * lineStep + size_t(i) * step] = sum / total;
        }
    return out;
}

Plane blur(const Plane& in, int width, int height) {
    return blurAlong(blurAlong(in, width, height, 1, width), height, width, width, 1);
}

Plane product(const Plane& a, const Plane& b) {
    Plane out(a.size());
    for (size_t i = 0; i < a.size(); ++i) out[i] = a[i] * b[i];
    return out;
}

Plane channel(const Image& image, size_t c) {
    Plane plane(image.rgb.size() / 3);
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = image.rgb[3 * i + c];
    return plane;
}

double meanSsim(const Plane& a, const Plane& b, int width, int height) {
    constexpr double C1 = 0.01 * 255 * 0.01 * 255, C2 = 0.03 * 255 * 0.03 * 255;
    const Plane meanA = blur(a, width, height), meanB = blur(b, width, height);
    const Plane aa = blur(product(a, a), width, height), bb = blur(product(b, b), width, height);
    const Plane ab = blur(product(a, b), width, height);
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double mA = meanA[i], mB = meanB[i];
        const double varA = aa[i] - mA * mA, varB = bb[i] - mB * mB, covariance = ab[i] - mA * mB;
        sum += (2 * mA * mB + C1) * (2 * covariance + C2) /
               ((mA * mA + mB * mB + C1) * (varA + varB + C2));
    }
    return sum / double(a.size());
}

}  // namespace

ImageDifference compareImages(const Image& a, const Image& b) {
    CHECK(a.width == b.width && a.height == b.height && !a.rgb.empty());
    ImageDifference difference;
    for (size_t i = 0; i < a.rgb.size(); i += 3) {
        int largest = 0;
        for (size_t c = i; c < i + 3; ++c)
            largest = std::max(largest, std::abs(int(a.rgb[c]) - int(b.rgb[c])));
        difference.largest = std::max(difference.largest, largest);
        difference.pixels += largest > 0;
    }
    if (difference.pixels == 0) return difference;
    for (size_t c = 0; c < 3; ++c)
        difference.ssim =
            std::min(difference.ssim, meanSsim(channel(a, c), channel(b, c), a.width, a.height));
    return difference;
}

Image differencePicture(const Image& a, const Image& b) {
    const int largest = std::max(1, compareImages(a, b).largest);
    Image picture = a;
    for (size_t i = 0; i < a.rgb.size(); ++i)
        picture.rgb[i] = uint8_t(std::abs(int(a.rgb[i]) - int(b.rgb[i])) * 255 / largest);
    return picture;
}

}  // namespace spindrift
