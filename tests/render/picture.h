#pragma once
// Pictures for the snapshot tests: a few spheres, one off-screen context.
#include "render/egl_context.h"
#include "render/renderer.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace spindrift {

// The settings that most tests start from: a cube of 1 m seen from the front.
inline DrawSettings frontView(int count) {
    DrawSettings settings;
    settings.camera = {{0.5f, 0.5f, 0.5f}, 0, 0, 3, 40};
    settings.domainSize = {1, 1, 1};
    settings.fluidCount = count;
    settings.diameter = 0.2f;
    settings.ground = settings.outline = false;
    return settings;
}

inline Renderer& rendererOf(int width, int height, int samples = 4) {
    static EglContext context;
    static Renderer smooth(width, height, 4), plain(width, height, 1);
    Renderer& renderer = samples > 1 ? smooth : plain;
    renderer.resize(width, height);
    return renderer;
}

inline Image pictureBy(Renderer& renderer, const std::vector<Vertex>& vertices,
                       const DrawSettings& settings) {
    VertexBuffer buffer;
    buffer.resize(int(vertices.size()));
    std::copy(vertices.begin(), vertices.end(), buffer.map().data);
    buffer.unmap();
    renderer.draw(buffer, settings);
    return renderer.image();
}

inline Image picture(const std::vector<Vertex>& vertices, const DrawSettings& settings,
                     int samples = 4, int width = 320, int height = 240) {
    return pictureBy(rendererOf(width, height, samples), vertices, settings);
}

struct Rgb {
    int r, g, b;
};
inline Rgb pixel(const Image& image, int x, int y) {
    const uint8_t* p = &image.rgb[(size_t(y) * image.width + x) * 3];
    return {p[0], p[1], p[2]};
}

// Number of pixels whose largest difference of a channel is above `tolerance`.
inline int changed(const Image& a, const Image& b, int tolerance = 8) {
    int count = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3) {
        int largest = 0;
        for (size_t k = i; k < i + 3; ++k)
            largest = std::max(largest, std::abs(a.rgb[k] - b.rgb[k]));
        count += largest > tolerance;
    }
    return count;
}

}  // namespace spindrift
