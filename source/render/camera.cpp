#include "render/camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace spindrift {

namespace {
constexpr float degree = 3.14159265f / 180;
glm::vec3 toGlm(Vec3 v) { return {v.x, v.y, v.z}; }
}  // namespace

Vec3 OrbitCamera::turned(Vec3 v) const {
    const Vec3 u = upward;
    if (u.z != 0) return {v.x, -u.z * v.z, u.z * v.y};
    return {u.y * v.x + u.x * v.y, u.y * v.y - u.x * v.x, v.z};
}
Vec3 OrbitCamera::upright(Vec3 v) const {
    const Vec3 u = upward;
    if (u.z != 0) return {v.x, u.z * v.z, -u.z * v.y};
    return {u.y * v.x - u.x * v.y, u.y * v.y + u.x * v.x, v.z};
}

Vec3 OrbitCamera::forward() const {
    const float cosPitch = std::cos(pitch * degree);
    return turned({-cosPitch * std::sin(yaw * degree), -std::sin(pitch * degree),
                   -cosPitch * std::cos(yaw * degree)});
}
Vec3 OrbitCamera::right() const {
    return turned({std::cos(yaw * degree), 0, -std::sin(yaw * degree)});
}
Vec3 OrbitCamera::up() const { return cross(right(), forward()); }
Vec3 OrbitCamera::eye() const { return target - (orthographic ? depth : distance) * forward(); }
Vec3 OrbitCamera::toEye(Vec3 at) const { return orthographic ? -depth * forward() : eye() - at; }

glm::mat4 OrbitCamera::view() const {
    return glm::lookAt(toGlm(eye()), toGlm(target), toGlm(up()));
}

glm::mat4 OrbitCamera::projection(float aspect) const {
    if (!orthographic)
        return glm::perspective(fieldOfView * degree, aspect, nearPlane(), farPlane());
    const float half = distance * std::tan(0.5f * fieldOfView * degree);
    return glm::ortho(-half * aspect, half * aspect, -half, half, nearPlane(), farPlane());
}

float OrbitCamera::distanceAt(float depth) const {
    const float n = nearPlane(), f = farPlane();
    return orthographic ? std::lerp(n, f, depth) : 2 * f * n / (f + n - (2 * depth - 1) * (f - n));
}

Ray OrbitCamera::ray(float x, float y, float width, float height) const {
    const float tangent = std::tan(0.5f * fieldOfView * degree);
    const float u = (2 * x / width - 1) * tangent * width / height;
    const float v = (1 - 2 * y / height) * tangent;
    if (orthographic) return {eye() + distance * (u * right() + v * up()), forward()};
    return {eye(), normalized(forward() + u * right() + v * up())};
}

Vec3 OrbitCamera::onPlane(float x, float y, float width, float height, Vec3 point) const {
    const Ray r = ray(x, y, width, height);
    const float along = dot(point - r.origin, forward()) / dot(r.direction, forward());
    return r.origin + along * r.direction;
}

void OrbitCamera::orbit(float degreesRight, float degreesUp) {
    yaw = std::remainder(yaw + degreesRight, 360.0f);
    pitch = std::clamp(pitch + degreesUp, -89.0f, 89.0f);
}

void OrbitCamera::lookFrom(Vec3 direction) {
    const Vec3 d = upright(direction);
    pitch = std::asin(std::clamp(d.y, -1.0f, 1.0f)) / degree;
    // A plan's edges are upright and level.
    yaw = std::abs(d.y) < 0.999f ? std::atan2(d.x, d.z) / degree : 90 * std::round(yaw / 90);
}

void OrbitCamera::pan(float dx, float dy, float height) {
    const float metresPerPixel = 2 * distance * std::tan(0.5f * fieldOfView * degree) / height;
    target = target - (dx * metresPerPixel) * right() + (dy * metresPerPixel) * up();
}

void OrbitCamera::zoom(float factor, Vec3 anchor) {
    target = anchor + factor * (target - anchor);
    distance *= factor;
}

float fitDistance(const OrbitCamera& camera, Vec3 size, float aspect) {
    const float tangent = std::tan(0.5f * camera.fieldOfView * degree);
    constexpr float margin = 1.2f;
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{(corner & 1 ? 0.5f : -0.5f) * size.x, (corner & 2 ? 0.5f : -0.5f) * size.y,
                     (corner & 4 ? 0.5f : -0.5f) * size.z};
        const float across =
            std::max(std::abs(dot(p, camera.right())) / aspect, std::abs(dot(p, camera.up())));
        distance = std::max(distance, margin * across / tangent -
                                          (camera.orthographic ? 0 : dot(p, camera.forward())));
    }
    return distance;
}

}  // namespace spindrift
