#pragma once
// Draws particles and their surroundings into a framebuffer of its own: a window blits it, headless
// reads it.
#include "core/color_map.h"
#include "core/vec.h"
#include "render/camera.h"
#include "render/color_map.h"
#include "render/fluid_surface.h"
#include "render/framebuffer.h"
#include "render/image.h"
#include "render/legend.h"
#include "render/lines.h"
#include "render/occlusion.h"
#include "render/overlay.h"
#include "render/slice.h"
#include "render/solids.h"
#include "render/vertex_buffer.h"

#include <limits>
#include <optional>
#include <vector>

namespace spindrift {

// Beyond all places and values.
constexpr float nowhere = std::numeric_limits<float>::max();

// One picture. Lengths in m, positions relative to the domain's lower corner.
struct DrawSettings {
    OrbitCamera camera;
    Vec3 domainSize;
    int fluidCount = 0,
        wallCount = 0;  // the buffer's first vertices are fluid, the next ones walls and objects
    bool outline = true, ground = true;
    float diameter = 0.02f;
    float minimumPixels = 0;  // particles are never drawn smaller than this
    bool surface = false;     // of the fluid instead of its particles
    bool fluid = true;        // is drawn at all
    bool flat = false;        // fluid is one layer of particles
    bool plain = false;       // one colour instead of the table
    ColorMap map = ColorMap::Viridis;
    ColorTable ownColors{};  // of ColorMap::File
    std::vector<Swatch>
        swatches;  // instead of the table: each value has the colour of the nearest of them
    float rangeMin = 0, rangeMax = 1;  // values at the ends of the table
    bool logarithmic = false;          // colours between them; both are positive then
    std::optional<LegendText> legend;
    Theme theme = Theme::Dark;
    bool axes = false, scale = false;               // marks at the lower right
    float shownMin = -nowhere, shownMax = nowhere;  // values of fluid that is shown
    Vec3 clipLow{-nowhere, -nowhere, -nowhere},
        clipHigh{nowhere, nowhere, nowhere};  // corners of the box of which fluid is shown
    bool clipSolids = false;                  // and solids
    const SliceField* slice = nullptr;
    float contourStep = 0;  // between lines of one value on it, 0 = none
    std::vector<Arrow> arrows;
    std::vector<std::array<Vec3, 2>> path;  // pieces of it
    std::vector<Ring> rings;
    std::vector<ShapePose> solids;  // of the shapes that are drawn: all of setSolids, or none
};

class Renderer {
public:
    // Needs a current context. Throws Error when a shader is missing or broken.
    Renderer(int width, int height, int samples);
    void resize(int width, int height);
    void setSamples(int samples);
    int width() const { return target_.width(); }
    int height() const { return target_.height(); }

    void setSolids(std::vector<SolidShape> shapes) { solids_.upload(std::move(shapes)); }
    void draw(const VertexBuffer&, const DrawSettings&);

    Image image() const { return target_.image(); }
    // Copies the picture into the window's framebuffer, its lower left corner at (x, y).
    void blit(int x, int y) const { target_.blit(x, y); }
    // What the last picture shows at a pixel (from the upper left); nothing where there's only
    // background.
    std::optional<Vec3> surfaceAt(int x, int y) const;

private:
    void uploadFrame(const DrawSettings&);
    void drawBackground(const DrawSettings&);
    void drawParticles(const VertexBuffer&, const DrawSettings&);
    void drawSpheres(int first, int count, bool second);
    void drawFluidSurface(const DrawSettings&);
    void drawSlice(const DrawSettings&);
    void drawLines(const DrawSettings&);
    void drawSegments(int first, int count);
    void drawText(const DrawSettings&);
    void uploadColors(const DrawSettings&);

    int samples_;  // as asked for; the driver may give fewer
    Framebuffer target_;
    Occlusion occlusion_;
    GlProgram background_, particles_, lines_;
    GlVertexArray empty_, vertices_;
    GlBuffer frame_, segments_;
    GlTexture tables_;
    Overlay overlay_;
    SolidTriangles solids_;
    std::optional<FluidSurface> surface_;              // once it is asked for
    std::optional<SlicePlane> slice_;                  // likewise
    std::array<std::array<float, 2>, 3> axisNames_{};  // px, of the last picture
    OrbitCamera camera_;                               // of the last picture
};

}  // namespace spindrift
