#include "scene/facet.h"

#include <array>
#include <optional>

namespace spindrift {
namespace {

struct Stretch {
    double low = 1e300, high = -1e300;
};
using Heights = std::array<double, 3>;

// Of the corners of t above the plane of u, 0 where they are within the tolerance.
Heights heightsOf(const Facet& t, const Facet& u, double tolerance) {
    Heights h;
    for (size_t k = 0; k < 3; ++k) {
        h[k] = u.height(t.corner[k]);
        if (std::abs(h[k]) <= tolerance) h[k] = 0;
    }
    return h;
}
bool isOnOneSide(const Heights& h) {
    return (h[0] > 0 && h[1] > 0 && h[2] > 0) || (h[0] < 0 && h[1] < 0 && h[2] < 0);
}
bool isOnBothSides(const Heights& h) {
    return std::min({h[0], h[1], h[2]}) < 0 && std::max({h[0], h[1], h[2]}) > 0;
}

// What t has in common with the plane above which its corners have these heights, along a
// direction.
Stretch stretchOf(const Facet& t, const Heights& h, Vec3d direction) {
    Stretch s;
    const auto add = [&](Vec3d p) {
        s.low = std::min(s.low, dot(p, direction)), s.high = std::max(s.high, dot(p, direction));
    };
    for (size_t k = 0; k < 3; ++k) {
        const size_t next = (k + 1) % 3;
        if (h[k] == 0) add(t.corner[k]);
        if (h[k] * h[next] < 0)
            add(t.corner[k] + (h[k] / (h[k] - h[next])) * (t.corner[next] - t.corner[k]));
    }
    return s;
}

Vec3d inward(const Facet& t, int side) {
    return normalized(cross(t.normal, t.corner[(side + 1) % 3] - t.corner[side]));
}

// What of a segment in the plane of t lies in t, if that is longer than the tolerance.
std::optional<Segment> clipped(Segment s, const Facet& t, double tolerance) {
    for (int k = 0; k < 3; ++k) {
        const Vec3d n = inward(t, k);
        const double a = dot(n, s.from - t.corner[k]), b = dot(n, s.to - t.corner[k]);
        if (a <= tolerance && b <= tolerance) return {};
        const Vec3d at = s.from + (a / (a - b)) * (s.to - s.from);
        if (a < 0) s.from = at;
        if (b < 0) s.to = at;
    }
    if (length(s.to - s.from) <= tolerance) return {};
    return s;
}

Meeting meetInPlane(const Facet& t, const Facet& u, double tolerance, std::vector<Segment>& cuts) {
    bool touch = false;
    for (const auto& [one, other] : {std::pair(&t, &u), std::pair(&u, &t)})
        for (int k = 0; k < 3; ++k) {
            double most = -1e300;
            for (const Vec3d& p : other->corner)
                most = std::max(most, dot(inward(*one, k), p - one->corner[k]));
            if (most < -tolerance) return Meeting::None;
            touch |= most <= tolerance;
        }
    if (touch) return Meeting::Touch;
    for (int k = 0; k < 3; ++k)
        if (const auto part = clipped({u.corner[k], u.corner[(k + 1) % 3]}, t, tolerance))
            cuts.push_back(*part);
    return Meeting::Cover;
}

using Polygon = std::vector<Vec3d>;

// The parts of a polygon below and above a line through `at`.
std::array<Polygon, 2> halves(const Polygon& polygon, Vec3d at, Vec3d up, double tolerance) {
    std::array<Polygon, 2> parts;
    const auto height = [&](Vec3d p) { return dot(up, p - at); };
    for (size_t k = 0; k < polygon.size(); ++k) {
        const Vec3d p = polygon[k], q = polygon[(k + 1) % polygon.size()];
        const double a = height(p), b = height(q);
        if (a <= tolerance) parts[0].push_back(p);
        if (a >= -tolerance) parts[1].push_back(p);
        const bool passes = (a < -tolerance && b > tolerance) || (a > tolerance && b < -tolerance);
        for (size_t side = 0; side < 2 && passes; ++side)
            parts[side].push_back(p + (a / (a - b)) * (q - p));
    }
    return parts;
}

void divide(const Polygon& polygon, std::vector<Segment> cuts, Vec3d normal, double tolerance,
            std::vector<Polygon>& out) {
    if (polygon.size() < 3) return;
    if (cuts.empty()) return out.push_back(polygon);
    const Segment cut = cuts[cuts.size() / 2];
    const Vec3d up = normalized(cross(normal, cut.to - cut.from));
    std::array<std::vector<Segment>, 2> rest;
    for (const Segment& s : cuts) {
        const double a = dot(up, s.from - cut.from), b = dot(up, s.to - cut.from);
        const Vec3d at = s.from + (a / (a - b)) * (s.to - s.from);
        const bool parts = a * b < 0;
        if (std::min(a, b) < -tolerance)
            rest[0].push_back({parts && a > 0 ? at : s.from, parts && b > 0 ? at : s.to});
        if (std::max(a, b) > tolerance)
            rest[1].push_back({parts && a < 0 ? at : s.from, parts && b < 0 ? at : s.to});
    }
    cuts = {};
    const std::array<Polygon, 2> parts = halves(polygon, cut.from, up, tolerance);
    for (size_t side = 0; side < 2; ++side)
        divide(parts[side], std::move(rest[side]), normal, tolerance, out);
}

}  // namespace

Facet::Facet(Vec3d a, Vec3d b, Vec3d c) : corner{a, b, c} {
    const Vec3d n = cross(b - a, c - a);
    const double twice = length(n);
    normal = twice > 0 ? (1 / twice) * n : Vec3d{};
}

Box Facet::box() const {
    return {lower(lower(corner[0], corner[1]), corner[2]),
            upper(upper(corner[0], corner[1]), corner[2])};
}

bool Facet::covers(Vec3d p, double tolerance) const {
    for (int k = 0; k < 3; ++k)
        if (dot(inward(*this, k), p - corner[k]) < -tolerance) return false;
    return true;
}

// Above the triangle that is p's own image, otherwise it lies on an edge that p is beyond.
Vec3d Facet::nearest(Vec3d p) const {
    Vec3d best;
    double least = 1e300;
    const bool flat = dot(normal, normal) > 0;
    for (int k = 0; k < 3; ++k) {
        const Vec3d a = corner[k], along = corner[(k + 1) % 3] - a, from = p - a;
        if (flat && dot(cross(along, normal), from) <= 0) continue;
        const double whole = dot(along, along),
                     share = whole > 0 ? std::clamp(dot(from, along) / whole, 0.0, 1.0) : 0.0;
        const Vec3d at = share < 1 ? a + share * along : corner[(k + 1) % 3];
        if (const double d2 = dot(p - at, p - at); d2 < least) least = d2, best = at;
    }
    return least < 1e300 ? best : p - height(p) * normal;
}

Meeting meet(const Facet& t, const Facet& u, double tolerance, std::vector<Segment>& cuts) {
    if (dot(t.normal, t.normal) == 0 || dot(u.normal, u.normal) == 0) return Meeting::None;
    const Heights ofT = heightsOf(t, u, tolerance);
    if (isOnOneSide(ofT)) return Meeting::None;
    const Heights ofU = heightsOf(u, t, tolerance);
    if (isOnOneSide(ofU)) return Meeting::None;
    const bool inPlane = ofT == Heights{} || ofU == Heights{};
    const Vec3d across = cross(t.normal, u.normal);
    if (inPlane || length(across) == 0) return meetInPlane(t, u, tolerance, cuts);
    const Vec3d along = normalized(across);
    const Stretch a = stretchOf(t, ofT, along), b = stretchOf(u, ofU, along);
    const double low = std::max(a.low, b.low), high = std::min(a.high, b.high);
    if (high - low < -tolerance) return Meeting::None;
    if (high - low <= tolerance || !isOnBothSides(ofT)) return Meeting::Touch;
    // From the point of the line in both planes that is nearest to a corner.
    const double cosine = dot(t.normal, u.normal),
                 away = dot(u.normal, u.corner[0] - t.corner[0]) / (1 - cosine * cosine);
    const Vec3d foot = t.corner[0] + (-away * cosine) * t.normal + away * u.normal;
    const Vec3d at = foot - dot(foot, along) * along;
    cuts.push_back({at + low * along, at + high * along});
    return Meeting::Cross;
}

std::vector<std::vector<Vec3d>> cutUp(const Facet& t, const std::vector<Segment>& cuts,
                                      double tolerance) {
    std::vector<Polygon> out;
    divide({t.corner[0], t.corner[1], t.corner[2]}, cuts, t.normal, tolerance, out);
    return out;
}

}  // namespace spindrift
