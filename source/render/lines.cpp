#include "render/lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {

namespace {

using Four = std::array<float, 4>;

constexpr float degree = 3.14159265f / 180;

Four pack(Vec3 v, float w) { return {v.x, v.y, v.z, w}; }

// Leaves of a line what is in a box (Liang & Barsky 1984); false: nothing.
bool clip(Vec3& from, Vec3& to, Vec3 low, Vec3 high) {
    const Vec3 way = to - from;
    float begin = 0, end = 1;
    for (int k = 0; k < 3; ++k) {
        if (way[k] == 0) {
            if (from[k] < low[k] || from[k] > high[k]) return false;
            continue;
        }
        const float a = (low[k] - from[k]) / way[k], b = (high[k] - from[k]) / way[k];
        begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    }
    if (begin >= end) return false;
    to = from + end * way, from = from + begin * way;
    return true;
}

}  // namespace

float lineWidth(int height) { return std::clamp(float(height) / 700, 1.0f, 5.0f); }

float unitOf(int width, int height) {
    return std::clamp(std::min(float(height) / 760, float(width) / 760), 0.9f, 4.0f);
}

Lines::Lines(const OrbitCamera& camera, int width, int height)
    : camera_(camera), width_(width), height_(height), thick_(lineWidth(height)) {}

void Lines::add(Vec3 from, Vec3 to, float width, Four color) {
    all_.push_back({pack(from, width), pack(to, 0), color});
}

void Lines::addBox(Vec3 size, Four color, float lift) {
    const auto lifted = [&](Vec3 at) {
        const Vec3 way = camera_.toEye(at);
        return at + (lift / length(way)) * way;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 from;
            from[(axis + 1) % 3] = corner & 1 ? size[(axis + 1) % 3] : 0;
            from[(axis + 2) % 3] = corner & 2 ? size[(axis + 2) % 3] : 0;
            Vec3 to = from;
            to[axis] = size[axis];
            add(lifted(from), lifted(to), thick_, color);
        }
}

void Lines::addEdge(Vec3 from, Vec3 to, Four color) {
    const auto lifted = [&](Vec3 at) { return at + 0.002f * camera_.toEye(at); };
    add(lifted(from), lifted(to), thick_, color);
}
void Lines::addEdge(Vec3 from, Vec3 to, Four color, Vec3 low, Vec3 high) {
    if (clip(from, to, low, high)) addEdge(from, to, color);
}

void Lines::addArrow(const Arrow& arrow) {
    const Vec3 way = arrow.to - arrow.from, eye = camera_.toEye(arrow.to), aside = cross(way, eye);
    if (!(length(aside) > 0)) return;
    const Vec3 wing = (0.15f * length(way) / length(aside)) * aside, neck = arrow.to - 0.3f * way;
    // Bright with a dark rim: to be seen on any colour.
    for (const auto& [width, color] :
         {std::pair{3.2f, Four{0.05f, 0.06f, 0.08f, 0.9f}}, {1.4f, Four{1.0f, 1.0f, 1.0f, 1.0f}}})
        for (const Vec3 from : {arrow.from, neck + wing, neck - wing})
            add(from, arrow.to, width * thick_, color);
}

void Lines::addRim(Vec3 from, Vec3 to) {
    add(from, to, 3.6f * thick_, {0.05f, 0.06f, 0.08f, 0.9f});
}
void Lines::addMark(Vec3 from, Vec3 to) { add(from, to, 2 * thick_, {1.0f, 0.80f, 0.30f, 1}); }

void Lines::addRing(const Ring& ring) {
    constexpr int corners = 64;
    const auto point = [&](int i) {
        const float angle = 360.0f * float(i) / corners * degree;
        return ring.center +
               ring.radius * (std::cos(angle) * camera_.right() + std::sin(angle) * camera_.up());
    };
    for (int i = 0; i < corners; ++i)
        add(point(i), point(i + 1), 2 * thick_, pack(ring.color, 0.9f));
}

std::array<std::array<float, 2>, 3> Lines::addAxes() {
    const float unit = unitOf(width_, height_), reach = 34 * unit, x = float(width_) - 62 * unit,
                y = float(height_) - 62 * unit;
    // A plane that faces the camera.
    const auto at = [&](float right, float up) {
        return camera_.onPlane(x + right, y - up, float(width_), float(height_), camera_.target);
    };
    std::array<std::array<float, 2>, 3> names;
    std::array<int, 3> order{0, 1, 2};
    const auto nearness = [&](int axis) { return -camera_.forward()[axis]; };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return nearness(a) < nearness(b); });
    for (const int axis : order) {
        const float right = reach * camera_.right()[axis], up = reach * camera_.up()[axis];
        add(at(0, 0), at(right, up), 2.2f * unit, pack(axisColors[size_t(axis)], 1));
        const float length = std::hypot(right, up), more = length > 0 ? 11 * unit / length : 0;
        names[size_t(axis)] = {x + (1 + more) * right, y - (1 + more) * up};
    }
    return names;
}

}  // namespace spindrift
