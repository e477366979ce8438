#pragma once
// The one place that turns a scene and its simulation into a picture; the window and headless share
// it.
#include "render/renderer.h"
#include "scene/scene.h"
#include "sim/simulation.h"

namespace spindrift {

class Frame {
public:
    // Needs a current GL context (EglContext or the window's).
    Frame(int width, int height, int samples);
    void resize(int width, int height) { renderer_.resize(width, height); }
    void setSamples(int samples) { renderer_.setSamples(samples); }
    int width() const { return renderer_.width(); }
    int height() const { return renderer_.height(); }

    // Lets the simulation write the vertices that this scene's view asks for, and follows their
    // range.
    void update(Simulation&, const Scene&);
    // A GPU that steps but doesn't draw hands its vertices over by a copy through the host.
    bool copiesVertices() const { return copied_; }
    // Forgets the range over the run: after a reset or another scene.
    void restartRange() { fresh_ = true; }

    // Draws what the last update() wrote; `rings` are marks over it, relative to the domain's lower
    // corner.
    void draw(const Scene&, std::vector<Ring> rings = {});
    Image image() const { return renderer_.image(); }
    void blit(int x, int y) const { renderer_.blit(x, y); }
    std::optional<Vec3> surfaceAt(int x, int y) const { return renderer_.surfaceAt(x, y); }

    // Values at the ends of the colour table, in the unit of the coloured quantity.
    Range range(const View&) const;

private:
    Range write(Simulation&, ColorBy);

    Renderer renderer_;
    VertexBuffer vertices_;
    int fluidCount_ = 0, wallCount_ = 0, objectCount_ = 0;  // in vertices_
    ColorBy writtenBy_ = ColorBy::Plain;
    Range seen_{}, run_{};  // of the last update; of all since restartRange() by this quantity
    bool fresh_ = true;     // no range yet
    bool copied_ = false;
};

// The scene on the GPU that draws, unless it names one: then a kernel writes what GL shows. Needs a current GL context.
Scene onDrawingDevice(Scene);

// The scene's camera for a picture of this shape, relative to the domain's lower corner.
OrbitCamera cameraOf(const Scene&, float aspect);
// Keeps a moved camera in the scene, so that saving the scene saves the view.
void keepCamera(Scene&, const OrbitCamera&);

// How a quantity is named on the legend.
struct Quantity {
    const char* name;
    const char* unit;
};
Quantity quantity(ColorBy);

}  // namespace spindrift
