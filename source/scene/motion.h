#pragma once
// How solids move: prescribed by velocity, by keyframes, or by a CSV that becomes keyframes.
#include "scene/scene.h"

#include <string>

namespace spindrift {

// Reads each solid's `motion` (a path relative to `folder`) into its keyframes, and forgets the
// path: the scene is then whole without the file. Throws Error (Scene); `place` is where the scene
// is from.
void readMotions(Scene&, const std::string& folder, const std::string& place);

// What a solid does from one time on until the next key's, s later: it is at offset + velocity s +
// acceleration s^2 / 2 + jerk s^3 / 6, and turned likewise; m and radians relative to its place in
// the scene. Before the first key it rests there.
struct MotionKey {
    double time;
    Vec3d offset, velocity, acceleration, jerk;
    double turn, spin, spinRate, spinJerk;
};
// Keyframes are joined by straight lines, on which nothing accelerates but for an instant at their
// ends. Where the velocity changes alike from key to key the lines are samples of a smooth motion
// instead, and a smooth curve goes through them, so that the fluid can feel its acceleration. Where
// keyframes say how fast the solid is, curves (Hermite's) have those velocities.
std::vector<MotionKey> motionOf(const Solid&);

std::vector<MotionKey> motionOf(const Grip&);

// The largest speed of any of its points, m/s.
double largestSpeed(const Solid&);
double largestSpeed(const Grip&);

}  // namespace spindrift
