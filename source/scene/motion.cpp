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
        Keyframe key{value("t", i), offset, turn, rates};
        if (rates) key.velocity = row(i), key.spin = value("turn", i);
        keyframes.push_back(key);
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
            throw Error(error.failure,
                        fmt::format("{}: solids[{}].motion: {}", place, i, error.what()));
        }
        solid.motion.clear();
    }
}

namespace {

// One component of a motion between its keys: cubic polynomials.
struct Curve {
    std::vector<double> rate, second, third;  // at the beginning of each stretch
};

// Jumps of velocity at neighbouring keys, for the time between them, that are samples of one smooth
// change: corners of a way on straight lines stand alone, or turn elsewhere.
bool alike(double a, double b) {
    return std::abs(a - b) < 0.75 * std::max(std::abs(a), std::abs(b));
}

// Velocities on both sides of each key, of values without given ones.
void guessRates(const std::vector<double>& time, const std::vector<double>& value,
                std::vector<double>& before, std::vector<double>& after) {
    const size_t n = time.size();
    auto slope = [&](size_t k) { return (value[k + 1] - value[k]) / (time[k + 1] - time[k]); };
    auto bend = [&](size_t k) {
        return 2 * (slope(k) - slope(k - 1)) / (time[k + 1] - time[k - 1]);
    };
    std::vector<bool> smooth(n, false);
    for (size_t k = 1; k + 1 < n; ++k)
        smooth[k] =
            (k > 1 && alike(bend(k), bend(k - 1))) || (k + 2 < n && alike(bend(k), bend(k + 1)));
    for (size_t k = 1; k + 1 < n; ++k) {  // of the parabola through three keys
        const double left = time[k] - time[k - 1], right = time[k + 1] - time[k];
        before[k] = after[k] = (right * slope(k - 1) + left * slope(k)) / (left + right);
    }
    // At a corner without a third derivative, and straight between two of them.
    for (size_t k = 0; k + 1 < n; ++k) {
        if (!smooth[k]) after[k] = smooth[k + 1] ? 2 * slope(k) - before[k + 1] : slope(k);
        if (!smooth[k + 1]) before[k + 1] = smooth[k] ? 2 * slope(k) - after[k] : slope(k);
    }
}

Curve curveThrough(const Keyframes& keys, const std::vector<double>& value,
                   const std::vector<double>& rate) {
    const size_t n = keys.size();
    std::vector<double> time, before = rate, after = rate;
    for (const Keyframe& k : keys) time.push_back(k.time);
    if (!keys[0].hasRates) guessRates(time, value, before, after);
    Curve c{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
    for (size_t k = 0; k + 1 < n; ++k) {
        const double h = time[k + 1] - time[k], s = (value[k + 1] - value[k]) / h;
        c.rate[k] = after[k];
        c.second[k] = (6 * s - 4 * after[k] - 2 * before[k + 1]) / h;
        c.third[k] = (6 * after[k] + 6 * before[k + 1] - 12 * s) / (h * h);
    }
    return c;
}

std::vector<MotionKey> curvesOf(const Keyframes& keyframes) {
    auto curve = [&](auto value, auto rate) {
        std::vector<double> values, rates;
        for (const Keyframe& k : keyframes) values.push_back(value(k)), rates.push_back(rate(k));
        return curveThrough(keyframes, values, rates);
    };
    const Curve x = curve([](auto&k) { return k.offset.x; }, [](auto&k) { return k.velocity.x; }),
                y = curve([](auto&k) { return k.offset.y; }, [](auto&k) { return k.velocity.y; }),
                z = curve([](auto&k) { return k.offset.z; }, [](auto&k) { return k.velocity.z; }),
                turn = curve([](auto&k) { return k.turn * PerDegree; },
                             [](auto&k) { return k.spin * PerDegree; });
    std::vector<MotionKey> keys;
    for (size_t k = 0; k < keyframes.size(); ++k)
        keys.push_back({keyframes[k].time,
                        keyframes[k].offset,
                        {x.rate[k], y.rate[k], z.rate[k]},
                        {x.second[k], y.second[k], z.second[k]},
                        {x.third[k], y.third[k], z.third[k]},
                        keyframes[k].turn * PerDegree,
                        turn.rate[k],
                        turn.second[k],
                        turn.third[k]});
    return keys;
}

// On and on with velocity and spin where there are no keyframes.
std::vector<MotionKey> keysOf(const Keyframes& keyframes, Vec3 velocity, double spin) {
    if (!keyframes.empty()) return curvesOf(keyframes);
    return {{0, {}, toDouble(velocity), {}, {}, 0, spin * PerDegree, 0, 0}};
}

// Of a stretch: no faster than the corners of Bezier's polygon of its velocity.
double fastest(const std::vector<MotionKey>& keys, double reach) {
    double most = 0;
    for (size_t k = 0; k < keys.size(); ++k) {
        const MotionKey& m = keys[k];
        const double h = k + 1 < keys.size() ? keys[k + 1].time - m.time : 0;
        const Vec3d middle = m.velocity + (h / 2) * m.acceleration,
                    end = m.velocity + h * m.acceleration + (h * h / 2) * m.jerk;
        const double turning = m.spin + h / 2 * m.spinRate,
                     turned = m.spin + h * m.spinRate + h * h / 2 * m.spinJerk;
        most = std::max({most, length(m.velocity) + reach * std::abs(m.spin),
                         length(middle) + reach * std::abs(turning),
                         length(end) + reach * std::abs(turned)});
    }
    return most;
}

}  // namespace

std::vector<MotionKey> motionOf(const Solid& solid) {
    std::vector<MotionKey> keys = keysOf(solid.keyframes, solid.velocity, solid.spin);
    for (MotionKey& key : keys) key.turn += double(solid.turn) * PerDegree;
    return keys;
}
std::vector<MotionKey> motionOf(const Grip& grip) {
    return keysOf(grip.keyframes, grip.velocity, 0);
}

double largestSpeed(const Solid& solid) { return fastest(motionOf(solid), reachOf(solid)); }
double largestSpeed(const Grip& grip) { return fastest(motionOf(grip), 0); }

}  // namespace spindrift
