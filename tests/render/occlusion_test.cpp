// Spheres that are hidden are left out, and no picture shows it.
#include "picture.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace spindrift {
namespace {

constexpr int width = 640, height = 480;
// Pixels in which two spheres may be equally deep to the last bit: there the one that is drawn
// first is seen.
constexpr int ties = 3;

// A block of overlapping spheres, not quite on a lattice, so that no two are equally deep.
std::vector<Vertex> block(float shift = 0) {
    constexpr int n = 40;
    std::vector<Vertex> spheres;
    for (int i = 0; i < n * n * n; ++i) {
        const auto place = [&](int k, int salt) {
            return (float(k) + 0.5f + 0.2f * float((i * salt) % 97) / 97) / n;
        };
        spheres.push_back({place(i % n, 31) + shift, place(i / n % n, 57), place(i / (n * n), 71),
                           float(i % 7) / 7});
    }
    return spheres;
}

DrawSettings settingsOf(float yaw, float pitch) {
    DrawSettings settings = frontView(int(block().size()));
    settings.camera.yaw = yaw, settings.camera.pitch = pitch;
    settings.diameter = 1.4f / 40;
    return settings;
}

Image nextPicture(const std::vector<Vertex>& spheres, const DrawSettings& settings,
                  int samples = 4) {
    return picture(spheres, settings, samples, width, height);
}
// What a renderer draws that has drawn nothing before, which leaves nothing out.
Image firstPicture(const std::vector<Vertex>& spheres, const DrawSettings& settings,
                   int samples = 4) {
    rendererOf(width, height, samples);  // makes the context
    Renderer renderer(width, height, samples);
    return pictureBy(renderer, spheres, settings);
}

TEST(Occlusion, NoPictureShowsWhatTheOneBeforeItWas) {
    for (int samples : {1, 4}) {
        for (float yaw : {20.0f, 23.0f, 200.0f}) {
            const DrawSettings settings = settingsOf(yaw, 25);
            EXPECT_LE(changed(nextPicture(block(), settings, samples),
                              firstPicture(block(), settings, samples), 0),
                      ties)
                << samples << ' ' << yaw;
        }
        // What hid the others is gone, or has moved aside.
        DrawSettings few = settingsOf(200, 25);
        few.fluidCount = 3000;
        EXPECT_LE(
            changed(nextPicture(block(), few, samples), firstPicture(block(), few, samples), 0),
            ties)
            << samples;
        EXPECT_LE(changed(nextPicture(block(0.3f), few, samples),
                          firstPicture(block(0.3f), few, samples), 0),
                  ties)
            << samples;
    }
}

// A few that were hidden come to the front: nothing that was known holds for them.
TEST(Occlusion, WhatComesToTheFrontIsSeen) {
    std::vector<Vertex> spheres = block();
    const DrawSettings settings = settingsOf(0, 0);
    nextPicture(spheres, settings);
    for (int k = 0; k < 30; ++k) spheres[size_t(20 * 1600 + 20 * 40 + k)].z += 1;
    const Image image = nextPicture(spheres, settings);
    EXPECT_LE(changed(image, firstPicture(spheres, settings), 0), ties);
    EXPECT_GT(changed(image, nextPicture(block(), settings)), 300);
}

TEST(Occlusion, LeavesOutMostOfAFullBlock) {
    Renderer& renderer = rendererOf(width, height);
    const auto pixelsLit = [&](const DrawSettings& settings) {
        GLuint query = 0;
        glGenQueries(1, &query);
        glBeginQuery(GL_FRAGMENT_SHADER_INVOCATIONS_ARB, query);
        pictureBy(renderer, block(), settings);
        glEndQuery(GL_FRAGMENT_SHADER_INVOCATIONS_ARB);
        GLuint64 count = 0;
        glGetQueryObjectui64v(query, GL_QUERY_RESULT, &count);
        glDeleteQueries(1, &query);
        return double(count);
    };
    const DrawSettings settings = settingsOf(20, 25);
    DrawSettings empty = settings;
    empty.fluidCount = 0;
    pixelsLit(settings);
    const double known = pixelsLit(settings), none = pixelsLit(empty),
                 unknown = pixelsLit(settings);
    std::printf("fragments without particles %.0f, with %.0f, and %.0f when nothing was known\n",
                none, known, unknown);
    EXPECT_LT(known - none, 0.5 * (unknown - none));
}

}  // namespace
}  // namespace spindrift
