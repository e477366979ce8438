#include "measure/probes.h"

#include "core/error.h"
#include "scene/convex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {
namespace {

constexpr const char* AxisNames[] = {"x", "y", "z"};

bool flat(const Scene& scene, int axis) { return scene.simulation.dimensions == 2 && axis == 2; }

// The place in the particles' layer in two dimensions.
Vec3d placed(const Scene& scene, Vec3d at) {
    if (flat(scene, 2)) at.z = 0.5 * (double(scene.domain.min.z) + double(scene.domain.max.z));
    return at;
}

// The axis across the wall that a sensor is in, -1 for one in the fluid.
int faceOf(const Scene& scene, Vec3d at) {
    const double near = 1e-3 * scene.simulation.spacing;
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        const double low = scene.domain.min[k], high = scene.domain.max[k];
        if (!scene.domain.periodic(k) &&
            (std::abs(at[k] - low) < near || std::abs(at[k] - high) < near))
            return k;
    }
    return -1;
}

// Midpoints of 3 x 3 (x 3) cells of the square or cube around a sensor, those in its disc or ball
// and in the domain.
std::vector<Vec3d> sensor(const Scene& scene, Vec3d at, double radius) {
    if (radius == 0) return {at};
    std::vector<Vec3d> points;
    const int across = faceOf(scene, at);
    auto most = [&](int k) { return k == across || flat(scene, k) ? 0 : 1; };
    auto inside = [&](Vec3d p) {
        for (int k = 0; k < 3; ++k)
            if (most(k) && !scene.domain.periodic(k) &&
                (p[k] < scene.domain.min[k] || p[k] > scene.domain.max[k]))
                return false;
        return true;
    };
    for (int z = -most(2); z <= most(2); ++z)
        for (int y = -most(1); y <= most(1); ++y)
            for (int x = -most(0); x <= most(0); ++x) {
                const Vec3d offset = (2 * radius / 3) * Vec3d{double(x), double(y), double(z)};
                if (length(offset) <= radius && inside(at + offset)) points.push_back(at + offset);
            }
    return points;
}

// Of a line; of a gauge, four a spacing along its axis; of a point the sensor's middle.
std::vector<Vec3d> pointsOf(const Scene& scene, const Probe& probe) {
    std::vector<Vec3d> points;
    if (probe.kind == ProbeKind::Point) points = {placed(scene, toDouble(probe.position))};
    if (probe.kind == ProbeKind::Line) {
        const Vec3d from = toDouble(probe.from), way = toDouble(probe.to) - from;
        for (int k = 0; k < probe.count; ++k)
            points.push_back(placed(scene, from + (double(k) / (probe.count - 1)) * way));
    }
    if (probe.kind == ProbeKind::Height) {
        const int axis = int(probe.axis);
        const double low = scene.domain.min[axis], high = scene.domain.max[axis];
        const double fine = 4 / double(scene.simulation.spacing);
        const int count = std::max(int(std::ceil(fine * (high - low))), 1);
        for (int i = 0; i <= count; ++i) {
            Vec3d at = placed(scene, toDouble(probe.position));
            at[axis] = low + (high - low) * i / count;
            points.push_back(at);
        }
    }
    return points;
}

// m, 0 along axes that are not periodic.
Vec3d periodOf(const Scene& scene) {
    Vec3d period{0, 0, 0};
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        if (scene.domain.periodic(k)) period[k] = scene.domain.size()[k];
    return period;
}
Vec3d nearestArm(Vec3d arm, Vec3d period) {
    for (int k = 0; k < 3; ++k)
        if (period[k] > 0) arm[k] = std::remainder(arm[k], period[k]);
    return arm;
}
Vec3d inAxes(const SolidPose& pose, Vec3d a) {
    return {dot(a, pose.axis[0]), dot(a, pose.axis[1]), dot(a, pose.axis[2])};
}

// Solids where they are now.
class SolidsNow {
public:
    SolidsNow(const Scene& scene, std::vector<SolidPose> poses)
        : scene_(scene), poses_(std::move(poses)) {
        for (const Solid& solid : scene.solids)
            shapes_.push_back(convexOf(solid, scene.simulation.dimensions));
    }
    // The one that a point lies in, deeper than rounding, or -1.
    int over(Vec3d point) const {
        const double deep = 1e-3 * scene_.simulation.spacing;
        for (size_t s = 0; s < shapes_.size(); ++s)
            if (shapes_[s].nearest(ownPlace(point, poses_[s])).distance < -deep) return int(s);
        return -1;
    }

private:
    Vec3d ownPlace(Vec3d point, const SolidPose& pose) const {
        return inAxes(
            pose, nearestArm(point - toDouble(scene_.domain.min) - pose.middle, periodOf(scene_)));
    }

    const Scene& scene_;
    std::vector<SolidPose> poses_;
    std::vector<Convex> shapes_;
};

// output.probes[0] (wall)
std::string named(const char* list, size_t index, const std::string& name) {
    return fmt::format("{}[{}]{}", list, index, name.empty() ? "" : " (" + name + ")");
}

Fields mean(const Fields* f, size_t count) {
    Fields sum;
    const double share = 1 / double(count);
    for (size_t i = 0; i < count; ++i) {
        sum.velocity = sum.velocity + share * f[i].velocity;
        sum.pressure += share * f[i].pressure, sum.density += share * f[i].density;
    }
    return sum;
}

}  // namespace

Probes::Probes(const Scene& scene)
    : sight_(scene.output.probes.empty() ? Scene{} : scene), low_(toDouble(scene.domain.min)) {
    for (const Probe& probe : scene.output.probes) {
        switch (probe.kind) {
            case ProbeKind::Point:
            case ProbeKind::Line:
                readers_.push_back({probe.kind, fielded_.size()});
                addFielded(scene, probe);
                break;
            case ProbeKind::Height:
                readers_.push_back({probe.kind, gauges_.size()});
                addGauge(scene, probe);
                columns_.push_back({probe.name + ".height", "m"});
                break;
            case ProbeKind::Front:
                readers_.push_back({probe.kind, size_t(probe.axis)});
                columns_.push_back({probe.name + ".front", "m"});
                break;
        }
    }
}

void Probes::addFielded(const Scene& scene, const Probe& probe) {
    std::vector<Vec3d> points =
        sensor(scene, placed(scene, toDouble(probe.position)), probe.radius);
    const size_t perReading = probe.kind == ProbeKind::Point ? points.size() : 1;
    if (probe.kind == ProbeKind::Line) points = pointsOf(scene, probe);
    fielded_.push_back(
        {PointsNear(points, supportRadius(scene), surroundings(scene, Surroundings::Nothing)),
         probe.order, perReading});
    for (size_t k = 0; k < points.size() / perReading; ++k) {
        const std::string name =
            probe.kind == ProbeKind::Line ? probe.name + "[" + std::to_string(k) + "]" : probe.name;
        columns_.push_back({name + ".pressure", "Pa"});
        columns_.push_back({name + ".density", "kg/m³"});
        for (const char* axis : AxisNames) columns_.push_back({name + ".velocity_" + axis, "m/s"});
    }
}

void Probes::addGauge(const Scene& scene, const Probe& probe) {
    const int k = int(probe.axis);
    const double R = supportRadius(scene), low = scene.domain.min[k], high = scene.domain.max[k];
    const std::vector<Vec3d> points = pointsOf(scene, probe);
    gauges_.push_back({PointsNear(points, R, surroundings(scene, Surroundings::Mirror)), low,
                       (high - low) / double(points.size() - 1), R, filledBy(scene, R)});
}

Sees Probes::sightPast(const std::vector<SolidPose>& poses) const {
    if (!sight_.anyThin() || poses.empty()) return {};
    return [sees = sight_.past(poses), low = low_](Vec3d particle, Vec3d from) {
        return sees(particle - low, from - low) > 0.5;
    };
}

double Probes::heightOf(const Gauge& gauge, const std::vector<Particle>& particles,
                        const Sees& sees) {
    std::vector<double> filled(gauge.near.points());
    for (const Particle& p : particles)
        gauge.near.visit(p.position, sees, [&](int point, Vec3d, double q) {
            filled[size_t(point)] += gauge.share * weightAt(q);
        });
    // Where the share crosses a half, on a straight line between two samples.
    auto crossing = [&](size_t i) {
        return gauge.low +
               gauge.step * (double(i) + (0.5 - filled[i]) / (filled[i + 1] - filled[i]));
    };
    double height = gauge.low, begin = 0;
    for (size_t i = 0; i < filled.size(); ++i) {
        if (!(filled[i] > 0.5)) continue;
        const bool onFloor = i == 0;
        begin = onFloor ? gauge.low : crossing(i - 1);
        while (i + 1 < filled.size() && filled[i + 1] > 0.5) ++i;
        const double end = i + 1 < filled.size() ? crossing(i) : gauge.low + gauge.step * double(i);
        if (onFloor || end - begin >= gauge.thinnest) height = end;
    }
    return height;
}

size_t Probes::column(const std::string& name) const {
    const auto at = std::find_if(columns_.begin(), columns_.end(),
                                 [&](const Column& c) { return c.name == name; });
    if (at == columns_.end())
        throw Error(Failure::Scene, "output.probes: none of them reads " + name + "; add it");
    return size_t(at - columns_.begin());
}

std::vector<double> Probes::read(const std::vector<Particle>& particles,
                                 const std::vector<SolidPose>& solids) const {
    const Sees sees = sightPast(solids);
    std::vector<double> values;
    values.reserve(columns_.size());
    for (const Reader& reader : readers_) {
        if (reader.kind == ProbeKind::Front) {
            values.push_back(frontOf(particles, Axis(reader.index)));
        } else if (reader.kind == ProbeKind::Height) {
            values.push_back(heightOf(gauges_[reader.index], particles, sees));
        } else {
            const Fielded& probe = fielded_[reader.index];
            const std::vector<Fields> fields =
                interpolate(particles, probe.near, probe.order, sees);
            for (size_t i = 0; i < fields.size(); i += probe.perReading) {
                const Fields f = mean(&fields[i], probe.perReading);
                for (double value :
                     {f.pressure, f.density, f.velocity.x, f.velocity.y, f.velocity.z})
                    values.push_back(value);
            }
        }
    }
    return values;
}

std::string Probes::hiddenBySolids(const Scene& scene, Simulation& simulation) const {
    if (scene.solids.empty() || !any()) return "";
    const SolidsNow solids(scene, simulation.solidPoses());
    std::string all;
    size_t gauge = 0;
    for (size_t i = 0; i < scene.output.probes.size(); ++i) {
        const Probe& probe = scene.output.probes[i];
        const size_t ownGauge = probe.kind == ProbeKind::Height ? gauge++ : 0;
        const std::vector<Vec3d> points = pointsOf(scene, probe);
        int solid = -1, inside = 0;
        for (const Vec3d& p : points)
            if (const int s = solids.over(p); s >= 0) solid = s, ++inside;
        if (inside == 0) continue;
        std::string what = fmt::format("{} of its {} points are inside ", inside, points.size());
        if (probe.kind == ProbeKind::Point) what = "is inside ";
        if (probe.kind == ProbeKind::Height) {
            const Gauge& own = gauges_[ownGauge];
            if (heightOf(own, simulation.particles()) > own.low) continue;
            what = "finds no water and goes through ";
        }
        all +=
            fmt::format("{}{} {}{}", all.empty() ? "" : "; ", named("output.probes", i, probe.name),
                        what, named("solids", size_t(solid), scene.solids[size_t(solid)].name));
    }
    return all.empty() ? "" : all + ": no fluid can be read there; move one of the two";
}

double frontOf(const std::vector<Particle>& particles, Axis axis) {
    std::vector<double> places;
    for (const Particle& p : particles) places.push_back(p.position[int(axis)]);
    const size_t at = size_t(0.995 * double(places.size()));
    std::nth_element(places.begin(), places.begin() + long(at), places.end());
    return places[at];
}

}  // namespace spindrift
