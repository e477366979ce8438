#include "render/renderer.h"

#include "core/error.h"
#include "render/color_map.h"
#include "render/shader.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace spindrift {

namespace {

using Four = std::array<float, 4>;

// std140 twin of the block in shaders/frame.glsl.
struct FrameBlock {
    glm::mat4 view, projection, viewBefore;  // viewBefore: of the picture before
    // Of the picture; right and up reach its edges at distance 1, in an orthographic view at any.
    // Like the domain's size they are given where y is up and the ground's corner is 0, whatever is
    // up in the world.
    Four eye, right, up, forward;
    Four sky;       // the world's up in the camera's axes
    Four picture;   // width, height, samples, line width in px
    Four domain;    // size in m, step of the ground's grid
    Four particle;  // radius in m, smallest in px, px a metre at distance 1, fluids
    Four color;  // lowest value, 1 / span, row of the table; 1 = plain, 2 = plain in two dimensions
    Four clipLow, clipHigh;  // box of which fluid is shown; clipLow[3]: 1 = solids are cut too
    Four look;  // 1 = light, 1 = colours by logarithms, lowest and highest value that is shown
};

constexpr float degree = 3.14159265f / 180;

// The same camera and domain where y is up and the domain's lowest corner is 0.
struct Upright {
    OrbitCamera camera;
    Vec3 size;
    Upright(const OrbitCamera& world, Vec3 worldSize)
        : camera(world), size(world.upright(worldSize)) {
        camera.target = world.upright(world.target);
        camera.upward = {0, 1, 0};
        for (int k = 0; k < 3; ++k) {
            camera.target[k] -= std::min(size[k], 0.0f);
            size[k] = std::abs(size[k]);
        }
    }
};

Four pack(Vec3 v, float w = 0) { return {v.x, v.y, v.z, w}; }

// A round length that divides the floor into about ten cells.
float gridStep(Vec3 size) {
    const float cell = std::max(size.x, size.z) / 10;
    const float power = std::pow(10.0f, std::floor(std::log10(cell)));
    for (float factor : {1.0f, 2.0f, 5.0f})
        if (factor * power >= 0.99f * cell) return factor * power;
    return 10 * power;
}

GlTexture uploadTables() {
    GlTexture texture = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(texture, 1, GL_RGB8, 256, colorMapCount + 2);
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (int map = 0; map < colorMapCount; ++map)
        glTextureSubImage2D(texture, 0, 0, map, 256, 1, GL_RGB, GL_UNSIGNED_BYTE,
                            colorTable(ColorMap(map)).data());
    return texture;
}

}  // namespace

Renderer::Renderer(int width, int height, int samples)
    : samples_(samples),
      target_(width, height, samples),
      background_(loadProgram("background")),
      particles_(loadProgram("particles")),
      lines_(loadProgram("lines")),
      empty_(makeVertexArray()),
      vertices_(makeVertexArray()),
      frame_(makeBuffer()),
      segments_(makeBuffer()),
      tables_(uploadTables()) {
    glNamedBufferStorage(frame_, sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
    glEnableVertexArrayAttrib(vertices_, 0);
    glVertexArrayAttribFormat(vertices_, 0, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertices_, 0, 0);
}

void Renderer::resize(int width, int height) { target_.resize(width, height); }

void Renderer::setSamples(int samples) {
    if (samples == samples_) return;
    target_ = Framebuffer(width(), height(), samples);
    samples_ = samples;
}

void Renderer::draw(const VertexBuffer& vertices, const DrawSettings& settings) {
    CHECK(!vertices.mapped());
    uploadFrame(settings);
    uploadColors(settings);
    camera_ = settings.camera;
    glBindFramebuffer(GL_FRAMEBUFFER, target_.drawing());
    glViewport(0, 0, width(), height());
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glClearDepth(1);
    glClear(GL_DEPTH_BUFFER_BIT);
    drawBackground(settings);
    if (!settings.solids.empty()) solids_.draw(settings.solids);
    if (settings.slice) drawSlice(settings);
    drawParticles(vertices, settings);
    if (settings.surface && settings.fluid) drawFluidSurface(settings);
    drawLines(settings);
    target_.resolve();
    glBindFramebuffer(GL_FRAMEBUFFER, target_.resolved());
    drawText(settings);
    overlay_.flush(width(), height());
}

void Renderer::drawText(const DrawSettings& s) {
    const Ink ink = inkOf(s.theme);
    if (s.legend && !s.swatches.empty())
        drawLegend(overlay_, width(), height(), *s.legend, ink, s.swatches);
    else if (s.legend && !s.plain)
        drawLegend(overlay_, width(), height(), *s.legend, ink,
                   {s.map == ColorMap::File ? s.ownColors : colorTable(s.map), colorMapName(s.map),
                    s.rangeMin, s.rangeMax, s.logarithmic});
    const float unit = unitOf(width(), height());
    overlay_.textSize(14 * unit);
    for (size_t k = 0; k < 3 && s.axes; ++k) {
        const std::string_view name("xyz" + k, 1);
        const auto [x, y] = axisNames_[k];
        overlay_.text(x - 0.5f * overlay_.textWidth(name), y + 4 * unit, name, ink.bright);
    }
    if (!s.scale) return;
    const OrbitCamera& c = s.camera;
    const float metres = 2 * c.distance * std::tan(0.5f * c.fieldOfView * degree) / float(height());
    drawScale(overlay_, width(), height(), ink, metres,
              s.ground ? gridStep(Upright(c, s.domainSize).size) : 0);
}

void Renderer::uploadFrame(const DrawSettings& s) {
    const OrbitCamera& camera = s.camera;
    const Upright upright(camera, s.domainSize);
    const float aspect = float(width()) / float(height());
    const float tangent = std::tan(0.5f * camera.fieldOfView * degree);
    const auto scaled = [&](float value) { return s.logarithmic ? std::log(value) : value; };
    const float low = scaled(s.rangeMin), span = scaled(s.rangeMax) - low;
    const float wide = camera.orthographic ? tangent * camera.distance : tangent;
    const int row = !s.swatches.empty()       ? colorMapCount
                    : s.map == ColorMap::File ? colorMapCount + 1
                                              : int(s.map);
    const FrameBlock block{
        camera.view(),
        camera.projection(aspect),
        camera_.view(),
        pack(upright.camera.eye()),
        pack(wide * aspect * upright.camera.right()),
        pack(wide * upright.camera.up()),
        pack(upright.camera.forward()),
        {0, upright.camera.up().y, -upright.camera.forward().y, 0},
        {float(width()), float(height()), float(target_.samples()), lineWidth(height())},
        pack(upright.size, s.ground ? gridStep(upright.size) : 0),
        {0.5f * s.diameter, 0.5f * s.minimumPixels, 0.5f * float(height()) / wide,
         float(s.fluidCount)},
        {low, span > 0 ? 1 / span : 0, float(row), s.plain ? (s.flat ? 2.0f : 1.0f) : 0.0f},
        pack(s.clipLow, s.clipSolids ? 1 : 0),
        pack(s.clipHigh),
        {s.theme == Theme::Light ? 1.0f : 0.0f, s.logarithmic ? 1.0f : 0.0f, s.shownMin,
         s.shownMax},
    };
    glNamedBufferSubData(frame_, 0, sizeof block, &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_);
}

// What the scene has of its own are rows of the tables, below the maps.
void Renderer::uploadColors(const DrawSettings& s) {
    const auto upload = [&](int row, const ColorTable& colors) {
        glTextureSubImage2D(tables_, 0, 0, row, 256, 1, GL_RGB, GL_UNSIGNED_BYTE, colors.data());
    };
    if (s.map == ColorMap::File) upload(colorMapCount + 1, s.ownColors);
    if (s.swatches.empty()) return;
    ColorTable row;
    for (size_t i = 0; i < row.size(); ++i) {
        const float value = std::lerp(s.rangeMin, s.rangeMax, float(i) / float(row.size() - 1));
        row[i] = std::min_element(s.swatches.begin(), s.swatches.end(),
                                  [&](const Swatch& a, const Swatch& b) {
                                      return std::abs(a.value - value) < std::abs(b.value - value);
                                  })
                     ->color;
    }
    upload(colorMapCount, row);
}

// The ground belongs to the background: seen from above everything stands in front of it.
void Renderer::drawBackground(const DrawSettings&) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glUseProgram(background_);
    glBindVertexArray(empty_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// Those of the picture before that nothing hid, then those of the others that nothing hides now.
void Renderer::drawParticles(const VertexBuffer& vertices, const DrawSettings& s) {
    occlusion_.resize(target_);
    glVertexArrayVertexBuffer(vertices_, 0, vertices.name(), 0, sizeof(Vertex));
    const int first = s.surface || !s.fluid ? s.fluidCount : 0,
              count = s.fluidCount + s.wallCount - first;
    drawSpheres(first, count, false);
    occlusion_.look(target_);
    drawSpheres(first, count, true);
    occlusion_.endPicture();
}

void Renderer::drawSpheres(int first, int count, bool second) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_PROGRAM_POINT_SIZE);
    // Soft edges without blending: the share of covered samples is the edge's opacity.
    if (target_.samples() > 1) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    glUseProgram(particles_);
    glBindTextureUnit(0, tables_);
    occlusion_.bind();
    glUniform1i(0, second);
    glBindVertexArray(vertices_);
    glDrawArrays(GL_POINTS, first, count);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Renderer::drawFluidSurface(const DrawSettings& s) {
    if (!surface_) surface_.emplace();
    surface_->draw(target_, vertices_, s.fluidCount, tables_);
}

void Renderer::drawSlice(const DrawSettings& s) {
    if (!slice_) slice_.emplace();
    slice_->draw(*s.slice, tables_, s.contourStep, target_.samples() > 1);
}

void Renderer::drawLines(const DrawSettings& s) {
    const bool light = s.theme == Theme::Light;
    const Four outline = light ? Four{0.24f, 0.29f, 0.36f, 0.6f} : Four{0.62f, 0.70f, 0.82f, 0.5f},
               edge{0.10f, 0.11f, 0.14f, 0.8f};
    Lines lines(s.camera, width(), height());
    // The fluid's surface reaches a little beyond walls.
    if (s.outline) lines.addBox(s.domainSize, outline, s.surface ? s.diameter : 0);
    for (size_t i = 0; i < s.solids.size(); ++i)
        for (const auto& [from, to] : solids_.shapes()[i].edges) {
            const Vec3 a = s.solids[i].at(from), b = s.solids[i].at(to);
            if (s.clipSolids)
                lines.addEdge(a, b, edge, s.clipLow, s.clipHigh);
            else
                lines.addEdge(a, b, edge);
        }
    if (s.slice) {
        const Vec3 a = s.slice->corner, b = a + s.slice->across, c = b + s.slice->along,
                   d = a + s.slice->along;
        for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
            lines.addEdge(from, to, outline);
    }
    const int hidden = lines.count();
    for (const Arrow& arrow : s.arrows) lines.addArrow(arrow);
    if (s.theme == Theme::Light)
        for (const auto& [from, to] : s.path) lines.addRim(from, to);
    for (const auto& [from, to] : s.path) lines.addMark(from, to);
    for (const Ring& ring : s.rings) lines.addRing(ring);
    if (s.axes) axisNames_ = lines.addAxes();
    if (lines.count() == 0) return;
    glNamedBufferData(segments_, GLsizeiptr(size_t(lines.count()) * sizeof(DrawnLine)),
                      lines.all().data(), GL_STREAM_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, segments_);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glUseProgram(lines_);
    glBindVertexArray(empty_);
    drawSegments(0, hidden);
    // Rings are marks, seen through the fluid.
    glDisable(GL_DEPTH_TEST);
    drawSegments(hidden, lines.count() - hidden);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void Renderer::drawSegments(int first, int count) {
    glUniform1i(0, first);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

std::optional<Vec3> Renderer::surfaceAt(int x, int y) const {
    const float depth = target_.depth(x, y);
    if (depth >= 1) return std::nullopt;
    const float along = camera_.distanceAt(depth);
    return camera_.onPlane(float(x) + 0.5f, float(y) + 0.5f, float(width()), float(height()),
                           camera_.eye() + along * camera_.forward());
}

}  // namespace spindrift
