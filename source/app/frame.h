#pragma once
// The one place that turns a scene and its simulation into a picture; the window and headless share
// it.
#include "app/inside.h"
#include "app/run_range.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "sim/neighbours/line_of_sight.h"
#include "sim/simulation.h"

#include <array>
#include <map>
#include <optional>
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
    // range; not where the run is looked back at, whose range and path are known already.
    void update(Simulation&, const Scene&, bool looksBack = false);
    // Takes note of where the particle of view.path_of is; update() does so too.
    void followPath(Simulation&, const Scene&);
    // A GPU that steps but doesn't draw hands its vertices over by a copy through the host.
    bool copiesVertices() const { return copied_; }
    // Forgets the ranges over the run, the path and the solids: after a reset or another scene.
    void restart() { fresh_ = true, path_.clear(); }

    // Draws what the last update() wrote, and marks over it, relative to the domain's lower corner.
    void draw(const Scene&, std::vector<Ring> rings = {},
              std::vector<std::array<Vec3, 2>> marks = {});
    Image image() const { return renderer_.image(); }
    void blit(int x, int y) const { renderer_.blit(x, y); }
    std::optional<Vec3> surfaceAt(int x, int y) const { return renderer_.surfaceAt(x, y); }

    // Where the fluid is that the last update() wrote and this view shows: within its clip box and
    // its thresholds, m from the domain's lower corner.
    std::vector<Vec3> shownFluid(const Scene&) const;

    // Values at the ends of the colour table, in the unit of the coloured quantity; one value where
    // all have the same, but for round-off.
    Range range(const View&) const;

private:
    Range write(Simulation&, ColorBy);
    void begin(const Scene&);
    void lookInside(Simulation&, const Scene&);
    void setColors(DrawSettings&, const Scene&);
    void setInside(DrawSettings&, const Scene&);
    std::string rangeNote(const View&) const;

    Renderer renderer_;
    VertexBuffer vertices_;
    int fluidCount_ = 0, wallCount_ = 0, objectCount_ = 0;  // in vertices_
    Range seen_{};                                          // of the last update
    std::map<ColorBy, RunRange> run_;  // of all since restart(), by what was shown
    double begin_ = 0, now_ = 0;       // s, the first and the last update's time
    std::vector<ShapePose> solids_;
    std::optional<SliceField> slice_;   // if the last update's view had one
    std::vector<CellVelocity> arrows_;  // likewise
    struct Place {
        double time;  // s
        Vec3 at;
    };
    std::vector<Place> path_;
    int pathOf_ = -1;
    float arrowSpeed_ = 0;                 // m/s, of the longest of them since restart()
    std::optional<LineOfSight> sight_;     // once a slice has been asked for
    std::string colorFile_;                // that ownColors_ are of
    std::optional<ColorTable> ownColors_;  // nothing: it could not be read
    bool fresh_ = true;                    // another run
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
// Whether it is a number, and not one of a few kinds.
bool isNumber(ColorBy);

}  // namespace spindrift
