#pragma once
// How solids move: prescribed by velocity, by keyframes, or by a CSV that becomes keyframes.
#include "scene/scene.h"

#include <string>

namespace spindrift {

// Reads each solid's `motion` (a path relative to `folder`) into its keyframes, and forgets the
// path: the scene is then whole without the file. Throws Error (Scene); `place` is where the scene
// is from.
void readMotions(Scene&, const std::string& folder, const std::string& place);

// What a solid does as straight lines between times in increasing order: m and radians relative to
// its place in the scene. Before the first and after the last it is at rest.
struct MotionKey {
    double time;
    Vec3d offset;
    double turn;
};
std::vector<MotionKey> motionOf(const Solid&);

std::vector<MotionKey> motionOf(const Grip&);

// The largest speed of any of its points, m/s.
double largestSpeed(const Solid&);
double largestSpeed(const Grip&);

}  // namespace spindrift
