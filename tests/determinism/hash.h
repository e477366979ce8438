#pragma once
// A number that changes with any bit of any particle.
#include "scene/json.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <bit>

namespace spindrift {

inline Scene loadConfig(const std::string& file, const std::vector<std::string>& knobs) {
    Scene scene = loadScene(std::string(SPINDRIFT_SOURCE_DIR) + "/configs/" + file);
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}

// Of places, velocities, densities and pressures (after FNV-1a).
inline uint64_t hashAfter(const Scene& scene, int steps) {
    auto simulation = makeSimulation(scene);
    simulation->step(steps);
    uint64_t hash = 1469598103934665603ull;
    for (const Particle& p : simulation->particles())
        for (const Vec3d& v : {p.position, p.velocity, Vec3d{p.density, p.pressure, 0}})
            for (int k = 0; k < 3; ++k) {
                hash = (hash ^ std::bit_cast<uint64_t>(v[k])) * 1099511628211ull;
                hash ^=
                    hash >> 32;  // a float's low bits are zeros, and products only spread upwards
            }
    return hash;
}

}  // namespace spindrift
