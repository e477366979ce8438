#pragma once
// What is drawn as lines: the box, edges of solids, marks. Lengths in m, relative to the domain's
// lower corner.
#include "core/vec.h"
#include "render/camera.h"

#include <array>
#include <vector>

namespace spindrift {

struct Ring {
    Vec3 center;
    float radius;
    Vec3 color;
};  // m; faces the camera

// A line with a head at its end.
struct Arrow {
    Vec3 from, to;
};

// As the shaders have it.
struct DrawnLine {
    std::array<float, 4> from, to, color;  // from[3]: width in px; color[3]: opacity
};

class Lines {
public:
    // For a picture so many pixels high.
    Lines(const OrbitCamera& camera, int width, int height);

    // `lift`: m, by which it is nearer to the eye than it is.
    void addBox(Vec3 size, std::array<float, 4> color, float lift);
    // An edge between faces, a little nearer to the eye than they are; with corners of a box only
    // what is in there.
    void addEdge(Vec3 from, Vec3 to, std::array<float, 4> color);
    void addEdge(Vec3 from, Vec3 to, std::array<float, 4> color, Vec3 low, Vec3 high);
    void addArrow(const Arrow&);
    // A piece of a path or of a ruler, and what is to be behind it on a light background.
    void addRim(Vec3 from, Vec3 to);
    void addMark(Vec3 from, Vec3 to);
    void addRing(const Ring&);
    // Which way x, y and z are, at the lower right. Returns where their names stand, px from the
    // upper left corner.
    std::array<std::array<float, 2>, 3> addAxes();

    const std::vector<DrawnLine>& all() const { return all_; }
    int count() const { return int(all_.size()); }

private:
    void add(Vec3 from, Vec3 to, float width, std::array<float, 4> color);

    const OrbitCamera& camera_;
    int width_, height_;
    float thick_;  // px
    std::vector<DrawnLine> all_;
};

// px, of lines in a picture so many pixels high.
float lineWidth(int height);
// Grows with the picture, so that what is written on it reads the same at every size and on dense
// screens.
float unitOf(int width, int height);

constexpr std::array<Vec3, 3> axisColors{Vec3{0.90f, 0.30f, 0.26f}, Vec3{0.36f, 0.72f, 0.30f},
                                         Vec3{0.30f, 0.52f, 0.95f}};

}  // namespace spindrift
