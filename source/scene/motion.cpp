#include "scene/motion.h"

#include "core/error.h"
#include "core/table.h"
#include "scene/convex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace spindrift {
namespace {

constexpr double PerDegree = std::numbers::pi / 180;
// Longer than any run, s.
constexpr double Forever = 1e9;

Keyframes readKeyframes(const std::string& path) {
    const std::vector<std::string> columns = columnsOf(path);
    const bool rates = std::find(columns.begin(), columns.end(), "vx") != columns.end();
    const std::vector<std::string> names = rates ? std::vector<std::string>{"vx", "vy", "vz"}
                                                 : std::vector<std::string>{"x", "y", "z"};
    const std::string per = rates ? "/s" : "";
    const Table table = readStrictTable(path, {{"t", "s", true},
                                               {names[0], "m" + per, true},
                                               {names[1], "m" + per, true},
                                               {names[2], "m" + per, true},
                                               {"turn", "degrees" + per}});
    auto value = [&](const std::string& name, size_t row) {
        return table.has(name) ? table.at(name)[row] : 0.0;
    };
    auto row = [&](size_t i) {
        return Vec3d{value(names[0], i), value(names[1], i), value(names[2], i)};
    };
    Keyframes keyframes;
    Vec3d offset;
    double turn = 0;
    for (size_t i = 0; i < table.rows(); ++i) {
        if (!rates) {
            offset = row(i), turn = value("turn", i);
        } else if (i > 0) {  // velocities in m/s and degrees/s, by trapezoids
            const double half = (value("t", i) - value("t", i - 1)) / 2;
            offset = offset + half * (row(i - 1) + row(i));
            turn += half * (value("turn", i - 1) + value("turn", i));
        }
        keyframes.push_back({float(value("t", i)), toFloat(offset), float(turn)});
    }
    return keyframes;
}

}  // namespace

void readMotions(Scene& scene, const std::string& folder, const std::string& place) {
    for (size_t i = 0; i < scene.solids.size(); ++i) {
        Solid& solid = scene.solids[i];
        if (solid.motion.empty()) continue;
        try {
            solid.keyframes =
                readKeyframes((std::filesystem::path(folder) / solid.motion).string());
        } catch (const Error& error) {
            throw Error(error.exit,
                        fmt::format("{}: solids[{}].motion: {}", place, i, error.what()));
        }
        solid.motion.clear();
    }
}

namespace {

// On and on with velocity and spin where there are no keyframes; `moves`: at all.
std::vector<MotionKey> keysOf(const Keyframes& keyframes, bool moves, Vec3 velocity, double spin) {
    std::vector<MotionKey> keys;
    for (const Keyframe& k : keyframes)
        keys.push_back({k.time, toDouble(k.offset), k.turn * PerDegree});
    if (keys.empty()) {
        keys.push_back({0, {}, 0});
        if (moves)
            keys.push_back({Forever, Forever * toDouble(velocity), Forever * spin * PerDegree});
    }
    return keys;
}

double fastest(const std::vector<MotionKey>& keys, double reach) {
    double most = 0;
    for (size_t k = 1; k < keys.size(); ++k) {
        const double time = std::max(keys[k].time - keys[k - 1].time, 1e-9);
        most = std::max(most, (length(keys[k].offset - keys[k - 1].offset) +
                               reach * std::abs(keys[k].turn - keys[k - 1].turn)) /
                                  time);
    }
    return most;
}

}  // namespace

std::vector<MotionKey> motionOf(const Solid& solid) {
    return keysOf(solid.keyframes, solid.moves(), solid.velocity, solid.spin);
}
std::vector<MotionKey> motionOf(const Grip& grip) {
    return keysOf(grip.keyframes, grip.velocity != Vec3{}, grip.velocity, 0);
}

double largestSpeed(const Solid& solid) { return fastest(motionOf(solid), reachOf(solid)); }
double largestSpeed(const Grip& grip) { return fastest(motionOf(grip), 0); }

}  // namespace spindrift
