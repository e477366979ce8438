#include "render/renderer.h"

#include "core/error.h"
#include "render/color_map.h"
#include "render/shader.h"

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace {

using Four = std::array<float, 4>;

// std140 twin of the block in shaders/frame.glsl.
struct FrameBlock {
    glm::mat4 view, projection, viewBefore;  // viewBefore: of the picture before
    // Of the picture; right and up reach its edges at distance 1. Like the domain's size they are
    // given where y is up and the ground's corner is 0, whatever is up in the world.
    Four eye, right, up, forward;
    Four sky;       // the world's up in the camera's axes
    Four picture;   // width, height, samples, line width in px
    Four domain;    // size in m, step of the ground's grid
    Four particle;  // radius in m, smallest in px, px a metre at distance 1, fluids
    Four color;  // lowest value, 1 / span, row of the table; 1 = plain, 2 = plain in two dimensions
};

struct Segment {
    Four from, to, color;  // from[3]: width in px
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

float lineWidth(int height) { return std::clamp(float(height) / 700, 1.0f, 5.0f); }

// `lift`: m, by which lines are nearer to the eye than they are.
void addBox(std::vector<Segment>& lines, Vec3 size, float width, Four color, Vec3 eye, float lift) {
    const auto lifted = [&](Vec3 at) { return at + (lift / length(eye - at)) * (eye - at); };
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 from;
            from[(axis + 1) % 3] = corner & 1 ? size[(axis + 1) % 3] : 0;
            from[(axis + 2) % 3] = corner & 2 ? size[(axis + 2) % 3] : 0;
            Vec3 to = from;
            to[axis] = size[axis];
            lines.push_back({pack(lifted(from), width), pack(lifted(to)), color});
        }
}

void addRing(std::vector<Segment>& lines, const Ring& ring, const OrbitCamera& camera,
             float width) {
    constexpr int corners = 64;
    const auto point = [&](int i) {
        const float angle = 360.0f * float(i) / corners * degree;
        return ring.center +
               ring.radius * (std::cos(angle) * camera.right() + std::sin(angle) * camera.up());
    };
    for (int i = 0; i < corners; ++i)
        lines.push_back({pack(point(i), 2 * width), pack(point(i + 1)), pack(ring.color, 0.9f)});
}

GlTexture uploadTables() {
    GlTexture texture = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(texture, 1, GL_RGB8, 256, colorMapCount + 1);
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
    uploadSwatches(settings);
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
    drawParticles(vertices, settings);
    if (settings.surface) drawFluidSurface(settings);
    drawLines(settings);
    target_.resolve();
    glBindFramebuffer(GL_FRAMEBUFFER, target_.resolved());
    if (settings.legend && !settings.swatches.empty())
        drawLegend(overlay_, width(), height(), *settings.legend, settings.swatches);
    else if (settings.legend && !settings.plain)
        drawLegend(overlay_, width(), height(), *settings.legend, settings.map, settings.rangeMin,
                   settings.rangeMax);
    overlay_.flush(width(), height());
}

void Renderer::uploadFrame(const DrawSettings& s) {
    const OrbitCamera& camera = s.camera;
    const Upright upright(camera, s.domainSize);
    const float aspect = float(width()) / float(height());
    const float tangent = std::tan(0.5f * camera.fieldOfView * degree);
    const float span = s.rangeMax - s.rangeMin;
    const FrameBlock block{
        camera.view(),
        camera.projection(aspect),
        camera_.view(),
        pack(upright.camera.eye()),
        pack(tangent * aspect * upright.camera.right()),
        pack(tangent * upright.camera.up()),
        pack(upright.camera.forward()),
        {0, upright.camera.up().y, -upright.camera.forward().y, 0},
        {float(width()), float(height()), float(target_.samples()), lineWidth(height())},
        pack(upright.size, s.ground ? gridStep(upright.size) : 0),
        {0.5f * s.diameter, 0.5f * s.minimumPixels, 0.5f * float(height()) / tangent,
         float(s.fluidCount)},
        {s.rangeMin, span > 0 ? 1 / span : 0,
         s.swatches.empty() ? float(s.map) : float(colorMapCount),
         s.plain ? (s.flat ? 2.0f : 1.0f) : 0.0f},
    };
    glNamedBufferSubData(frame_, 0, sizeof block, &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_);
}

// They are a row of the tables, below the maps.
void Renderer::uploadSwatches(const DrawSettings& s) {
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
    glTextureSubImage2D(tables_, 0, 0, colorMapCount, 256, 1, GL_RGB, GL_UNSIGNED_BYTE, row.data());
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
    const int first = s.surface ? s.fluidCount : 0, count = s.fluidCount + s.wallCount - first;
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

void Renderer::drawLines(const DrawSettings& s) {
    std::vector<Segment> lines;
    const float width = lineWidth(height());
    // The fluid's surface reaches a little beyond walls.
    if (s.outline)
        addBox(lines, s.domainSize, width, {0.62f, 0.70f, 0.82f, 0.5f}, s.camera.eye(),
               s.surface ? s.diameter : 0);
    for (size_t i = 0; i < s.solids.size(); ++i)
        for (const auto& [from, to] : solids_.shapes()[i].edges) {
            // A little nearer to the eye than the faces that meet there.
            const auto lifted = [&](Vec3 own) {
                const Vec3 at = s.solids[i].at(own);
                return at + 0.002f * (s.camera.eye() - at);
            };
            lines.push_back(
                {pack(lifted(from), width), pack(lifted(to)), {0.10f, 0.11f, 0.14f, 0.8f}});
        }
    const auto edges = GLsizei(lines.size());
    for (const Ring& ring : s.rings) addRing(lines, ring, s.camera, width);
    if (lines.empty()) return;
    glNamedBufferData(segments_, GLsizeiptr(lines.size() * sizeof(Segment)), lines.data(),
                      GL_STREAM_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, segments_);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glUseProgram(lines_);
    glBindVertexArray(empty_);
    glUniform1i(0, 0);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, edges);
    // Rings are marks, seen through the fluid.
    glDisable(GL_DEPTH_TEST);
    glUniform1i(0, edges);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(lines.size()) - edges);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

std::optional<Vec3> Renderer::surfaceAt(int x, int y) const {
    const float depth = target_.depth(x, y);
    if (depth >= 1) return std::nullopt;
    const float n = camera_.nearPlane(), f = camera_.farPlane();
    const float along = 2 * f * n / (f + n - (2 * depth - 1) * (f - n));
    return camera_.onPlane(float(x) + 0.5f, float(y) + 0.5f, float(width()), float(height()),
                           camera_.eye() + along * camera_.forward());
}

}  // namespace spindrift
