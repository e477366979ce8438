#pragma once
// The one place that turns a scene and its simulation into a picture; the window and headless share
// it.
#include "app/run_range.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "sim/simulation.h"

#include <map>
#include <string>
#include <vector>

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
    // Forgets the ranges over the run and the solids: after a reset or another scene.
    void restart() { fresh_ = true; }

    // Draws what the last update() wrote; `rings` are marks over it, relative to the domain's lower
    // corner.
    void draw(const Scene&, std::vector<Ring> rings = {});
    Image image() const { return renderer_.image(); }
    void blit(int x, int y) const { renderer_.blit(x, y); }
    std::optional<Vec3> surfaceAt(int x, int y) const { return renderer_.surfaceAt(x, y); }

    // Values at the ends of the colour table, in the unit of the coloured quantity; one value where
    // all have the same, but for round-off.
    Range range(const View&) const;

private:
    Range write(Simulation&, ColorBy);
    void begin(const Scene&);
    std::string rangeNote(const View&) const;

    Renderer renderer_;
    VertexBuffer vertices_;
    int fluidCount_ = 0, wallCount_ = 0, objectCount_ = 0;  // in vertices_
    Range seen_{};                                          // of the last update
    std::map<ColorBy, RunRange> run_;  // of all since restart(), by what was shown
    double begin_ = 0;                 // s, the first update's time
    std::vector<ShapePose> solids_;
    bool fresh_ = true;  // another run
    bool copied_ = false;
};

// The scene on the GPU that draws, unless it names one: then a kernel writes what GL shows. Needs a
// current GL context.
Scene onDrawingDevice(Scene);

// The scene's camera for a picture of this shape, relative to the domain's lower corner.
OrbitCamera cameraOf(const Scene&, float aspect);
// Keeps a moved camera in the scene, so that saving the scene saves the view.
void keepCamera(Scene&, const OrbitCamera&);

// The fluids of the scene, of different densities, in rising order: names and colours by which they
// are told apart.
std::vector<Swatch> fluidsOf(const Scene&);

// How a quantity is named on the legend.
struct Quantity {
    const char* name;
    const char* unit;
};
Quantity quantity(ColorBy);

}  // namespace spindrift
