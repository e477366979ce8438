#include "scene/sources.h"

#include "core/error.h"
#include "core/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

namespace spindrift {
namespace {

// Along the normal, across it, and along the height.
struct Axes {
    Vec3d normal, across, up;
};
Axes axesOf(const Scene& scene, const Source& source) {
    const Vec3d given = toDouble(source.normal), n = (1 / length(given)) * given;
    if (scene.simulation.dimensions == 2) return {n, {-n.y, n.x, 0}, {0, 0, 1}};
    const Vec3d towards = std::abs(n.z) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    const Vec3d slanted = towards - dot(towards, n) * n, up = (1 / length(slanted)) * slanted;
    return {n, cross(up, n), up};
}

// Middles of n cells that fill a width.
double placeIn(int i, int n, double width) { return ((i + 0.5) / n - 0.5) * width; }

void addRectangle(const Scene& scene, const Source& source, const Axes& axes, SourceLattice& out) {
    const double dx = scene.simulation.spacing, width = source.width;
    const bool flat = scene.simulation.dimensions == 2;
    const double height = flat ? 1 : source.height;
    const int n = std::max(1, int(std::lround(width / dx))),
              rows = flat ? 1 : std::max(1, int(std::lround(height / dx)));
    for (int r = 0; r < rows; ++r)
        for (int i = 0; i < n; ++i) {
            const double x = placeIn(i, n, width), y = flat ? 0 : placeIn(r, rows, height),
                         bent = 1 - 4 * x * x / (width * width);
            out.points.push_back(
                {x * axes.across + y * axes.up, source.profile == Profile::Parabolic ? bent : 1});
        }
    out.area = width * height;
}

// On a square lattice with a point in the middle or around it, whichever has the better area.
void addDisc(const Scene& scene, const Source& source, const Axes& axes, SourceLattice& out) {
    const double dx = scene.simulation.spacing, radius = source.radius;
    out.area = std::numbers::pi * radius * radius;
    std::vector<SourceLattice::Point> best;
    for (const double shift : {0.0, 0.5}) {
        std::vector<SourceLattice::Point> points;
        const int most = int(std::ceil(radius / dx)) + 1;
        for (int k = -most; k <= most; ++k)
            for (int i = -most; i <= most; ++i) {
                const double x = (i + shift) * dx, y = (k + shift) * dx,
                             bent = 1 - (x * x + y * y) / (radius * radius);
                if (bent <= 0) continue;
                points.push_back({x * axes.across + y * axes.up,
                                  source.profile == Profile::Parabolic ? bent : 1});
            }
        const auto error = [&](const auto& some) {
            return std::abs(double(some.size()) * dx * dx - out.area);
        };
        if (!points.empty() && (best.empty() || error(points) < error(best))) best = points;
    }
    out.points = best;
}

// Mean velocities, as asked for and before it is opened and closed.
Rates velocitiesOf(const Scene& scene, const Source& source) {
    if (!source.velocities.empty()) return source.velocities;
    if (source.velocity > 0) return {{source.start, source.velocity}};
    const double area = latticeOf(scene, source).area;
    Rates out = source.flows.empty() ? Rates{{source.start, source.flow}} : source.flows;
    for (Rate& rate : out) rate.value /= area;
    return out;
}

// s after a key, at which it has gone on by so much, m.
double timeFor(const SourceKey& key, double way) {
    if (key.slope == 0) return way / key.speed;
    const double root = std::sqrt(std::max(key.speed * key.speed + 2 * key.slope * way, 0.0));
    return 2 * way / (key.speed + root);
}

// Closes it when it has given its volume.
void closeAt(double way, std::vector<SourceKey>& keys) {
    for (size_t k = 0; k < keys.size(); ++k) {
        const bool last = k + 1 == keys.size();
        if (last ? keys[k].speed <= 0 : keys[k + 1].way < way) continue;
        const double time = keys[k].time + timeFor(keys[k], way - keys[k].way);
        keys.resize(k + 1);
        keys.push_back({time, way, 0, 0});
        return;
    }
}

}  // namespace

std::vector<Body> fluidsOf(const Fluid& fluid) {
    return fluid.bodies.empty() ? std::vector<Body>{Body{}} : fluid.bodies;
}

std::string nameOf(const Scene& scene, const Source& source) {
    return source.name.empty() ? fmt::format("sources[{}]", &source - scene.sources.data())
                               : source.name;
}

double SourceLattice::largestShare() const {
    double most = 0;
    for (const Point& p : points) most = std::max(most, p.share);
    return most;
}

SourceLattice latticeOf(const Scene& scene, const Source& source) {
    SourceLattice out;
    const Axes axes = axesOf(scene, source);
    out.normal = axes.normal, out.across = axes.across, out.up = axes.up;
    source.mouth == Mouth::Rectangle ? addRectangle(scene, source, axes, out)
                                     : addDisc(scene, source, axes, out);
    double all = 0;
    for (const SourceLattice::Point& p : out.points) all += p.share;
    for (SourceLattice::Point& p : out.points) {
        p.share *= double(out.points.size()) / all;
        p.at = p.at + toDouble(source.center);
        if (scene.simulation.dimensions == 2)
            p.at.z = 0.5 * (double(scene.domain.min.z) + double(scene.domain.max.z));
    }
    out.apart = particleVolume(scene) * double(out.points.size()) / out.area;
    out.layers = int(std::ceil(double(supportRadius(scene)) / out.apart - 1e-6));
    return out;
}

void readRates(Scene& scene, const std::string& folder, const std::string& place) {
    const char* unit = scene.simulation.dimensions == 2 ? "m²/s" : "m³/s";
    for (Source& source : scene.sources) {
        if (source.path.empty()) continue;
        const std::string path = (std::filesystem::path(folder) / source.path).string();
        try {
            const Table table =
                readStrictTable(path, {{"t", "s", true}, {"velocity", "m/s"}, {"flow", unit}});
            if (table.has("velocity") == table.has("flow"))
                throw Error(Failure::Scene,
                            path + ": needs one column of velocity and flow, beside t");
            Rates& rates = table.has("flow") ? source.flows : source.velocities;
            source.velocities.clear(), source.flows.clear();
            for (size_t i = 0; i < table.rows(); ++i)
                rates.push_back(
                    {table.at("t")[i], table.at(table.has("flow") ? "flow" : "velocity")[i]});
        } catch (const Error& error) {
            throw Error(error.failure, fmt::format("{}: sources[{}].path: {}", place,
                                                   &source - scene.sources.data(), error.what()));
        }
        source.path.clear();
    }
}

void requireOneOfRatesAndFile(const Scene& scene, const std::string& place) {
    for (const Source& source : scene.sources)
        if (!source.path.empty() && !(source.velocities.empty() && source.flows.empty()))
            throw Error(Failure::Scene,
                        fmt::format("{}: sources[{}] says more than once how much it gives; keep "
                                    "one of velocity, flow, velocities, flows and path",
                                    place, &source - scene.sources.data()));
}

std::vector<SourceKey> scheduleOf(const Scene& scene, const Source& source) {
    const auto rows = velocitiesOf(scene, source);
    const double end = source.stop > 0 ? double(source.stop) : 1e300;
    auto speedAt = [&](double t) {
        if (t <= rows.front().time) return rows.front().value;
        for (size_t i = 1; i < rows.size(); ++i)
            if (t < rows[i].time) {
                const auto [t0, v0] = rows[i - 1];
                const auto [t1, v1] = rows[i];
                return v0 + (v1 - v0) * (t - t0) / (t1 - t0);
            }
        return rows.back().value;
    };
    std::vector<double> times = {source.start};
    for (const auto& [t, v] : rows)
        if (t > source.start && t < end) times.push_back(t);
    std::vector<SourceKey> keys;
    double way = 0;
    for (size_t i = 0; i < times.size(); ++i) {
        const bool last = i + 1 == times.size();
        const double next = last ? end : times[i + 1], speed = speedAt(times[i]),
                     slope = (speedAt(next) - speed) / (next - times[i]);
        keys.push_back({times[i], way, speed, slope});
        way += (speed + slope * (next - times[i]) / 2) * (next - times[i]);
    }
    if (source.stop > 0) keys.push_back({end, way, 0, 0});
    if (source.volume > 0) closeAt(source.volume / latticeOf(scene, source).area, keys);
    return keys;
}

double wayAt(const std::vector<SourceKey>& keys, double time) {
    double way = 0;
    for (const SourceKey& k : keys)
        if (const double s = time - k.time; s >= 0) way = k.way + (k.speed + k.slope * s / 2) * s;
    return way;
}

double largestSpeed(const Scene& scene, const Source& source) {
    double most = 0;
    for (const Rate& rate : velocitiesOf(scene, source)) most = std::max(most, rate.value);
    return most * latticeOf(scene, source).largestShare();
}

int64_t particlesInMouth(const Scene& scene, const Source& source) {
    const SourceLattice lattice = latticeOf(scene, source);
    return int64_t(lattice.points.size()) * lattice.layers;
}

void fillMouths(const Scene& scene, Placement& out) {
    if (scene.sources.empty()) return;
    out.heldBy.resize(out.positions.size(), 0);
    int point = 0;
    for (const Source& source : scene.sources) {
        const SourceLattice lattice = latticeOf(scene, source);
        const std::vector<SourceKey> keys = scheduleOf(scene, source);
        const double speed = keys[0].time <= 0 ? keys[0].speed : 0;
        for (const SourceLattice::Point& p : lattice.points) {
            ++point;
            for (int layer = 0; layer < lattice.layers; ++layer) {
                const Vec3d at = p.at - (layer + 0.5) * lattice.apart * lattice.normal;
                out.positions.push_back(toFloat(at - toDouble(scene.domain.min)));
                out.velocities.push_back(toFloat((speed * p.share) * lattice.normal));
                out.pressures.push_back(0);
                out.bodies.push_back(0);
                out.heldBy.push_back(point);
            }
        }
    }
}

MouthRoom::MouthRoom(const Scene& scene) {
    const double margin = 0.49 * scene.simulation.spacing;
    for (const Source& source : scene.sources) {
        const SourceLattice lattice = latticeOf(scene, source);
        const Axes axes = axesOf(scene, source);
        const bool round = source.mouth == Mouth::Disc;
        const double width = round ? double(source.radius) : source.width / 2.0,
                     height = scene.simulation.dimensions == 2 ? 1e30
                              : round                          ? double(source.radius)
                                                               : source.height / 2.0;
        const Vec3d middle = toDouble(source.center) - toDouble(scene.domain.min) -
                             (lattice.depth() / 2) * lattice.normal;
        rooms_.push_back(
            {middle,
             {axes.normal, axes.across, axes.up},
             {lattice.depth() / 2 - 1e-6 * lattice.apart, width + margin, height + margin},
             round});
    }
}

bool MouthRoom::takes(Vec3d place) const {
    return std::any_of(rooms_.begin(), rooms_.end(), [&](const Room& room) {
        const Vec3d arm = place - room.middle;
        double at[3];
        for (int k = 0; k < 3; ++k) at[k] = std::abs(dot(arm, room.axis[k]));
        if (room.round && std::hypot(at[1], at[2]) > room.half.y) return false;
        return at[0] < room.half.x && at[1] < room.half.y && at[2] < room.half.z;
    });
}

int64_t mostFluid(const Scene& scene, int64_t count) {
    if (!comesAndGoes(scene)) return count;
    const Vec3d size = scene.domain.size();
    const double space = size.x * size.y * (scene.simulation.dimensions == 2 ? 1 : size.z);
    double all = double(count), mouths = 0;
    for (const Source& source : scene.sources) {
        const SourceLattice lattice = latticeOf(scene, source);
        const std::vector<SourceKey> keys = scheduleOf(scene, source);
        const double end = scene.output.time > 0 ? double(scene.output.time) : 1e30,
                     way = wayAt(keys, end);
        all += (way / lattice.apart + lattice.largestShare() + 1) * double(lattice.points.size());
        mouths += double(lattice.points.size() * size_t(lattice.layers + 1));
    }
    // Fluid that is pressed together is denser by a few per cent at most.
    const double room = 1.02 * space / particleVolume(scene) + mouths;
    return int64_t(std::max(double(count), std::min(all, room)));
}

}  // namespace spindrift
