#pragma once
// A camera that orbits a target. Lengths in m, angles in degrees.
#include "core/vec.h"

#include <glm/mat4x4.hpp>

namespace spindrift {

struct Ray {
    Vec3 origin, direction;
};  // direction has length 1

struct OrbitCamera {
    Vec3 target;
    float yaw = 35, pitch = 20;
    float distance = 3;
    float fieldOfView = 40;  // vertical
    Vec3 upward{0, 1, 0};    // the axis, or its opposite, that is up
    // Nothing gets smaller with distance: all that is nearer to the target than `depth`, m, along
    // the view is seen, and as large as what is at the target is in perspective.
    bool orthographic = false;
    float depth = 0;

    // From the axes in which y is up and a camera of yaw and pitch 0 looks along -z to the world's,
    // and back: turned about z, or about x where z is up, so that two dimensions are seen face on.
    Vec3 turned(Vec3) const;
    Vec3 upright(Vec3) const;

    Vec3 eye() const;
    Vec3 forward() const;  // unit vectors of the picture: into it, to its right, up
    Vec3 right() const;
    Vec3 up() const;

    glm::mat4 view() const;
    // Near and far follow the distance, so that a close look doesn't cut the picture.
    glm::mat4 projection(float aspect) const;
    float nearPlane() const { return orthographic ? 0 : 0.01f * distance; }
    float farPlane() const { return orthographic ? 2 * depth : 100 * distance; }
    // From the eye's plane, m, of what has this depth, 0 to 1, in a picture.
    float distanceAt(float depth) const;
    // From a point to the eye, m.
    Vec3 toEye(Vec3 at) const;

    // A pixel's ray; (0, 0) is the upper left corner of a picture of width x height.
    Ray ray(float x, float y, float width, float height) const;
    // Where that ray meets the plane through `point` that faces the camera.
    Vec3 onPlane(float x, float y, float width, float height, Vec3 point) const;

    void orbit(float degreesRight, float degreesUp);
    // Turns until it looks against this direction, of length 1.
    void lookFrom(Vec3 direction);
    // Moves the target with the picture: a drag by (dx, dy) pixels in a picture `height` pixels
    // tall.
    void pan(float dx, float dy, float height);
    // Shrinks the distance to `factor` of it; `anchor` keeps its place in the picture.
    void zoom(float factor, Vec3 anchor);
};

// The distance from which a box of this size, seen around its centre, fills the picture.
float fitDistance(const OrbitCamera&, Vec3 size, float aspect);

}  // namespace spindrift
